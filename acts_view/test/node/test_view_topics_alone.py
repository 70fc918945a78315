# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is taken of contacts, of outlines and of what a robot says, each by itself; without ROS."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from sensor_msgs.msg import JointState
from view_made_node import S_NS, MadeNode, contact, series

from acts_msgs.msg import BalanceStatus, BallReference, BallState, HandStatus, ObjectClass, Outline
from acts_ros.messages import write_contact
from acts_view.nodes import outline_topic, robot_states
from acts_view.nodes.contact_topic import ContactTopic
from acts_view.nodes.outline_topic import OutlineTopic


def test_of_contacts_at_frame_rate_each_is_a_sample_with_its_delay_and_those_lost_before() -> None:
    node = MadeNode("/plate/contact")
    topic = ContactTopic(node, "/plate")  # type: ignore[arg-type]
    assert topic.take() == ([], None, None)
    for stamp_s, sequence, delay_s in (
        (1000.0, 7, 0.002),
        (1000.001, 10, 9.9),
        (1000.002, 11, 10.1),
        (1000.003, 12, -10.1),
    ):
        data = write_contact(contact(stamp_s, force_n=sequence, sequence=sequence))
        node.come("/plate/contact", data, received_ns=round((stamp_s + delay_s) * S_NS))
    node.come("/plate/contact", b"\xff" * 9)
    samples, touch, newest_s = topic.take()
    assert [(one.force_n, one.lost) for one in samples] == [(7.0, 0), (10.0, 2), (11.0, 0), (12.0, 0)]
    assert [one.latency_ms for one in samples] == pytest.approx([2.0, 9900.0, math.nan, math.nan], nan_ok=True)
    assert [one.stamp_s for one in samples] == pytest.approx([1000.0, 1000.001, 1000.002, 1000.003], abs=1e-6)
    assert touch == pytest.approx((0.01, 0.02, 12.0, 700.0, 1e-4))
    assert newest_s == pytest.approx(1000.003, abs=1e-6)
    assert len(node.told) == 1
    # Without contact, or where it cannot be one, there is no touch; the stamp is of the newest all the same.
    for changes in ({"in_contact": False}, {"x_m": math.nan}, {"area_m2": math.inf}):
        node.come("/plate/contact", write_contact(contact(1001.0, **changes)))
        samples, touch, newest_s = topic.take()
        assert (len(samples), touch) == (1, None)
        assert newest_s == pytest.approx(1001.0)


def test_numbers_of_contacts_begin_anew_where_the_topic_is_taken_again() -> None:
    node = MadeNode("/plate/contact")
    topic = ContactTopic(node, "/plate")  # type: ignore[arg-type]

    def lost(sequence: int) -> int:
        node.come("/plate/contact", write_contact(contact(1000.0, sequence=sequence)))
        [sample], _, _ = topic.take()
        return sample.lost

    assert [lost(1), lost(3)] == [0, 1]
    node.published.add("/plate/view/contact_series")
    topic.look()
    node.published.remove("/plate/view/contact_series")
    topic.look()
    # Nobody has lost those that were not taken.
    assert lost(100) == 0


@pytest.mark.parametrize(
    "changes",
    [
        {"age_s": np.array([0.1, -0.001], np.float32)},
        {"age_s": np.array([60.1, 0.0], np.float32)},
        {"age_s": np.array([math.nan, 0.0], np.float32)},
        {"force_n": np.ones(3, np.float32)},
        {"delay_s": np.ones(1, np.float32)},
        {"missing": np.ones(1, np.uint32)},
        {name: np.zeros(4097, np.float32) for name in ("age_s", "force_n", "delay_s")}
        | {"missing": np.zeros(4097, np.uint32)},
    ],
)
def test_a_series_that_cannot_be_one_is_told_and_left_out(changes: dict[str, Any]) -> None:
    node = MadeNode("/plate/view/contact_series")
    topic = ContactTopic(node, "/plate")  # type: ignore[arg-type]
    node.come("/plate/view/contact_series", series(2000.0, 0.1, 0.0, **changes))
    assert topic.take() == ([], None, None)
    assert [text.startswith("/plate/view/contact_series: ") for text in node.told] == [True]
    node.come("/plate/view/contact_series", series(1000.0, 60.0, *[0.0] * 4095))
    samples, _, _ = topic.take()
    assert len(samples) == 4096
    assert samples[0].stamp_s == pytest.approx(940.0)


def test_an_outline_is_shown_until_its_contact_sends_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = 500.0
    monkeypatch.setattr(outline_topic, "time", SimpleNamespace(monotonic=lambda: now_s))
    node = MadeNode("/plate/outlines")
    topic = OutlineTopic(node, "/plate")  # type: ignore[arg-type]

    def come(number: int, *x_m: float, y_m: tuple[float, ...] = (0.0, 0.25, 0.5)) -> None:
        node.come("/plate/outlines", Outline(number=number, x=x_m, y=y_m))

    come(1, 0.0, 0.5, 1.0)
    come(1, 2.0, 0.5, 1.0)
    come(2, 0.0, 0.125, 1.0)
    assert [corners.tolist() for corners in topic.take()] == [
        [[2.0, 0.0], [0.5, 0.25], [1.0, 0.5]],
        [[0.0, 0.0], [0.125, 0.25], [1.0, 0.5]],
    ]
    now_s += 0.19
    come(2, 0.0, 0.125, 1.0)
    # Any program can send what is no polygon.
    come(3, 0.0, 1.0, y_m=(0.0, 1.0))
    come(4, 0.0, 1.0, 2.0, 3.0)
    come(5, 0.0, 1.0, math.inf)
    come(6, *[0.0] * 513, y_m=(0.0,) * 513)
    assert len(topic.take()) == 2
    now_s += 0.02
    come(7, *[0.0] * 512, y_m=(0.0,) * 512)
    assert [len(corners) for corners in topic.take()] == [3, 512]
    for number in range(100, 164):
        come(number, 0.0, 0.5, 1.0)
    assert len(topic.take()) == 64
    now_s += 0.21
    assert topic.take() == []
    topic.close()
    assert node.subscriptions == {}


@pytest.mark.parametrize(
    ("state", "word"),
    [(HandStatus.STATE_HOLDING, "holding"), (99, "99")],
)
def test_a_hand_says_what_it_does_and_which_reflexes_have_acted(state: int, word: str) -> None:
    message = HandStatus(state=state, reason="r" * 300, active=["a" * 300] * 70)
    message.reflexes, message.events = ["slip", "g" * 300, "more"], [3, 0]
    assert robot_states.hand_state(message) == {
        "state": word,
        "reason": "r" * 200,
        "active": ["a" * 200] * 64,
        "events": [["slip", 3], ["g" * 200, 0]],
    }
    message.reflexes, message.events = ["slip"] * 70, list(range(70))
    assert robot_states.hand_state(message)["events"] == [["slip", count] for count in range(64)]


def test_of_joints_those_are_shown_whose_angles_are_numbers() -> None:
    message = JointState(name=["knee", "hip", "j" * 300, "toe"], position=[0.5, math.nan, -0.25])
    assert robot_states.joint_angles(message) == [["knee", 0.5], ["j" * 200, -0.25]]
    message = JointState(name=["knee"] * 70, position=[0.5] * 70)
    assert len(robot_states.joint_angles(message)) == 64


def test_a_ball_is_where_it_is_said_to_be_if_that_is_known() -> None:
    message = BallState(valid=True)
    message.position.x, message.position.y, message.position.z = 0.01, -0.02, 7.0
    assert robot_states.ball_place(message) == {"ball": [0.01, -0.02]}
    message.valid = False
    assert robot_states.ball_place(message) == {"ball": None}
    message.valid, message.position.y = True, math.inf
    assert robot_states.ball_place(message) == {"ball": None}


def test_where_the_ball_should_be_and_what_tilts_the_plate() -> None:
    reference = BallReference(segment="s" * 300)
    reference.position.x, reference.position.y = 0.03, 0.04
    assert robot_states.ball_reference(reference) == {"reference": [0.03, 0.04], "segment": "s" * 200}
    balance = BalanceStatus(state=BalanceStatus.STATE_WAITING, reason="r" * 300)
    balance.tilt_commanded.x, balance.tilt_commanded.y = 0.01, 0.02
    balance.tilt_measured.x, balance.tilt_measured.y = 0.03, 0.04
    assert robot_states.balance_state(balance) == {
        "state": "waiting",
        "reason": "r" * 200,
        "tilt_commanded": [0.01, 0.02],
        "tilt_measured": [0.03, 0.04],
    }
    balance.state, balance.tilt_measured.x = 99, math.nan
    assert robot_states.balance_state(balance)["state"] == "99"
    assert robot_states.balance_state(balance)["tilt_measured"] is None


def test_of_a_known_object_the_three_that_fit_best_are_shown() -> None:
    message = ObjectClass(class_number=2, name="n" * 300, confidence=0.5)
    message.residuals = [0.5, math.nan, 0.125, 0.75, 0.25]
    assert robot_states.known_object(message) == {
        "number": 2,
        "name": "n" * 200,
        "confidence": 0.5,
        "nearest": [[2, 0.125], [4, 0.25], [0, 0.5]],
    }
    message.confidence = math.inf
    assert robot_states.known_object(message)["confidence"] is None
    message.residuals = [1.0] * 999 + [0.5, 0.25]
    assert robot_states.known_object(message)["nearest"] == [[999, 0.5], [0, 1.0], [1, 1.0]]


def test_where_nothing_presses_there_is_no_object_and_no_confidence() -> None:
    message = ObjectClass(class_number=ObjectClass.NO_OBJECT, confidence=0.5, residuals=[0.5, 0.25])
    assert robot_states.known_object(message) == {"number": None, "name": "", "confidence": None, "nearest": []}
    # Nor where there is nothing to compare with.
    message = ObjectClass(class_number=0, confidence=0.5, residuals=[0.5, math.nan])
    assert robot_states.known_object(message) == {
        "number": 0,
        "name": "",
        "confidence": None,
        "nearest": [[0, 0.5]],
    }
