# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What can be done to the simulated hand in words, and when the loop of its process leaves steps out."""

from __future__ import annotations

import math
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hand_motors import AROUND_SPHERE, close, switch_on
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.errors import SettingsError
from acts_sim.hand import STEP_S, HandTruth, HandWorld, HandWorldConfig, TruthFollower, carry_out, row_width
from acts_sim.hand.commands import COMMANDS
from acts_sim.hand.process.loop import STEP_NS, HandWorldLoop
from acts_sim.shared import TimedRingReader, TimedRingWriter

pytestmark = pytest.mark.slow


def run(world: HandWorld, seconds: float) -> HandTruth:
    for _ in range(round(seconds / STEP_S)):
        world.step()
    return world.truth


@pytest.fixture(scope="module")
def any_world() -> HandWorld:
    return HandWorld(HandWorldConfig(object="small_sphere"))


def test_the_other_hand_moves_by_20_mm_and_turns_by_20_degrees() -> None:
    world = HandWorld(HandWorldConfig(object="other_hand", object_held=True, object_height_m=0.03))
    start = run(world, 0.1)
    carry_out(world, "move 0 20 0 0 0 20 0.5")
    half = run(world, 0.25)
    end = run(world, 0.5)
    way = np.array(end.object_position_m) - start.object_position_m
    assert way == pytest.approx((0.0, 0.020, 0.0), abs=5e-4)
    assert half.object_position_m[1] - start.object_position_m[1] == pytest.approx(0.010, abs=0.002)
    assert 2.0 * math.acos(end.object_quaternion[0]) == pytest.approx(math.radians(20.0), abs=0.01)
    assert end.object_held


@pytest.mark.parametrize("radius_mm", [0.2, 20.0])
def test_a_tip_of_any_allowed_radius_is_felt(radius_mm: float) -> None:
    world = HandWorld(HandWorldConfig(object="none"))
    carry_out(world, f"poke palm {radius_mm} 100 2")
    assert run(world, 0.07).patches["palm"].tip_force_n > 0.0


@pytest.mark.parametrize(("line", "start_m"), [("", 0.005), (" 3.5 3.5 2", 0.002), (" 3.5 3.5 0", 0.0)])
def test_a_tip_starts_as_high_above_the_skin_as_the_command_says(line: str, start_m: float) -> None:
    world = HandWorld(HandWorldConfig(object="none"))
    carry_out(world, f"poke palm sharp 50 2{line}")
    assert run(world, STEP_S).tip_depth_m == pytest.approx(0.05 * STEP_S - start_m, abs=2e-5)


def test_a_tip_that_is_thicker_than_its_rod_is_long_is_refused(any_world: HandWorld) -> None:
    with pytest.raises(SettingsError, match=r"'20\.1': allowed is a number from 0\.2 to 20"):
        carry_out(any_world, "poke palm 20.1")


def test_what_is_let_go_falls_out_of_an_open_hand_and_can_be_put_back() -> None:
    world = HandWorld(HandWorldConfig(pose="palm_down", object_held=True))
    assert not run(world, 0.2).object_lost
    carry_out(world, "let_go")
    lost = run(world, 0.5)
    assert lost.object_lost
    assert not lost.object_held
    assert run(world, 0.1).object_position_m == pytest.approx(lost.object_position_m, abs=1e-6)
    carry_out(world, "put 0 0")
    assert not world.truth.object_lost
    carry_out(world, "hold")
    assert not run(world, 0.3).object_lost


def test_what_was_let_go_a_moment_ago_is_held_no_more() -> None:
    world = HandWorld(HandWorldConfig(object_held=True))
    carry_out(world, "put 0 0 30")
    assert run(world, STEP_S).object_held
    carry_out(world, "let_go")
    with pytest.raises(SettingsError, match="nothing holds the object; hold first"):
        carry_out(world, "move 0 0 -10")
    carry_out(world, "put 0 0 30")
    fallen = run(world, 0.3)
    assert not fallen.object_held
    assert fallen.patches["palm"].force_n > 0.5 * world.weight_n


def test_what_is_held_is_not_lost_however_far_away_it_is_moved() -> None:
    world = HandWorld(HandWorldConfig(object="small_sphere", object_held=True))
    carry_out(world, "move 0 0 -190 0 0 0 0.3")
    far = run(world, 0.6)
    assert not far.object_lost
    assert far.object_position_m[2] == pytest.approx(-0.2355, abs=0.001)
    carry_out(world, "move 0 0 190 0 0 0 0.3")
    assert run(world, 0.6).object_position_m[2] == pytest.approx(-0.0455, abs=0.001)


@pytest.mark.parametrize("line", ["hold", "let_go", "move 0 0 -10"])
def test_what_is_lost_is_to_be_put_back_first(line: str) -> None:
    world = HandWorld(HandWorldConfig(object="small_sphere", object_held=True))
    carry_out(world, "move 0 0 -190 0 0 0 0.1")
    run(world, 0.3)
    world.holder.drop()
    assert run(world, 0.01).object_lost
    with pytest.raises(SettingsError, match="the object has fallen out of the hand; put it back first"):
        carry_out(world, line)
    carry_out(world, "put 0 0")
    assert not world.is_lost
    carry_out(world, "hold")
    carry_out(world, line)


def test_a_place_out_of_reach_is_refused(any_world: HandWorld) -> None:
    before = any_world.data.qpos.copy()
    with pytest.raises(SettingsError, match=r"height = 200 mm is 177 mm from the middle .* allowed is up to 150 mm"):
        carry_out(any_world, "put 0 0 200")
    assert (any_world.data.qpos == before).all()
    with pytest.raises(SettingsError, match=r"x = -100 mm, y = -100 mm, height = 0 mm is 160 mm from the middle"):
        HandWorldConfig(object="small_sphere", object_x_m=-0.1, object_y_m=-0.1)


def test_nothing_is_put_into_the_palm(any_world: HandWorld) -> None:
    with pytest.raises(SettingsError, match="'-5': allowed is a number from 0 to 200"):
        carry_out(any_world, "put 0 0 -5")


def test_what_is_put_back_is_not_pulled_any_more() -> None:
    world = HandWorld(HandWorldConfig(object="small_sphere"))
    carry_out(world, "pull 0 0 -10 0")
    assert run(world, 0.3).object_lost
    carry_out(world, "put 0 0")
    back = run(world, 0.3)
    assert not back.object_lost
    assert back.load_n == pytest.approx((0.0, 0.0, 0.0))


@pytest.mark.parametrize("name", ["sphere", "small_sphere", "box", "cylinder", "other_hand"])
def test_a_size_that_physics_cannot_follow_is_refused(name: str) -> None:
    with pytest.raises(SettingsError, match=r"object_size_m = 0\.0049: allowed is 0, or 0\.005 to 0\.045 m"):
        HandWorldConfig(object=name, object_size_m=0.0049)
    world = HandWorld(HandWorldConfig(object=name, object_size_m=0.005))
    run(world, 0.8)
    assert world.forces_n.sum() == pytest.approx(world.weight_n, rel=0.02)


@pytest.mark.parametrize(("name", "carried_n", "too_many_n"), [("small_sphere", 8.0, 20.0), ("sphere", 25.0, 40.0)])
def test_what_the_foam_cannot_carry_is_on_the_rigid_core(name: str, carried_n: float, too_many_n: float) -> None:
    world = HandWorld(HandWorldConfig(object=name))
    carry_out(world, f"pull 0 0 {carried_n} 50")
    run(world, 0.8)
    assert world.forces_n.sum() == pytest.approx(carried_n + world.weight_n, rel=0.02)
    carry_out(world, f"pull 0 0 {too_many_n} 50")
    run(world, 0.8)
    assert world.forces_n.sum() < 0.9 * (too_many_n + world.weight_n)


def test_a_load_grows_evenly_and_stays() -> None:
    world = HandWorld(HandWorldConfig(pose="thumb_up", object="cylinder", object_held=True))
    carry_out(world, "load 2 50")
    assert run(world, 0.026).load_n == pytest.approx((0.0, -world.weight_n * 1.04, 0.0), rel=0.05)
    assert run(world, 0.05).load_n == pytest.approx((0.0, -2.0 * world.weight_n, 0.0))
    carry_out(world, "pull 0 0 0 10")
    assert run(world, 0.05).load_n == pytest.approx((0.0, 0.0, 0.0))


def test_a_shaken_hand_ends_where_it_was() -> None:
    world = HandWorld(HandWorldConfig(object="none"))
    before = world.truth.gravity_m_s2
    carry_out(world, "shake y 5 4 0.6")
    felt = np.array([run(world, STEP_S).gravity_m_s2[1] for _ in range(300)])
    assert felt.max() == pytest.approx(0.005 * (2.0 * math.pi * 4.0) ** 2, rel=0.05)
    assert felt.min() == pytest.approx(-felt.max(), rel=0.05)
    assert run(world, 0.05).gravity_m_s2 == before


def test_a_shake_that_another_one_ends_leaves_gravity_as_it_was() -> None:
    world = HandWorld(HandWorldConfig(object="none"))
    before = world.truth.gravity_m_s2
    carry_out(world, "shake z 20 5 10")
    assert run(world, 0.15).gravity_m_s2 != before
    carry_out(world, "shake z 0 1 0")
    assert run(world, STEP_S).gravity_m_s2 == before


def test_motors_fail_by_the_same_words_as_on_the_bus() -> None:
    world = HandWorld(HandWorldConfig(object="none", overload_after_s=0.2))
    switch_on(world)
    carry_out(world, "lose 3")
    assert world.bus.find(3) is None
    carry_out(world, "find 3")
    assert world.bus.find(3) is world.motors[3]
    carry_out(world, "overheat 4")
    assert world.motors[4]["torque_enable"] == 0
    carry_out(world, "block 1")
    world.motors[1].write(116, (3500).to_bytes(4, "little"))
    run(world, 0.3)
    assert world.motors[1]["hardware_error_status"] == 0x20  # stalled for too long, as was asked for
    assert world.motors[2]["hardware_error_status"] == 0


@given(st.sampled_from([one.split()[0] for one in COMMANDS]), st.lists(st.text("0123456789-.einfax_", max_size=6)))
@settings(max_examples=150)
def test_any_line_is_done_or_refused(any_world: HandWorld, word: str, rest: list[str]) -> None:
    with suppress(SettingsError):
        carry_out(any_world, " ".join([word, *rest]))
    any_world.step()
    assert np.isfinite(any_world.counts).all()
    assert np.isfinite(any_world.truth.q_rad).all()
    assert np.isfinite(any_world.truth.object_position_m).all()


@pytest.mark.parametrize("name", ["small_sphere", "box", "cylinder", "other_hand"])
def test_every_object_comes_to_rest_on_the_palm_with_its_weight(name: str) -> None:
    world = HandWorld(HandWorldConfig(object=name))
    truth = run(world, 0.5)
    assert np.linalg.norm(truth.object_velocity_m_s) < 0.005
    assert truth.patches["palm"].force_n == pytest.approx(world.weight_n, rel=0.05)


def test_the_loop_writes_each_step_ahead_of_the_clock(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    now_ns = 10**12
    monkeypatch.setattr("acts_sim.hand.process.loop.time.monotonic_ns", lambda: now_ns)
    world = HandWorld(HandWorldConfig(object="none"))
    patches = [patch.name for patch in world.layout.patches]
    with (
        TimedRingWriter(tmp_path / "field", 1024) as field,
        TimedRingWriter(tmp_path / "truth", row_width(13)) as truth,
    ):
        loop = HandWorldLoop(world, field, truth, 4_000_000)
        follower = TruthFollower(tmp_path / "truth")
        for _ in range(5):
            loop.step(STEP_S)
            now_ns += STEP_NS
        times_ns, rows = follower.new()
        assert times_ns.tolist() == [10**12 + 4_000_000 + k * STEP_NS for k in range(5)]
        assert HandTruth.from_row(rows[-1], patches).time_s == pytest.approx(5 * STEP_S)
        newest = TimedRingReader(tmp_path / "field", 1024).newest()
        assert newest is not None
        assert newest[0] == times_ns[-1]
        assert (loop.statistics.steps, loop.statistics.late, loop.statistics.skipped) == (5, 0, 0)
        now_ns += 300_000_000
        loop.step(STEP_S)
        assert follower.new()[0].tolist() == [now_ns + 4_000_000]
        assert loop.statistics.skipped == 150


@pytest.mark.parametrize(("name", "mass_kg"), [("small_sphere", 0.01), ("box", 0.06)])
def test_a_light_object_squeezed_and_shaken_stays_within_reason(name: str, mass_kg: float) -> None:
    world = HandWorld(HandWorldConfig(object=name, object_mass_kg=mass_kg, pose="thumb_up", object_held=True))
    switch_on(world)
    close(world, AROUND_SPHERE, 150, 50)
    carry_out(world, "shake x 10 4 0.5")
    fastest = max(float(np.linalg.norm(run(world, STEP_S).object_velocity_m_s)) for _ in range(300))
    assert fastest < 1.0


# Of a hand in which `slip` has tightened the grip as far as it may.
FIRM_GRIP = (0.94, 1.63, 0.64, 0.5, 1.04, 1.36, 0.49, 1.62, 0.98, 1.14, 1.31, 1.06, 2.09, 1.15, 0.51, 0.7)


def test_a_cylinder_that_is_gripped_firmly_stands_still() -> None:
    world = HandWorld(
        HandWorldConfig(
            object="cylinder",
            object_size_m=0.022,
            object_mass_kg=0.156,
            object_x_m=0.001,
            pose="thumb_up",
            object_held=True,
        )
    )
    switch_on(world)
    close(world, FIRM_GRIP, 500, 0)
    world.holder.let_go()
    run(world, 0.5)
    speeds = [float(np.linalg.norm(run(world, STEP_S).object_velocity_m_s)) for _ in range(50)]
    assert world.truth.patches["palm"].force_n > 8.0
    assert max(speeds) < 0.001


def test_a_mass_that_physics_cannot_follow_is_refused() -> None:
    with pytest.raises(SettingsError, match="object_mass_kg"):
        HandWorldConfig(object_mass_kg=0.001)


def test_what_tells_of_an_object_is_refused_where_there_is_none() -> None:
    with pytest.raises(SettingsError, match=r"object_size_m = 0\.02: there is no object; choose one"):
        HandWorldConfig(object="none", object_size_m=0.02)
