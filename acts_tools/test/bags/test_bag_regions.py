# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A bag of a grasp: what the skin felt, recorded, played, and given to the reflexes again; ROS_DOMAIN_ID 214."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rclpy.qos import QoSProfile

from acts_control.hand.control import HandSupervisor, SupervisorConfig
from acts_control.hand.description import LEAP_RIGHT, HandKinematics
from acts_control.hand.motors import HandReading
from acts_control.hand.nodes.reflexes_node import HandReflexesSettings
from acts_control.hand.reflexes import REFLEXES, make_reflexes
from acts_core.skin import RegionContact
from acts_msgs.msg import RegionContacts
from acts_ros.bags.reading import open_bag
from acts_ros.bags.recorder import Recorder
from acts_ros.bags.writing import BagWriter
from acts_ros.messages import RegionsFields, read_regions, write_regions
from acts_tools.bags.player import Player
from acts_tools.testing.probe import Probe

TIMEOUT_S = 30.0
TOPIC = "/hand/regions"
COUNT = 150
PERIOD_S = 0.004
# Reliable: that a busy machine drops a best-effort message would be no fault of the recorder.
RELIABLE = QoSProfile(depth=COUNT)


@pytest.fixture
def probe() -> Iterator[Probe]:
    with Probe(214) as made:
        yield made


def grasp() -> list[bytes]:
    """Messages: nothing; then tips and palm are pressed; then one tip feels slip, and another something sharp."""
    messages = []
    for k in range(COUNT):
        force_n = 0.02 * max(k - 30, 0)
        regions = []
        for name, given in LEAP_RIGHT.regions.items():
            region = RegionContact(name, given.link)
            if force_n and (name == "palm" or name.endswith("distal")):
                is_sharp = k > 110 and name == "ring_distal"
                region = region._replace(
                    active_taxels=1 if is_sharp else 9,
                    force_n=force_n,
                    normal=(-1.0, 0.0, 0.0),
                    area_m2=7.5e-6 * (1 if is_sharp else 9),
                    peak_n=force_n * (1.0 if is_sharp else 0.2),
                    concentration=1.0 if is_sharp else 0.2,
                    sharpness=10.0 if is_sharp else 0.0,
                )
                if 90 < k < 110 and name == "index_distal":
                    region = region._replace(motion_m_s=(0.0, 0.01, 0.0), slip_m=0.0004, slipping=True)
            regions.append(region)
        messages.append(write_regions(RegionsFields(round(1e9 * (10.0 + k * PERIOD_S)), "hand", k, regions)))
    return messages


def decisions(messages: Sequence[bytes]) -> list[tuple[Any, ...]]:
    """State, what each reflex said, and the goals of all joints, after every message."""
    reflexes = make_reflexes(" ".join(REFLEXES), HandReflexesSettings())
    supervisor = HandSupervisor(HandKinematics(LEAP_RIGHT), reflexes, SupervisorConfig())
    goal = np.zeros(16)
    taken = []
    for k, message in enumerate(messages):
        touch = read_regions(message)
        stamp_s = 1e-9 * touch.stamp_ns
        supervisor.touch(touch.regions, stamp_s, stamp_s)
        if k == 5:
            assert supervisor.grasp() == ""
        at = tuple(np.minimum(goal, 0.4).tolist())
        current_ma = tuple(np.clip(3000.0 * (goal - at), -350.0, 350.0).tolist())
        reading = HandReading(at, (0.0,) * 16, current_ma, (30,) * 16, ("",) * 16)
        goal = np.asarray(supervisor.step(reading, goal.tolist(), stamp_s + 0.002, PERIOD_S))
        taken.append((supervisor.status, goal.tolist()))
    return taken


def test_a_recorded_grasp_is_played_as_it_was_and_the_reflexes_decide_as_they_did(probe: Probe, tmp_path: Path) -> None:
    messages = grasp()
    publisher = probe.node.create_publisher(RegionContacts, TOPIC, RELIABLE)
    bag = BagWriter(tmp_path / "grasp")
    recorder = Recorder(probe.node, bag, [TOPIC], print)

    def is_recorded() -> bool:
        if TOPIC not in recorder.records:
            recorder.discover()
        elif publisher.get_subscription_count() and messages_left:
            publisher.publish(messages_left.pop(0))
        return TOPIC in recorder.records and recorder.records[TOPIC].received == COUNT

    messages_left = list(messages)
    probe.wait_for(is_recorded, TIMEOUT_S, "the recording")
    recorder.close()
    bag.close()
    probe.node.destroy_publisher(publisher)

    heard: list[bytes] = []
    probe.node.create_subscription(RegionContacts, TOPIC, heard.append, RELIABLE, raw=True)
    with open_bag(tmp_path / "grasp") as recorded:
        assert [data for _, _, data in recorded.messages([TOPIC])] == messages
        player = Player(probe.node, recorded, None, print)
        probe.wait_for(lambda: probe.node.count_publishers(TOPIC) == 1, TIMEOUT_S, "the player")

        def due(_deadline_s: float) -> bool:
            # One at a time: of more than fit its queue a subscriber loses some.
            sent = player.report.published
            probe.wait_for(lambda: len(heard) >= sent, TIMEOUT_S, "what was played")
            return True

        assert player.play(1.0, due)
        probe.wait_for(lambda: len(heard) == COUNT, TIMEOUT_S, "the last message")
    assert heard == messages

    first = decisions(messages)
    assert decisions(heard) == first
    assert len({status.state for status, _ in first}) > 1
    assert np.ptp([goal for _, goal in first], axis=0).max() > 0.1
