# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the node ``view`` tells of a ball and a hand, and that it is told no longer than it is so; ROS_DOMAIN_ID 154."""

from __future__ import annotations

from typing import Any

import pytest
from sensor_msgs.msg import JointState
from view_node_bench import Bench
from waiting import wait_for

from acts_msgs.msg import BalanceStatus, BallReference, BallState, HandStatus
from acts_ros import qos

pytestmark = pytest.mark.slow

DOMAIN_ID = 154


@pytest.mark.parametrize("presses", [0, 1])
def test_a_page_sees_ball_reference_tilt_and_joints_and_no_more_when_they_are_gone(bench: Bench, presses: int) -> None:
    place = bench.skin.create_publisher(BallState, "ball/state", qos.STATE)
    reference = bench.skin.create_publisher(BallReference, "ball/reference", qos.STATE)
    status = bench.skin.create_publisher(BalanceStatus, "ball/status", qos.STATE)
    joints = bench.skin.create_publisher(JointState, "joint_states", qos.STATE)
    ball = BallState(valid=True)
    ball.position.x, ball.position.y = 0.01, -0.02
    wanted = BallReference(segment="N")
    wanted.position.x = 0.03
    balancing = BalanceStatus(state=BalanceStatus.STATE_BALANCING, reason="a ball and a reference")
    balancing.tilt_measured.x, balancing.tilt_commanded.y = 0.05, float("nan")

    def play() -> None:
        bench.press(1.0)
        place.publish(ball)
        reference.publish(wanted)
        status.publish(balancing)
        joints.publish(JointState(name=["knee", "hip"], position=[0.5, float("nan")]))

    def seen() -> dict[str, Any]:
        return bench.headers.get("frame", {"ball": {}, "hand": {}})

    def press() -> None:
        for _ in range(presses):
            bench.press(1.0)

    with bench.connect() as client:
        bench.until(lambda: len(seen()["ball"]) == 7 and "joints" in seen()["hand"], client, play)
        assert seen()["ball"] == {
            "ball": [0.01, -0.02],
            "reference": [0.03, 0.0],
            "segment": "N",
            "state": "balancing",
            "reason": "a ball and a reference",
            "tilt_measured": [0.05, 0.0],
            "tilt_commanded": None,
        }
        assert seen()["hand"] == {"joints": [["knee", 0.5]]}
        bench.destroy([place, reference, status, joints])
        none: dict[str, Any] = {"ball": {}, "hand": {}}
        bench.until(lambda: seen() | none == seen(), client, press)


@pytest.mark.parametrize("is_gone", [True, False])
def test_what_one_node_has_said_goes_where_it_is_gone_or_hangs_and_others_go_on(bench: Bench, is_gone: bool) -> None:
    place = bench.skin.create_publisher(BallState, "ball/state", qos.STATE)
    balance = bench.skin.create_publisher(BalanceStatus, "ball/status", qos.STATE)
    joints = bench.skin.create_publisher(JointState, "joint_states", qos.STATE)
    hand = bench.skin.create_publisher(HandStatus, "hand/status", qos.STATE)
    ball = BallState(valid=True)
    ball.position.x = 0.01

    def play() -> None:
        bench.press(1.0)
        place.publish(ball)
        joints.publish(JointState(name=["knee"], position=[0.5]))

    def play_all() -> None:
        play()
        balance.publish(BalanceStatus(state=BalanceStatus.STATE_BALANCING))
        hand.publish(HandStatus(state=HandStatus.STATE_HOLDING))

    def seen() -> dict[str, Any]:
        return bench.headers.get("frame", {"ball": {}, "hand": {}})

    with bench.connect() as client:
        bench.until(
            lambda: {"ball", "state"} <= seen()["ball"].keys() and {"joints", "state"} <= seen()["hand"].keys(),
            client,
            play_all,
        )
        if is_gone:
            bench.destroy([balance, hand])
        bench.until(lambda: "state" not in seen()["ball"] and "state" not in seen()["hand"], client, play)
        assert seen()["ball"] == {"ball": [0.01, 0.0]}
        assert seen()["hand"] == {"joints": [["knee", 0.5]]}


def test_a_page_that_is_opened_later_is_not_told_what_a_controller_said_to_the_last_one(bench: Bench) -> None:
    balance = bench.skin.create_publisher(BalanceStatus, "ball/status", qos.STATE)
    hand = bench.skin.create_publisher(HandStatus, "hand/status", qos.STATE)

    def play() -> None:
        bench.press(1.0)
        balance.publish(BalanceStatus(state=BalanceStatus.STATE_BALANCING))
        hand.publish(HandStatus(state=HandStatus.STATE_HOLDING))

    def seen() -> dict[str, Any]:
        return bench.headers.get("frame", {"ball": {}, "hand": {}})

    with bench.connect() as client:
        bench.until(lambda: bool(seen()["ball"] and seen()["hand"] and seen()["touch"]), client, play)
    # All of it ends while no page is open.
    wait_for(lambda: not bench.view._skins, "the last page's end")
    bench.destroy([balance, hand])
    bench.headers.clear()
    with bench.connect() as client:
        bench.until(lambda: "frame" in bench.headers, client, lambda: None)
    assert (seen()["ball"], seen()["hand"]) == ({}, {})
    # Of the skin itself it is told what was last, and since when it is silent.
    assert seen()["touch"][2] == 1.0
    assert seen()["silent_s"] >= 0.0
