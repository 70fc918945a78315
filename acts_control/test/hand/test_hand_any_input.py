# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Any touch, any command, any settings: the goals keep their limits, and with good input the hand holds again.

ROS_DOMAIN_ID 226.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest
import rclpy
from hand_rig import DT_S, LEAP, NAMES, RigidHand, all_regions, region
from hypothesis import HealthCheck, given, reject, settings
from hypothesis import strategies as st
from rclpy.context import Context
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from waiting import wait_for

from acts_control.hand.control import HandLoop, HandLoopConfig, HandPhase, HandSupervisor
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.motors import HandError, HandReading
from acts_control.hand.nodes.hand_node import HandNode
from acts_control.hand.nodes.reflexes_node import HandReflexesSettings, TouchedHand
from acts_control.hand.reflexes import REFLEXES, HandState, make_reflexes
from acts_core.errors import SettingsError
from acts_core.settings import default_of, describe
from acts_core.skin import RegionContact
from acts_ros.diagnostics import WARN
from acts_ros.messages import RegionsFields, read_regions, write_regions

pytestmark = pytest.mark.slow

EPSILON = 1e-9
GRIPPED = [region(f"{finger}_distal", 0.8) for finger in LEAP_RIGHT.fingers]
SETTINGS: Any = HandReflexesSettings

LINKS = [LEAP_RIGHT.base, *(link.name for link in LEAP_RIGHT.links)]


def made_regions(seed: int) -> list[RegionContact]:
    """Contacts of any strength at any place, most of them such as the skin could say."""
    rng = np.random.default_rng(seed)

    def vector(largest: float) -> tuple[float, float, float]:
        x, y, z = rng.uniform(-largest, largest, 3)
        return float(x), float(y), float(z)

    def number() -> float:
        return float(rng.choice([0.0, 1e-300, 1e-5, 1e-3, 1.0, 1e6]))

    def one(name: str) -> RegionContact:
        return RegionContact(
            name,
            LEAP_RIGHT.regions[name].link,
            int(rng.choice([0, 1, 9, 40, 65535])),
            float(rng.choice([0.0, 0.3, 1.0, 5.0, 60.0, 1e-3, 1e-30, 1e6])),
            vector(float(rng.choice([0.0, 0.03, 0.3, 10.0]))),
            vector(float(rng.choice([0.0, 0.5, 1.0]))),
            number(),
            number(),
            number(),
            number(),
            number(),
            vector(1.0),
            float(rng.choice([0.0, 1e-4, 1e-2, 1.0])),
            bool(rng.integers(2)),
        )

    return [one(str(name)) for name in rng.choice(list(LEAP_RIGHT.regions), rng.integers(0, 8), replace=False)]


ANY_NUMBER = st.floats(width=32) | st.sampled_from([1e30, -1e30])
ANY_VECTOR = st.tuples(ANY_NUMBER, ANY_NUMBER, ANY_NUMBER)
# What one region has besides; most messages are whole, or they would all be refused.
CHANGES = st.one_of(
    *[st.just({})] * 8,
    st.fixed_dictionaries({"link": st.sampled_from(["", "nobody", "x" * 300, *LINKS])}),
    st.fixed_dictionaries({"name": st.sampled_from(["", "/", "nobody", "\n", "palm"])}),
    st.fixed_dictionaries({}, optional={"force_n": ANY_NUMBER, "centre_m": ANY_VECTOR, "normal": ANY_VECTOR}),
    st.fixed_dictionaries({}, optional={"sharpness": ANY_NUMBER, "slip_m": ANY_NUMBER, "area_m2": ANY_NUMBER}),
)


def changed_regions(seed: int, change: dict[str, Any]) -> list[RegionContact]:
    regions = made_regions(seed)
    return [*regions[:-1], *(last._replace(**change) for last in regions[-1:])]


SEEDS = st.integers(0, 2**32 - 1)
REGIONS = st.builds(changed_regions, SEEDS, CHANGES)
# By how much a stamp is ahead of the clock.
AHEAD_S = st.sampled_from([0.0] * 32 + [-3600.0, -0.05, 0.04, 0.06, 3600.0, 1e300, np.inf, -np.inf, np.nan])
TOUCHES = st.tuples(REGIONS, AHEAD_S)


def a_hand_of_all_reflexes() -> RigidHand:
    hand = RigidHand(*make_reflexes(" ".join(REFLEXES), SETTINGS()).items(), grip_settle_s=0.02)
    hand.supervisor.restart(recovered=False)
    hand.step(GRIPPED, steps=3)
    return hand


def check_limits(goal: Sequence[float] | np.ndarray) -> None:
    assert ((LEAP_RIGHT.lower_rad - EPSILON <= goal) & (goal <= LEAP_RIGHT.upper_rad + EPSILON)).all()


def check_that_it_holds_again(hand: RigidHand) -> None:
    hand.step(GRIPPED, steps=30)
    assert not hand.supervisor.status.is_stale
    assert hand.supervisor.grasp() == ""
    assert hand.step(GRIPPED, steps=40) is HandState.HOLDING


@settings(max_examples=60, deadline=None)
@given(touches=st.lists(TOUCHES, min_size=1, max_size=12), holds=st.booleans())
def test_whatever_touch_says_the_goals_stay_within_limits_and_rate_and_the_hand_holds_again(
    touches: list[tuple[list[RegionContact], float]], holds: bool
) -> None:
    hand = a_hand_of_all_reflexes()
    if holds:
        hand.supervisor.grasp()
        assert hand.step(GRIPPED, steps=20) is HandState.HOLDING
    for regions, ahead_s in touches:
        before = hand.goal.copy()
        hand.supervisor.touch(regions, hand.now_s + ahead_s, hand.now_s)
        hand.step(None)
        check_limits(hand.goal)
        assert np.abs(hand.goal - before).max() <= 0.2
    check_that_it_holds_again(hand)


@pytest.mark.parametrize(
    ("link", "told"),
    [
        ("elbow", "region 'index_distal' is said to be on link 'elbow'; the hand has palm_lower, "),
        (
            "palm_lower",
            "region 'index_distal' is said to be on link 'palm_lower'; "
            "in the description of the hand it is on 'index_distal'",
        ),
    ],
)
def test_a_region_on_a_link_that_does_not_carry_it_is_refused_in_words(link: str, told: str) -> None:
    hand = a_hand_of_all_reflexes()
    hand.supervisor.grasp()
    hand.step(GRIPPED, steps=20)
    wrong = [one._replace(link=link) for one in GRIPPED]
    hand.step(wrong, steps=3)
    status = hand.supervisor.status
    assert status.refused == 3
    assert status.refusal.startswith(told)
    check_that_it_holds_again(hand)


# --- bytes on the topic `regions`


class Topic:
    """What a polled subscription has taken."""

    def __init__(self) -> None:
        self.waiting: list[bytes] = []

    def take_all(self) -> list[tuple[bytes, int]]:
        taken, self.waiting = [(data, 0) for data in self.waiting], []
        return taken


class Fed(NamedTuple):
    """A hand that reads its touch from bytes; the clock of the stamps is that of its steps."""

    hand: RigidHand
    topic: Topic

    def touched(self) -> TouchedHand:
        topic: Any = self.topic
        return TouchedHand(self.hand.supervisor, topic, lambda: round(1e9 * self.hand.now_s), lambda: None)

    def cycle(self, touched: TouchedHand, *messages: bytes) -> None:
        hand = self.hand
        hand.now_s += DT_S
        self.topic.waiting += messages
        hand.goal = np.array(touched.step(hand.reading(), hand.goal.tolist(), hand.now_s, DT_S), dtype=np.float64)
        hand.q = hand.goal.copy()
        check_limits(hand.goal)

    def good(self) -> bytes:
        stamp_ns = round(1e9 * (self.hand.now_s + DT_S)) - 1_000_000
        return write_regions(RegionsFields(stamp_ns, "palm", 1, all_regions(*GRIPPED)))


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.lists(st.binary(max_size=300) | st.integers(0, 2000), max_size=10), max_size=6),
    st.sampled_from([b"", b"\xff" * 40, bytes(10_000_000)]),
)
def test_whatever_bytes_come_good_touch_among_them_is_used(junk: list[list[bytes | int]], last: bytes) -> None:
    fed = Fed(a_hand_of_all_reflexes(), Topic())
    touched = fed.touched()
    for messages in junk:
        # A number: a good message that ends there.
        fed.cycle(touched, *(one if isinstance(one, bytes) else fed.good()[:one] for one in messages))
    before = fed.hand.supervisor.status.refused
    fed.cycle(touched, fed.good(), last)
    assert fed.hand.supervisor.status.refused == before + 1
    assert not fed.hand.supervisor.status.is_stale
    assert fed.hand.supervisor.status.touch_age_s < 0.002
    check_that_it_holds_again(fed.hand)


def test_good_touch_counts_whatever_old_touch_comes_after_it() -> None:
    """As where a recording is played beside the skin: within a cycle its messages may be the last."""
    fed = Fed(a_hand_of_all_reflexes(), Topic())
    touched = fed.touched()
    for _ in range(100):
        good = fed.good()
        old = write_regions(read_regions(good)._replace(stamp_ns=0))
        fed.cycle(touched, good, old, old)
        assert fed.hand.supervisor.status.touch_age_s < 0.002
    assert fed.hand.supervisor.status.refused == 0
    check_that_it_holds_again(fed.hand)


# --- commands


class Bus:
    """Motors that are where they were sent."""

    def __init__(self) -> None:
        self.q = LEAP_RIGHT.postures["open"]
        self.largest_step_rad = 0.0

    def connect(self) -> list[str]:
        return []

    def read(self) -> HandReading:
        count = len(self.q)
        return HandReading(self.q, (0.0,) * count, (0.0,) * count, (30,) * count, ("",) * count)

    def command(self, q_rad: Sequence[float]) -> None:
        check_limits(np.array(q_rad))
        self.largest_step_rad = max(self.largest_step_rad, float(np.abs(np.subtract(q_rad, self.q)).max()))
        self.q = tuple(q_rad)

    def recover(self, joint: int) -> None:
        raise AssertionError(f"motor {joint} is well")

    def enable(self) -> None:
        pass

    release = disconnect = close = enable


class Commanded(NamedTuple):
    """A running loop, and its motors."""

    loop: HandLoop
    bus: Bus

    def wait_for_cycles(self, count: int) -> None:
        cycles = self.loop.status.cycles + count
        wait_for(lambda: self.loop.status.cycles >= cycles, f"{count} cycles", state=lambda: self.loop.status)


CONFIG = HandLoopConfig(rate_hz=500.0, max_speed_rad_s=8.0)


@pytest.fixture(scope="module")
def commanded() -> Iterator[Commanded]:
    bus = Bus()
    loop = HandLoop(LEAP_RIGHT, bus, CONFIG, lambda *_told: None)
    loop.launch()
    yield Commanded(loop, bus)
    loop.close()


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.dictionaries(st.sampled_from([*NAMES, *NAMES, "", "nobody", "\n", "x" * 300]), st.floats(), max_size=16))
def test_whatever_is_commanded_the_goals_stay_within_limits_and_speed(
    commanded: Commanded, angles_rad: dict[str, float]
) -> None:
    try:
        commanded.loop.command(angles_rad)
    except HandError as error:
        assert len(str(error)) < 2000  # noqa: PT017
    commanded.wait_for_cycles(3)
    assert commanded.loop.status.phase is HandPhase.ENABLED
    # A late cycle counts as at most four.
    assert commanded.bus.largest_step_rad <= 4.0 * CONFIG.max_speed_rad_s / CONFIG.rate_hz + EPSILON


class ToldNode(HandNode):
    """The node; its loop is not launched, and what it refuses is kept."""

    def __init__(self, **node_arguments: Any) -> None:
        self.refused: list[str] = []
        super().__init__(**node_arguments)

    def _refuse(self, why: str) -> None:
        self.refused.append(why)
        super()._refuse(why)


@pytest.fixture(scope="module")
def hand_node() -> Iterator[ToldNode]:
    context = Context()
    rclpy.init(context=context, domain_id=226)
    node = ToldNode(context=context)
    yield node
    node.destroy_node()
    rclpy.try_shutdown(context=context)


@cache
def command_of(**fields: Any) -> bytes:
    return bytes(serialize_message(JointState(**{name: list(values) for name, values in fields.items()})))


@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.binary(max_size=300), st.integers(0, 150), st.integers(0, 150))
def test_no_bytes_of_a_command_end_the_node(hand_node: ToldNode, junk: bytes, begin: int, end: int) -> None:
    good = command_of(name=("thumb_cmc", "index_pip"), position=(0.3, 0.4), velocity=(0.0,))
    for data in (junk, good[:begin] + junk + good[end:]):
        hand_node._on_command(data)


@pytest.mark.parametrize(
    ("names", "numbers", "kept_bytes", "why"),
    [
        (("thumb_cmc",), 10_000, None, "at most 65536 are read"),
        (("thumb_cmc",), 1, 0, "cannot be read"),
        (("thumb_cmc",), 1, 40, "cannot be read"),
        (("thumb_cmc",), 2, None, "1 names with 2 positions"),
        (("nobody\n" * 99,), 1, None, r"no joint 'nobody\nnobody"),
        (("thumb_cmc", "index_pip", "thumb_cmc"), 3, None, "it names 'thumb_cmc' more than once"),
        (("thumb_cmc",), 1, None, "the hand is not connected: not started"),
    ],
)
def test_a_command_that_cannot_be_is_refused_in_words(
    hand_node: ToldNode, names: tuple[str, ...], numbers: int, kept_bytes: int | None, why: str
) -> None:
    hand_node.refused.clear()
    hand_node.report()
    hand_node._on_command(command_of(name=names, position=(0.3,) * numbers)[:kept_bytes])
    assert len(hand_node.refused) == 1
    assert why in hand_node.refused[0]
    level, words, values = hand_node.report()
    assert level == WARN
    assert words.startswith(f"commands left out: 1, the last: {hand_node.refused[0]}; ")
    assert hand_node.report()[2] == values
    assert "left out" not in hand_node.report()[1]


# --- settings


def changed() -> st.SearchStrategy[dict[str, Any]]:
    """Settings of which some are anywhere in their ranges, most often at an end."""
    values = {}
    for name, info in describe(SETTINGS).items():
        default = default_of(SETTINGS, name)
        if isinstance(default, bool) or not isinstance(default, (int, float)):
            continue
        assert info.minimum is not None, name
        assert info.maximum is not None, name
        kind = type(default)
        among: Callable[..., st.SearchStrategy[Any]] = st.integers if kind is int else st.floats
        ends = st.sampled_from([kind(info.minimum), kind(info.maximum)])
        values[name] = ends | among(kind(info.minimum), kind(info.maximum))
    return st.fixed_dictionaries({}, optional=values)


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(changed(), st.lists(SEEDS, min_size=1, max_size=8))
def test_with_any_settings_the_goals_keep_their_limits(values: dict[str, Any], touches: list[int]) -> None:
    try:
        given_settings = SETTINGS(**values)
        reflexes = make_reflexes(" ".join(REFLEXES), given_settings)
        supervisor = HandSupervisor(LEAP, reflexes, given_settings)
    except SettingsError:
        reject()
    hand = RigidHand()
    hand.supervisor = supervisor
    hand.supervisor.restart(recovered=False)
    hand.step(GRIPPED)
    hand.supervisor.grasp()
    for seed in touches:
        for _ in range(10):
            hand.step(made_regions(seed))
            check_limits(hand.goal)
