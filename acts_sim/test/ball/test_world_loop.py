# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Time: joints at any instant, and a world that keeps ahead of the clock. The clock is given, nothing waits."""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from acts_core.robots import ur5e
from acts_sim.ball.joint_follower import JointFollower, JointSource
from acts_sim.ball.world import World, WorldConfig, WorldState
from acts_sim.ball.world_loop import LEAD_NS, LONGEST_CATCH_UP_STEPS, STEP_NS, WAKE_NS, WorldLoop
from acts_sim.shared import JOINT_RING_WIDTH, TimedRingReader, TimedRingWriter

MS = 1_000_000


def swing(time_ns: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Smooth joints with their derivatives."""
    phase = 6.0 * time_ns / 1e9
    still = np.array(ur5e.LEVEL_Q_RAD)
    one = np.array([0.0, 0.0, 0.0, 0.05, 0.0, 0.0])
    return still + one * math.sin(phase), 6.0 * one * math.cos(phase), -36.0 * one * math.sin(phase)


def slot(time_ns: int) -> np.ndarray:
    q_rad, qd_rad_s, _ = swing(time_ns)
    return np.concatenate([q_rad, qd_rad_s])


@pytest.fixture
def joints(tmp_path: Path) -> Iterator[TimedRingWriter]:
    with TimedRingWriter(tmp_path / "joints.ring", JOINT_RING_WIDTH) as writer:
        yield writer


def test_joints_are_followed_between_and_beyond_the_slots(joints: TimedRingWriter) -> None:
    follower = JointFollower(joints.path)
    for now_ns in range(0, 400 * MS, MS):
        if now_ns % (2 * MS) == 0:
            joints.write(now_ns + 1, slot(now_ns + 1))
        asked_ns = now_ns + 2 * MS
        motion = follower.at(asked_ns)
        assert motion is not None
        q_rad, qd_rad_s, qdd_rad_s2 = swing(asked_ns)
        np.testing.assert_allclose(motion.q_rad, q_rad, atol=2e-5)
        np.testing.assert_allclose(motion.qd_rad_s, qd_rad_s, atol=8e-3)
        if now_ns > 50 * MS:
            np.testing.assert_allclose(motion.qdd_rad_s2, qdd_rad_s2, atol=0.12)
    assert follower.source is JointSource.FOLLOWED
    past = follower.at(395 * MS)
    assert past is not None
    np.testing.assert_allclose(past.q_rad, swing(395 * MS)[0], atol=2e-6)


def test_without_a_ring_there_are_no_joints_and_a_reason(tmp_path: Path) -> None:
    follower = JointFollower(tmp_path / "joints.ring")
    assert follower.at(0) is None
    before = follower.source
    assert "start the process that writes it first" in follower.problem
    with TimedRingWriter(tmp_path / "joints.ring", JOINT_RING_WIDTH) as writer:
        assert follower.at(200 * MS) is None
        assert "nothing is written" in follower.problem
        writer.write(200 * MS, slot(200 * MS))
        assert follower.at(201 * MS) is not None
        assert (before, follower.source) == (JointSource.MISSING, JointSource.FOLLOWED)
        assert follower.problem == ""


def test_a_robot_that_stops_writing_leaves_the_plate_at_rest(joints: TimedRingWriter) -> None:
    follower = JointFollower(joints.path)
    joints.write(1, slot(1))
    moving = follower.at(10 * MS)
    assert moving is not None
    assert moving.qd_rad_s[3] == pytest.approx(0.3)
    rest = [follower.at(time_ns) for time_ns in (50 * MS, 300 * MS)]
    assert rest[0] is not None
    assert rest[1] is not None
    assert not rest[0].qd_rad_s.any()
    np.testing.assert_array_equal(rest[0].q_rad, rest[1].q_rad)
    assert follower.source is JointSource.STALE


def test_a_robot_that_starts_anew_is_followed_again(tmp_path: Path) -> None:
    path = tmp_path / "joints.ring"
    old = TimedRingWriter(path, JOINT_RING_WIDTH)
    old.write(1, slot(1))
    follower = JointFollower(path)
    assert follower.at(1 * MS) is not None
    assert follower.at(900 * MS) is not None
    before = follower.source
    with TimedRingWriter(path, JOINT_RING_WIDTH) as new:
        new.write(900 * MS, np.full(JOINT_RING_WIDTH, 0.25))
        motion = follower.at(901 * MS)
        assert motion is not None
        assert (before, follower.source) == (JointSource.STALE, JointSource.FOLLOWED)
        assert motion.q_rad[0] == pytest.approx(0.25, abs=1e-3)


def test_a_ring_of_another_width_is_told_and_left(tmp_path: Path) -> None:
    with TimedRingWriter(tmp_path / "joints.ring", 7):
        follower = JointFollower(tmp_path / "joints.ring")
        assert follower.at(0) is None
        assert "holds 7 values a slot, 12 are expected" in follower.problem


def test_a_slot_of_nan_does_not_stay(joints: TimedRingWriter) -> None:
    follower = JointFollower(joints.path)
    for now_ns in range(1, 100 * MS, 2 * MS):
        bad = 40 * MS < now_ns < 50 * MS
        joints.write(now_ns, np.full(JOINT_RING_WIDTH, np.nan) if bad else slot(now_ns))
        motion = follower.at(now_ns)
        assert motion is not None
        assert motion.is_plausible() != bad


class Harness:
    """A loop on a given clock."""

    def __init__(self, tmp_path: Path, config: WorldConfig) -> None:
        self.world = World(config)
        self.ring = TimedRingWriter(tmp_path / "field.ring", config.rows * config.cols)
        self.seen: list[tuple[int, WorldState]] = []
        follower = JointFollower(tmp_path / "joints.ring")
        self.loop = WorldLoop(
            self.world, follower, self.ring, lambda time_ns, state: self.seen.append((time_ns, state)), start_ns=0
        )
        self.reader = TimedRingReader(self.ring.path, config.rows * config.cols)


def test_the_field_is_always_known_beyond_the_present(tmp_path: Path) -> None:
    harness = Harness(tmp_path, WorldConfig(start_after_s=0.0))
    now_ns = 0
    while now_ns < 100 * MS:
        next_ns = harness.loop.advance(now_ns)
        newest = harness.reader.newest()
        assert newest is not None
        assert now_ns < newest[0] <= now_ns + LEAD_NS + STEP_NS
        assert now_ns < next_ns <= now_ns + WAKE_NS, "it neither spins nor falls behind"
        np.testing.assert_array_equal(newest[1], harness.world.counts)
        now_ns = next_ns
    times_ns = [time_ns for time_ns, _ in harness.seen]
    assert set(np.diff(times_ns)) == {STEP_NS}
    assert harness.loop.statistics.steps == len(times_ns)
    assert harness.loop.statistics.late == 0
    assert harness.loop.statistics.skipped == 0


def test_a_late_loop_catches_up_in_whole_steps(tmp_path: Path) -> None:
    harness = Harness(tmp_path, WorldConfig(start_after_s=0.0))
    harness.loop.advance(0)
    harness.loop.advance(30 * MS)
    assert set(np.diff([time_ns for time_ns, _ in harness.seen])) == {STEP_NS}
    assert harness.seen[-1][0] > 30 * MS
    statistics = harness.loop.statistics
    assert (statistics.late, statistics.skipped) == (1, 0)
    assert statistics.latest_s == pytest.approx(0.027, abs=0.003)


def test_a_loop_that_stood_for_long_leaves_time_out(tmp_path: Path) -> None:
    harness = Harness(tmp_path, WorldConfig(start_after_s=0.0))
    harness.loop.advance(0)
    steps = harness.loop.statistics.steps
    harness.loop.advance(10_000 * MS)
    statistics = harness.loop.statistics
    assert statistics.steps - steps == LONGEST_CATCH_UP_STEPS
    assert statistics.skipped * STEP_NS == pytest.approx(9950 * MS, abs=10 * MS)
    assert harness.seen[-1][0] > 10_000 * MS
    newest = harness.reader.newest()
    assert newest is not None
    assert newest[0] == harness.seen[-1][0]


def test_an_early_call_does_nothing(tmp_path: Path) -> None:
    harness = Harness(tmp_path, WorldConfig())
    next_ns = harness.loop.advance(0)
    steps = harness.loop.statistics.steps
    assert harness.loop.advance(1) == next_ns
    assert harness.loop.statistics.steps == steps


def test_a_failure_in_the_thread_is_kept(tmp_path: Path) -> None:
    harness = Harness(tmp_path, WorldConfig())
    harness.ring.write(2**62, harness.world.counts)
    harness.loop.start()
    harness.loop._thread.join(timeout=20)
    harness.loop.stop()
    assert "times must grow" in str(harness.loop.failure)


pytestmark = pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
