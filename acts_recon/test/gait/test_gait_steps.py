# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Steps of one foot and of two, from force curves that are drawn by hand."""

from __future__ import annotations

from itertools import chain, pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from acts_core.errors import ArrayError, SettingsError
from acts_recon.gait import FootTracker, GaitConfig, GaitTracker, Step, force_and_centre

Array = NDArray[np.float64]

STRIDE_S, STANCE_S, RAMP_S = 1.2, 0.72, 0.1
FIRST_S = 0.5


def times_s(rate_hz: float, duration_s: float = 11.9) -> Array:
    return np.arange(0.0, duration_s, 1.0 / rate_hz)


def walked(time_s: Array, first_s: float = FIRST_S) -> Array:
    """Share of the load: rises and falls in straight lines."""
    phase_s = (time_s - first_s) % STRIDE_S
    curve: Array = np.interp(phase_s, [0.0, RAMP_S, STANCE_S - RAMP_S, STANCE_S, STRIDE_S], [0.0, 1.0, 1.0, 0.0, 0.0])
    return np.where(time_s < first_s, 0.0, curve)


def steps_of(time_s: Array, force: Array, x_m: float = 0.0, y_m: float = 0.0) -> list[Step]:
    tracker = FootTracker()
    told = [
        step
        for at_s, value in zip(time_s.tolist(), force.tolist(), strict=True)
        for step in tracker.step(at_s, value, x_m, y_m)
    ]
    return told + list(tracker.finish())


@pytest.mark.parametrize(("rate_hz", "within_s"), [(8.0, 0.06), (30.0, 0.02), (100.0, 0.003), (1000.0, 0.003)])
@pytest.mark.parametrize(("unit", "offset"), [(1.0, 0.0), (3e5, 2e4), (0.02, 0.005), (700.0, -20.0)])
def test_steps_are_found_at_any_rate_in_any_unit(rate_hz: float, within_s: float, unit: float, offset: float) -> None:
    time_s = times_s(rate_hz)
    steps = steps_of(time_s, offset + unit * walked(time_s))
    strikes_s = FIRST_S + 0.25 * RAMP_S + STRIDE_S * np.arange(9)
    assert [step.strike_s for step in steps] == pytest.approx(strikes_s, abs=within_s)
    assert [step.stance_s for step in steps] == pytest.approx([STANCE_S - 0.5 * RAMP_S] * 9, abs=2 * within_s)
    assert [step.swing_s for step in steps[1:]] == pytest.approx([STRIDE_S - STANCE_S + 0.05] * 8, abs=2 * within_s)
    assert steps[0].swing_s is None
    assert all(0.0 < step.strike_sd_s < 1.0 / rate_hz + 0.01 for step in steps)
    assert [step.peak_force for step in steps] == pytest.approx([unit] * 9, rel=0.02)
    # Of faster samples a hundredth of a second is averaged.
    assert all(np.diff(step.time_s).min() > 0.009 for step in steps)


@pytest.mark.parametrize("rate_hz", [8.0, 200.0])
def test_feet_that_stand_or_hang_make_no_steps(rate_hz: float) -> None:
    rng = np.random.default_rng(1)
    time_s = times_s(rate_hz, 40.0)
    noise = rng.standard_normal(time_s.size)
    sway = 0.25 * np.sin(2 * np.pi * 0.3 * time_s)
    one_foot_then_both = np.where(time_s % 6.0 < 3.0, 1.0, 0.5) + 0.01 * noise
    for force in (1.0 + sway + 0.01 * noise, noise, np.abs(noise), 0.0 * noise, one_foot_then_both):
        assert steps_of(time_s, force) == []


def test_what_has_been_learnt_is_kept_while_standing_for_long() -> None:
    time_s = times_s(20.0, 120.0)
    stands = (time_s > 20.0) & (time_s < 100.0)
    force = np.where(stands, 1.0 + 0.05 * np.sin(time_s), walked(time_s))
    steps = steps_of(time_s, force)
    expected = len(steps_of(time_s, walked(time_s))) - round(80.0 / STRIDE_S)
    assert len(steps) == pytest.approx(expected, abs=1)


@pytest.mark.parametrize("dip", [False, True])
def test_the_peak_of_a_foot_that_stands_for_minutes_is_the_largest_force_of_all(dip: bool) -> None:
    """Of the path the last minute is kept; `dip`: the foot is lifted for too short a time to be a step."""
    time_s = times_s(100.0, 190.0)
    stands = (time_s > 12.0) & (time_s < 180.0)
    force = np.where(stands, 1.0, walked(time_s))
    force[(time_s > 20.0) & (time_s < 21.0)] = 1.3
    if dip:
        force[(time_s > 100.0) & (time_s < 100.03)] = 0.0
    (step,) = [one for one in steps_of(time_s, force) if one.stance_s > 100.0]
    assert step.peak_force == pytest.approx(1.3, rel=0.02)
    assert step.time_s.size == step.force.size == 6000
    assert step.toe_off_s - 0.05 < step.time_s[-1] <= step.toe_off_s


def test_a_step_is_told_soon_after_the_foot_was_lifted() -> None:
    tracker, time_s = FootTracker(), times_s(100.0)
    delays_s = [
        at_s - step.toe_off_s
        for at_s, value in zip(time_s, walked(time_s), strict=True)
        for step in tracker.step(at_s, value)
        if at_s > 6.0
    ]
    assert len(delays_s) >= 4
    assert max(delays_s) < 0.15


def test_the_foot_tells_that_it_carries() -> None:
    tracker, time_s = FootTracker(), times_s(100.0, 9.6)
    assert tracker.carries_since_s is None
    for at_s, value in zip(time_s, walked(time_s), strict=True):
        tracker.step(at_s, value)
    assert tracker.carries_since_s == pytest.approx(FIRST_S + 7 * STRIDE_S + 0.25 * RAMP_S, abs=0.003)


def test_a_short_dip_does_not_end_a_step() -> None:
    time_s = times_s(100.0)
    force = walked(time_s)
    middle = (time_s - FIRST_S) % STRIDE_S
    force[(np.abs(middle - STANCE_S / 2) < 0.02) & (time_s > FIRST_S)] = 0.0
    steps = steps_of(time_s, force)
    assert [step.stance_s for step in steps] == pytest.approx([STANCE_S - 0.5 * RAMP_S] * 9, abs=0.01)
    assert all(np.all(np.diff(step.time_s) > 0) for step in steps)
    assert steps[3].time_s[0] < steps[3].strike_s + 0.02


def test_a_short_dip_after_which_the_force_rises_slowly_does_not_end_a_step() -> None:
    time_s = times_s(1000.0, 20.9)
    force = walked(time_s)
    after_s = (time_s - FIRST_S) % STRIDE_S - STANCE_S / 2
    for begin_s, end_s, share in ((0.0, 0.06, 0.10), (0.06, 0.09, 0.32)):
        force[(begin_s <= after_s) & (after_s < end_s) & (time_s > FIRST_S)] = share
    steps = steps_of(time_s, force)
    assert [step.stance_s for step in steps] == pytest.approx([STANCE_S - 0.5 * RAMP_S] * 17, abs=0.01)


@pytest.mark.parametrize("dip_s", [0.04, 0.3])
def test_a_foot_that_stood_as_it_began_makes_no_step_by_a_short_dip(dip_s: float) -> None:
    """Since when it stands is not known; after a swing it is."""
    begin_s = FIRST_S + STRIDE_S + STANCE_S / 2
    time_s = times_s(100.0)
    time_s = time_s[time_s > begin_s]
    force = np.where(time_s < begin_s + 3 * STRIDE_S, 1.0, walked(time_s))
    force[(time_s > begin_s + 1.0) & (time_s < begin_s + 1.0 + dip_s)] = 0.0
    steps = steps_of(time_s, force)
    is_swing = dip_s > 0.08
    strikes_s = [begin_s + 1.0 + dip_s] * is_swing + [FIRST_S + 0.025 + STRIDE_S * number for number in range(5, 9)]
    assert [step.strike_s for step in steps] == pytest.approx(strikes_s, abs=0.01)
    assert steps[0].swing_s == pytest.approx(dip_s if is_swing else STRIDE_S - STANCE_S + 0.05, abs=0.03)


def test_a_touch_that_is_too_short_is_no_step_and_ends_no_swing() -> None:
    time_s = times_s(100.0)
    force = walked(time_s)
    swing_s = (time_s - FIRST_S) % STRIDE_S - STANCE_S
    force[(np.abs(swing_s - 0.2) < 0.025) & (time_s > FIRST_S)] = 1.0
    steps = steps_of(time_s, force)
    assert [step.stance_s for step in steps] == pytest.approx([STANCE_S - 0.5 * RAMP_S] * 9, abs=0.01)
    assert [step.swing_s for step in steps[1:]] == pytest.approx([STRIDE_S - STANCE_S + 0.05] * 8, abs=0.01)


def test_a_start_that_was_broken_off_teaches_nothing() -> None:
    tracker, time_s = FootTracker(), times_s(100.0)
    for at_s in times_s(100.0, 1.5):
        assert tracker.step(at_s, 100.0) == ()
    told = [
        step for at_s, value in zip(2.5 + time_s, walked(time_s), strict=True) for step in tracker.step(at_s, value)
    ]
    strikes_s = [2.5 + step.strike_s for step in steps_of(time_s, walked(time_s))]
    assert [step.strike_s for step in told] == pytest.approx(strikes_s, abs=1e-6)


def test_what_has_been_learnt_is_kept_over_a_gap() -> None:
    tracker, time_s = FootTracker(), times_s(100.0, 6.0)
    for at_s, value in zip(time_s, walked(time_s), strict=True):
        tracker.step(at_s, value)
    learnt = tracker.loads
    assert learnt is not None
    tracker.step(10.0, 0.5)
    assert tracker.loads == learnt


def test_what_was_before_the_time_that_is_learnt_from_is_forgotten() -> None:
    """Also of a foot that has never lifted: it may stand for days."""
    time_s = times_s(50.0, 90.0)
    force = np.where(time_s < 60.0, 1.0, walked(time_s))
    force[(time_s > 10.0) & (time_s < 10.12)] = 0.0
    steps = steps_of(time_s, force)
    assert len(steps) > 15
    assert steps[0].strike_s > 60.0


def test_steps_around_a_gap_are_left_out() -> None:
    time_s = times_s(50.0)
    begin_s = FIRST_S + 4 * STRIDE_S + 0.3
    keep = (time_s < begin_s) | (time_s > begin_s + 0.8)
    steps = steps_of(time_s[keep], walked(time_s)[keep])
    strikes_s = [FIRST_S + 0.025 + STRIDE_S * number for number in range(9) if number not in (4, 5)]
    known = [number for number, step in enumerate(steps) if step.swing_s is None]
    assert [step.strike_s for step in steps if step.strike_s < begin_s] == pytest.approx(strikes_s[:4], abs=0.005)
    assert len(known) == 2
    assert steps[known[1]].strike_s > begin_s + 0.8


@pytest.mark.parametrize("share", [0.35, 1.0])
@pytest.mark.parametrize("is_paused", [False, True])
def test_a_foot_that_stands_where_its_samples_begin_has_made_no_step(is_paused: bool, share: float) -> None:
    """A skin reads 0 until it was measured everywhere: as its board begins, and after a pause."""
    time_s = times_s(1000.0)
    begin_s = FIRST_S + 4 * STRIDE_S + 0.4
    since_s = time_s - begin_s
    force = np.minimum(walked(time_s), np.abs(since_s) / 0.05)
    # A foot among two carries less than the one that pushes off.
    force = np.where((since_s >= 0.0) & (since_s < 0.1), np.minimum(force, share), force)
    keep = (time_s >= begin_s) | ((time_s < begin_s - 0.6) & is_paused)
    strikes_s = [FIRST_S + 0.025 + STRIDE_S * number for number in range(9) if number > 4 or (number < 4 and is_paused)]
    assert [step.strike_s for step in steps_of(time_s[keep], force[keep])] == pytest.approx(strikes_s, abs=0.003)


def test_samples_that_are_no_numbers_or_come_late_are_left_out() -> None:
    tracker, time_s = FootTracker(), times_s(50.0)
    steps: list[Step] = []
    for at_s, value in zip(time_s, walked(time_s), strict=True):
        steps += tracker.step(at_s, value)
        assert tracker.step(at_s + 0.001, float("nan")) == ()
        assert tracker.step(at_s - 0.1, 77.0) == ()
        assert tracker.step(at_s, 77.0) == ()
    assert len(steps) == 9


def test_a_clock_that_is_set_back_begins_anew() -> None:
    tracker, time_s = FootTracker(), times_s(50.0)
    counts = []
    for begin_s in (1000.0, 0.0):
        counts.append(sum(len(tracker.step(begin_s + t, f)) for t, f in zip(time_s, walked(time_s), strict=True)))
    assert counts == [9, 9]


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([20.0, 200.0]), st.floats(-0.9, 5.0))
def test_after_the_clock_was_set_back_a_foot_is_as_a_new_one(seed: int, rate_hz: float, later_s: float) -> None:
    time_s = times_s(rate_hz, 6.0)
    force = walked(time_s) + 0.01 * np.random.default_rng(seed).standard_normal(time_s.size)
    used, new = FootTracker(), FootTracker()
    for at_s, value in zip((time_s + later_s + 7.0).tolist(), force.tolist(), strict=True):
        used.step(at_s, value)
    for at_s, value in zip(time_s.tolist(), force[::-1].tolist(), strict=True):
        told, expected = used.step(at_s, value), new.step(at_s, value)
        assert [(one.strike_s, one.toe_off_s, one.peak_force) for one in told] == [
            (one.strike_s, one.toe_off_s, one.peak_force) for one in expected
        ]
    assert used.loads == new.loads
    assert used.carries_since_s == new.carries_since_s


def test_an_object_in_the_shoe_does_not_move_the_path() -> None:
    time_s = times_s(100.0)
    share = walked(time_s)
    place_m = -0.1 + 0.2 * np.clip(((time_s - FIRST_S) % STRIDE_S) / STANCE_S, 0.0, 1.0)
    object_n, object_m = 150.0, 0.05
    force = 700.0 * share + object_n
    centre_m = (700.0 * share * place_m + object_n * object_m) / force
    tracker = FootTracker()
    rows = zip(time_s.tolist(), force.tolist(), centre_m.tolist(), strict=True)
    steps = [step for at_s, value, y_m in rows for step in tracker.step(at_s, value, 0.01, y_m)]
    true_m = -0.1 + 0.2 * ((steps[4].time_s - FIRST_S) % STRIDE_S) / STANCE_S
    assert steps[4].y_m == pytest.approx(true_m, abs=0.002)
    assert steps[4].x_m == pytest.approx(0.01, abs=1e-6)
    assert steps[4].progress_m == pytest.approx(0.19, abs=0.01)
    assert steps[4].path_m == pytest.approx(steps[4].progress_m, rel=1e-6)


def both(left: Array, right: Array, time_s: Array) -> GaitTracker:
    tracker = GaitTracker()
    for number, at_s in enumerate(time_s.tolist()):
        tracker.step(0, at_s, float(left[number]))
        tracker.step(1, at_s, float(right[number]))
    return tracker


def test_both_feet_make_a_gait() -> None:
    time_s = times_s(100.0, 20.0)
    gait = both(walked(time_s), 2 * walked(time_s, FIRST_S + STRIDE_S / 2), time_s).gait()
    assert gait.cadence_per_min == pytest.approx(100.0, rel=0.01)
    assert gait.double_support == pytest.approx(2 * (STANCE_S - 0.05 - STRIDE_S / 2) / STRIDE_S, abs=0.01)
    assert gait.asymmetry("stance_s") == pytest.approx(0.0, abs=0.02)
    assert gait.asymmetry("peak_force") == pytest.approx(-2 / 3, abs=0.02)
    assert gait.feet[0].swing_s == pytest.approx(STRIDE_S - STANCE_S + 0.05, abs=0.01)


@pytest.mark.parametrize("other", ["missing", "lifted", "noise"])
def test_a_foot_without_steps_leaves_the_other_its_own(other: str) -> None:
    time_s = times_s(100.0, 20.0)
    rng = np.random.default_rng(1)
    drift = 0.03 * np.abs(np.sin(time_s)) + 0.002 * rng.standard_normal(time_s.size)
    right = {"missing": time_s * np.nan, "lifted": 0.0 * time_s, "noise": drift}[other]
    gait = both(walked(time_s), right, time_s).gait()
    assert gait.feet[0].steps == 16
    assert gait.feet[1].steps == 0
    assert gait.cadence_per_min == pytest.approx(100.0, rel=0.01)
    assert gait.double_support is None
    assert gait.asymmetry("stance_s") is None


def test_a_recording_that_begins_anew_leaves_nothing_of_the_run_before() -> None:
    tracker, time_s = GaitTracker(), times_s(100.0, 20.0)
    left, right = walked(time_s).tolist(), walked(time_s, FIRST_S + STRIDE_S / 2).tolist()
    runs = []
    for begin_s in (1000.0, 900.0, 900.0):
        for at_s, *forces in zip((begin_s + time_s).tolist(), left, right, strict=True):
            for foot, force in enumerate(forces):
                tracker.step(foot, at_s, force)
        runs.append(tracker.gait())
    assert [[foot.steps for foot in gait.feet] for gait in runs] == [[16, 16]] * 3
    assert [gait.cadence_per_min for gait in runs] == pytest.approx([100.0] * 3, rel=0.01)


def test_feet_are_found_again_after_their_unit_has_changed() -> None:
    time_s = times_s(100.0)
    left, right = walked(time_s), walked(time_s, FIRST_S + STRIDE_S / 2)
    tracker = GaitTracker()
    # A recording in counts, then one in newtons: each foot is measured by the other of the same recording.
    for unit in (20_000.0, 700.0):
        told = [
            [*tracker.step(0, at_s, unit * one), *tracker.step(1, at_s, unit * other)]
            for at_s, one, other in zip(time_s.tolist(), left.tolist(), right.tolist(), strict=True)
        ]
        assert sum(map(len, told)) > 12
        assert all(loads is not None for loads in tracker.loads)


def test_the_gait_is_of_the_last_time() -> None:
    tracker, time_s = GaitTracker(GaitConfig(summary_s=5.0)), times_s(100.0, 30.0)
    for at_s, value in zip(time_s.tolist(), walked(time_s).tolist(), strict=True):
        tracker.step(0, at_s, value)
    assert 4 <= tracker.gait().feet[0].steps <= 5


def sampled_step(stance: int, swing: int, force: float) -> list[tuple[float, float]]:
    return [(0.02, force)] * stance + [(0.02, 0.0)] * swing


ODD_SAMPLES = st.tuples(
    st.floats(0.0, 0.2) | st.floats(-1.5, 3.0),
    st.sampled_from([0.0, 0.3, 0.5, 1.0]) | st.floats(-1e9, 1e9) | st.sampled_from([100.0, np.inf, np.nan]),
)
STEPS = st.builds(sampled_step, st.integers(3, 60), st.integers(3, 60), st.floats(0.3, 1.5))


@settings(max_examples=40, deadline=None)
@given(
    st.lists(ODD_SAMPLES, min_size=50, max_size=150)
    | st.lists(STEPS | st.lists(ODD_SAMPLES, max_size=5), min_size=10, max_size=20).map(chain.from_iterable).map(list)
)
def test_of_any_samples_steps_come_one_after_the_other(samples: list[tuple[float, float]]) -> None:
    tracker, at_s = FootTracker(), 0.0
    # It has walked before, and so its loads are known.
    for at_s, value in zip(times_s(50.0, 6.0).tolist(), walked(times_s(50.0, 6.0)).tolist(), strict=True):
        tracker.step(at_s, value, 0.1, -0.1)
    assert tracker.loads is not None
    newest_s, runs = at_s, [list[Step]()]
    for pause_s, force in samples:
        at_s += pause_s
        if at_s < newest_s - 1.0 and np.isfinite(force):
            # The clock was set back.
            newest_s = at_s
            runs.append([])
        newest_s = max(newest_s, at_s) if np.isfinite(force) else newest_s
        runs[-1] += tracker.step(at_s, force, 0.1, -0.1)
    runs[-1] += tracker.finish()
    for step in [step for steps in runs for step in steps]:
        assert step.stance_s >= tracker.config.shortest_s
        assert np.isfinite([step.peak_force, step.strike_sd_s, step.toe_off_sd_s, step.progress_m]).all()
    for before, after in [pair for steps in runs for pair in pairwise(steps)]:
        assert after.strike_s > before.toe_off_s


def test_force_and_centre_of_frames() -> None:
    frames = np.zeros((3, 4, 2), dtype=np.uint16)
    frames[1, 0, 1] = 10
    frames[2] = 5
    force, x_m, y_m = force_and_centre(frames, 0.28, 0.08)
    assert force.tolist() == [0.0, 10.0, 40.0]
    assert x_m == pytest.approx([0.0, 0.02, 0.0])
    assert y_m == pytest.approx([0.0, 0.105, 0.0])
    with pytest.raises(ArrayError, match=r"needed is \(n, rows, cols\)"):
        force_and_centre(frames[0], 0.28, 0.08)


@pytest.mark.parametrize("foot", [-1, 2])
def test_a_foot_that_is_neither_left_nor_right_is_refused(foot: int) -> None:
    with pytest.raises(ArrayError, match=rf"foot = {foot}: allowed are 0 \(left\) and 1 \(right\)"):
        GaitTracker().step(foot, 0.0, 1.0)


def test_settings_that_cannot_be_are_refused() -> None:
    with pytest.raises(SettingsError, match="allowed is above lifted_share"):
        GaitConfig(lifted_share=0.5, loaded_share=0.4)
