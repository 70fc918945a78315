# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node gait over real DDS; ROS_DOMAIN_ID 22."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.serialization import serialize_message
from recon_bench import Listener

from acts_core.errors import SettingsError
from acts_msgs.msg import Contact, FootStep, Gait
from acts_recon.nodes.gait_node import GaitNode, GaitSettings
from acts_ros import qos
from acts_ros.diagnostics import OK, WARN

FIRST_NS = 1_700_000_000_000_000_000
RATE_HZ = 50
STRIDE_S = 1.0


def contact_of(foot: int, number: int) -> Contact:
    """The feet carry 600 N in turn, for 0.6 s of each second, and roll 0.2 m."""
    phase_s = (number / RATE_HZ + foot * STRIDE_S / 2) % STRIDE_S
    force_n = 600.0 * float(np.interp(phase_s, [0.0, 0.05, 0.55, 0.6], [0.0, 1.0, 1.0, 0.0]))
    message = Contact(in_contact=force_n > 0.0, force=force_n)
    message.header.frame_id = ("left_sole", "right_sole")[foot]
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(FIRST_NS + number * 10**9 // RATE_HZ, 10**9)
    if force_n:
        message.centre_of_pressure.y = -0.1 + 0.2 * min(phase_s / 0.6, 1.0)
    return message


def test_steps_and_gait_of_two_insoles(make_peers: Callable[..., Listener]) -> None:
    peers = make_peers(22, "")
    node = peers.add(GaitNode(context=peers.context))
    publishers = [
        peers.peer.create_publisher(Contact, f"{name}_sole/contact", qos.STREAM) for name in ("left", "right")
    ]
    peers.listen(FootStep, "steps", qos.STATE)
    peers.listen(Gait, "gait", qos.STATE)
    steps, gaits = peers.received["steps"], peers.received["gait"]

    def has_received(count: int) -> bool:
        return min(node._received.values()) > count

    peers.until(lambda: all(publisher.get_subscription_count() for publisher in publishers))
    heard = (node._steps_publisher, node._gait_publisher)
    peers.until(lambda: all(publisher.get_subscription_count() for publisher in heard))
    for number in range(8 * RATE_HZ):
        for foot, publisher in enumerate(publishers):
            publisher.publish(contact_of(foot, number))
        if number % 50 == 49:
            peers.until(partial(has_received, number - 5))
    peers.until(lambda: sum(step.foot == FootStep.LEFT for step in steps) >= 6 and len(gaits) == len(steps))
    step = [step for step in steps if step.foot == FootStep.LEFT][4]
    assert step.header.frame_id == "left_sole"
    strike_s = step.strike.sec - FIRST_NS // 10**9 + 1e-9 * step.strike.nanosec
    assert strike_s % STRIDE_S == pytest.approx(0.0125, abs=0.02)
    assert 0 < step.strike_sigma < 0.02
    assert (step.stance, step.swing) == pytest.approx((0.575, 0.425), abs=0.02)
    assert step.peak_force == pytest.approx(600.0, rel=0.01)
    assert step.path_y[-1] - step.path_y[0] == pytest.approx(0.19, abs=0.02)
    assert len(step.time) == len(step.force) == len(step.path_x) == len(step.path_y)
    gait = gaits[-1]
    assert gait.cadence == pytest.approx(120.0, rel=0.02)
    assert gait.double_support == pytest.approx(0.15, abs=0.03)
    assert list(gait.stance) == pytest.approx([0.575, 0.575], abs=0.02)
    assert abs(gait.stance_asymmetry) < 0.05
    assert node._steps[0] >= 6
    # The second report is of a time without contacts.
    node._report()
    assert "no contacts on /left_sole/contact, /right_sole/contact" in node._report()[1]


def test_the_report_tells_of_each_insole_that_there_is_what_came_of_it(
    make_peers: Callable[..., Listener], monkeypatch: pytest.MonkeyPatch
) -> None:
    peers = make_peers(22, "")
    node = GaitNode(context=peers.context, parameter_overrides=[Parameter("left", value="")])
    arrived: list[tuple[bytes, int]] = []
    monkeypatch.setattr(node._contacts[FootStep.RIGHT], "take_all", lambda: arrived)
    unreadable = contact_of(FootStep.RIGHT, 0)
    unreadable.header.stamp.nanosec = 2_000_000_000
    numbers = range(8 * RATE_HZ)
    arrived += [(serialize_message(one), 0) for one in (unreadable, contact_of(FootStep.RIGHT, 0))]
    node.update()
    nothing_yet = {"refused": 1, "right.contacts": 1, "right.steps": 0, "right.load": "not learnt"}
    assert node._report() == (OK, "0 steps", nothing_yet)
    arrived[:] = [(serialize_message(contact_of(FootStep.RIGHT, number)), 0) for number in numbers[1:]]
    node.update()
    level, words, values = node._report()
    assert (level, words) == (OK, f"{values['right.steps']} steps")
    assert (values["refused"], values["right.contacts"]) == (1, len(numbers))
    assert values["right.steps"] == node._steps[FootStep.RIGHT] > 5
    assert values["right.load"] == pytest.approx(600.0, rel=0.05)
    arrived.clear()
    node.update()
    assert node._report()[:2] == (WARN, "no contacts on /right_sole/contact")
    node.destroy_node()


def test_a_second_publisher_of_an_insole_is_told(make_peers: Callable[..., Listener]) -> None:
    peers = make_peers(22, "")
    peers.add(GaitNode(context=peers.context))
    for name in ("one", "other"):
        node = peers.add(Node(name, context=peers.context))
        node.create_publisher(Contact, "/right_sole/contact", qos.STREAM)
    told = peers.listen(DiagnosticArray, "/diagnostics", 10)
    words = "/right_sole/contact has 2 publishers (/one, /other): end all but one"
    peers.until(lambda: any(words in status.message for array in told for status in array.status))


def test_shares_that_no_step_can_have_are_refused() -> None:
    with pytest.raises(SettingsError, match=r"loaded_share = 0\.2: allowed is above lifted_share"):
        GaitSettings(loaded_share=0.2, lifted_share=0.3)


@pytest.mark.parametrize("feet", [("", ""), ("sole", "sole"), ("sole", "/sole"), ("/a/b", "a/b")])
def test_feet_that_are_none_or_one_are_refused(feet: tuple[str, str]) -> None:
    with pytest.raises(SettingsError, match="needed are the namespaces of two insoles, or of one"):
        GaitSettings(left=feet[0], right=feet[1])


@pytest.mark.parametrize("name", ["9a", "a-b", "a//b", "a/", "/"])
def test_a_foot_that_can_be_no_namespace_is_refused(name: str) -> None:
    with pytest.raises(SettingsError, match="is no namespace: allowed are letters, digits"):
        GaitSettings(left=name)
    GaitSettings(left="/left/sole_1")
