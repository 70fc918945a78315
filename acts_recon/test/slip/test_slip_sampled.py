# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Slip on patches whose taxels are measured in turn: through sampling, fusion and all that is pressed besides."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.sampling import Sampler, SamplingConfig
from acts_core.skin import ForceResponse, RegionContact, SkinPatch, layout
from acts_recon.fusion import FusionEstimator
from acts_recon.regions import Regions
from acts_recon.slip import SlipConfig, SlipWatch
from acts_recon.slip import watch_kernels as kernels

pytestmark = pytest.mark.slow

HAND = layout("leap_right")
TIP = next(k for k, patch in enumerate(HAND.patches) if patch.name == "middle_distal")


def skin(moved_m: float = 0.0, force: float = 1.0) -> NDArray[np.float64]:
    """Every patch is pressed somewhere; what lies on one finger tip has moved along its columns."""
    rng = np.random.default_rng(3)
    picture = np.zeros((HAND.rows, HAND.cols))
    for k, patch in enumerate(HAND.patches):
        x, y = patch.geometry.x_m(np.arange(patch.cols)), patch.geometry.y_m(np.arange(patch.rows))
        at_x, at_y = rng.uniform(-0.3, 0.3, 2) * (patch.cols * patch.pitch_m / 2, patch.rows * patch.row_pitch_m / 2)
        radius_m = rng.uniform(0.005, 0.008) * (0.6 + 0.4 * force)
        away = (x[None, :] - at_x - moved_m * (k == TIP)) ** 2 + (y[:, None] - at_y) ** 2
        patch.of(picture)[:] = rng.uniform(400, 800) * force * np.exp(-2 * away / radius_m**2)
    return picture


def watched(m: int, seconds: float, skin_at: Callable[[float], NDArray[np.float64]]) -> list[list[RegionContact]]:
    """What the regions say every 4 ms, sampled 1000 times a second with noise of 2 counts."""
    sampler = Sampler(SamplingConfig(scheme="tracking", m=m, threshold_counts=50))
    fusion = FusionEstimator(HAND.geometry(), layout=HAND)
    regions = Regions(HAND, ForceResponse())
    noise = np.random.default_rng(4).normal(0.0, 2.0, 100_003)
    found, drawn = [], 0
    for k in range(round(1000 * seconds)):
        now = HAND.matrix(np.clip(skin_at(k * 1e-3), 0, 1023)).tolist()

        def measure(row: int, col: int, now: list[list[float]] = now) -> int:
            nonlocal drawn
            drawn += 1
            return min(max(round(now[row][col] + noise[drawn % len(noise)]), 0), 1023)

        fusion.step(*sampler.frame(measure), k * 1e-3, 0.95e-3)
        if k % 4 == 0:
            found.append(list(regions.step(k * 1e-3, fusion.image, fusion.measured, fusion.age_s)))
    return found


@pytest.mark.parametrize(("m", "within_ms"), [(64, 15.0), (128, 10.0)])
def test_slip_is_told_soon_though_few_taxels_are_measured_in_a_frame(m: int, within_ms: float) -> None:
    begin_s, speed_m_s = 0.200, 0.03

    def skin_at(time_s: float) -> NDArray[np.float64]:
        return skin(max(time_s - begin_s, 0.0) * speed_m_s, force=min(time_s / 0.1, 1.0))

    found = watched(m, 0.225, skin_at)
    told_s = {patch: [0.004 * k for k, regions in enumerate(found) if regions[patch].slipping] for patch in range(13)}
    assert [patch for patch, times in told_s.items() if times] == [TIP]
    assert begin_s < told_s[TIP][0] <= begin_s + 0.0002 / speed_m_s + 1e-3 * within_ms


def test_fingers_that_close_and_hold_do_not_slip() -> None:
    found = watched(55, 0.45, lambda time_s: skin(force=min(time_s / 0.2, 1.0)))
    assert all(region.in_contact for region in found[-1])
    assert not any(region.slipping for regions in found for region in regions)


@pytest.mark.parametrize("pause_s", [0.2, 2.0])
def test_a_contact_that_lies_elsewhere_after_a_pause_has_not_slipped(pause_s: float) -> None:
    """Until each taxel is measured again, a part of the old contact would stand beside a part of the new one."""
    fusion = FusionEstimator(HAND.geometry(), layout=HAND)
    regions = Regions(HAND, ForceResponse())
    rng = np.random.default_rng(5)
    order = rng.permutation(HAND.rows * HAND.cols)
    told: list[float] = []
    for k in range(400):
        is_after = k >= 200
        if k == 200 and pause_s < 0.5:
            # What the numbers of a board that begins anew make of the recovery; longer pauses are seen by their times.
            fusion.reset()
            regions.reset()
        time_s = k * 1e-3 + pause_s * is_after
        indices = order[(55 * k + np.arange(55)) % order.size].astype(np.uint16)
        pressed = HAND.matrix(skin(0.006 * is_after)).astype(np.float64).ravel()[indices] + rng.normal(0.0, 2.0, 55)
        fusion.step(indices, np.clip(np.rint(pressed), 0, 1023).astype(np.uint16), time_s, 0.95e-3)
        found = regions.step(time_s, fusion.image, fusion.measured, fusion.age_s)
        told += [time_s] * found[TIP].slipping
    assert found[TIP].in_contact
    assert told == []


def test_a_contact_that_the_border_cuts_grows_without_slipping_and_slips_where_its_force_stays() -> None:
    patch = SkinPatch("one", 0, 8, 0, 8, pitch_m=0.003, row_pitch_m=0.003)
    rows, cols = np.indices((8, 8))

    def press(col: float, force: float, wide: float) -> NDArray[np.float32]:
        square = (rows - 3.4) ** 2 + (cols - col) ** 2
        return np.asarray(600 * force * np.exp(-square / (2 * wide**2)), dtype=np.float32)

    def told(cut_taxels: float, image_at: Callable[[int], NDArray[np.float32]]) -> bool:
        watch = SlipWatch(8, 8, [patch], SlipConfig(slip_cut_taxels=cut_taxels))
        images = [image_at(k) for k in range(300)]
        slips = [watch.step(k * 1e-3, image, np.array([image.sum()], float))[0] for k, image in enumerate(images)]
        return any(slip.slipping for slip in slips)

    def grows(k: int) -> NDArray[np.float32]:
        share = min(k / 250, 1.0)
        return press(8.0, 0.2 + 0.8 * share, 1.2 + 0.4 * share)

    assert told(0.0, grows)
    assert not told(2.0, grows)
    assert told(2.0, lambda k: press(8.0 - 0.01 * max(k - 100, 0), 1.0, 1.5))


def test_two_patches_that_move_at_once_confirm_each_other() -> None:
    patches = [SkinPatch(f"patch_{k}", 0, 8, 8 * k, 8 * k + 8, pitch_m=0.003, row_pitch_m=0.003) for k in range(2)]
    rows, cols = np.indices((8, 8))

    def told(moved_m: tuple[float, float], share: float) -> list[bool]:
        watch = SlipWatch(8, 16, patches, SlipConfig(slip_together_share=share))
        for k in range(100):
            at = [3.4 + one / 0.003 * k / 100 for one in moved_m]
            parts = [600 * np.exp(-((rows - 3.4) ** 2 + (cols - col) ** 2) / 4.5) for col in at]
            image = np.hstack(parts).astype(np.float32)
            slips = watch.step(k * 1e-3, image, np.array([part.sum() for part in parts]))
        return [slip.slipping for slip in slips]

    # In the 50 ms that are compared they move by half of this; 0.21 mm, 0.07 of a taxel, are slip of one alone.
    assert told((0.0003, 0.0003), share=0.5) == [True, True]
    assert told((0.0003, 0.0003), share=1.0) == [False, False]
    assert told((0.0003, 0.0), share=0.5) == [False, False]
    assert told((0.0003, 0.0006), share=1.0) == [False, True]
    assert told((0.0003, 0.0006), share=0.5) == [True, True]


def by_numpy(time_s: float, memory: kernels.Memory, pressed: float, max_lag_s: float) -> tuple[NDArray, float]:
    """The reference implementation: the image at the last measurement of a pressed taxel, and that moment."""
    moment_s = max(memory.last_s[memory.last > pressed].min(initial=time_s), time_s - max_lag_s)
    with np.errstate(invalid="ignore"):
        share = (moment_s - memory.before_s) / (memory.last_s - memory.before_s)
        between = memory.before + share * (memory.last - memory.before)
    known = np.isfinite(memory.before_s) & (memory.last_s > moment_s)
    return np.where(known, np.where(memory.before_s >= moment_s, memory.before, between), memory.last), moment_s


@pytest.mark.parametrize("seed", range(4))
def test_taxels_are_brought_to_one_moment_as_numpy_does(seed: int) -> None:
    rng = np.random.default_rng(seed)
    patch = SkinPatch("one", 0, 8, 0, 8)
    watch = SlipWatch(8, 8, [patch], pressed_counts=60.0)
    memory, counts = watch._memory, np.array([1e4])
    for k in range(40):
        time_s = 5.0 + 0.004 * k
        age_s = rng.choice([0.001, 0.003, 0.009, 0.030, 0.2], (8, 8)).astype(np.float32)
        values = rng.uniform(0, 300, (8, 8)).astype(np.float32)
        newest_s = memory.past_s.max()
        watch.step(time_s, values, counts, age_s)
        expected, moment_s = by_numpy(time_s, memory, 60.0, watch.config.slip_max_lag_s)
        np.testing.assert_allclose(memory.now, expected, rtol=1e-5, atol=1e-3)
        assert memory.past_s.max() == max(moment_s, newest_s)
        assert math.isfinite(moment_s)
