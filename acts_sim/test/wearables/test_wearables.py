# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Scenes on worn skins, and skins that rest: what they read, and that they can be made again."""

from __future__ import annotations

import numpy as np
import pytest

from acts_core.array import ArrayGeometry
from acts_core.errors import SettingsError
from acts_sim.pressing import ContactModel, FoamConfig
from acts_sim.wearables import SCENES, WORN_RATE_HZ, RestConfig, RestingSkin, worn_scene
from acts_sim.wearables.scenes import register


@pytest.mark.parametrize("name", [name for name in SCENES if name not in ("ball_catch", "footstep")])
def test_a_scene_rests_is_touched_when_it_says_so_and_rests_again(name: str) -> None:
    shown = worn_scene(name, np.random.default_rng(1))
    assert shown.frames.shape[1:] == (shown.layout.matrix_rows, shown.layout.matrix_cols)
    assert shown.frames.dtype == np.uint16
    assert shown.frames.max() <= 1023
    rested = shown.frames[0]
    first = shown.events[0]
    before = int(first.onset_s * WORN_RATE_HZ)
    assert 0.15 <= first.onset_s <= 0.25
    assert (shown.frames[: before + 1] == rested).all()
    assert (shown.frames[-1] == rested).all()
    assert (shown.frames[before + 1 :] != rested).any()
    assert shown.force_n(first.onset_s - 0.001) == 0 < shown.force_n((first.onset_s + first.end_s) / 2)
    assert shown.is_touched(first.onset_s, first.onset_s + 0.001)
    assert not shown.is_touched(0.0, first.onset_s)
    # A minute of drift behind.
    assert np.abs(shown.baseline - rested.ravel()).max() < 15
    assert shown.baseline.min() >= 0  # as a driver's, which is a mean of readings


def test_a_seed_makes_the_same_scene_again_and_another_another() -> None:
    one, again, other = (worn_scene("helmet_hit", np.random.default_rng(seed)) for seed in (3, 3, 4))
    assert np.array_equal(one.frames, again.frames)
    assert one.events[0].onset_s == again.events[0].onset_s != other.events[0].onset_s


def test_a_scene_that_does_not_exist_is_refused() -> None:
    with pytest.raises(SettingsError, match=r"'head_butt'.*known are arm_tap, ball_catch"):
        worn_scene("head_butt", np.random.default_rng(1))


def test_a_scene_of_a_taken_name_is_refused() -> None:
    with pytest.raises(SettingsError, match="'arm_tap' is registered twice"):
        register("arm_tap", "8B", on="arm", told_as="tap")(SCENES["juggling"].make)


def test_a_resting_skin_drifts_as_fast_as_it_is_told_to() -> None:
    still = RestingSkin(
        2000, np.random.default_rng(1), RestConfig(drift_counts_per_min=0, taxel_drift_counts_per_min=0)
    )
    assert np.array_equal(still.counts(0.0), still.counts(600.0))
    assert np.sqrt(np.mean(still.counts(0.0) ** 2)) == pytest.approx(8.0, rel=0.1)
    config = RestConfig(offset_counts=100, drift_counts_per_min=0, taxel_drift_counts_per_min=2)
    drifting = RestingSkin(2000, np.random.default_rng(1), config)
    per_min = 600 * (drifting.counts(300.1) - drifting.counts(300.0))
    moved = per_min[drifting.counts(300.0) > 0]
    assert np.std(moved) == pytest.approx(2.0, rel=0.1)


def test_taxels_that_are_longer_than_wide_carry_all_of_the_force() -> None:
    geometry = ArrayGeometry(20, 20, 0.004, 0.007)
    skin = ContactModel(geometry, FoamConfig(noise_counts=0.0))
    forces_n = skin.forces_under(lambda x, y: np.where(np.hypot(x, y) < 0.02, 1000.0, 0.0))
    assert forces_n.sum() == pytest.approx(1000 * np.pi * 0.02**2, rel=0.02)
    # It is as long as it is wide.
    along_x_m2 = (forces_n.sum(0) * geometry.x_m(np.arange(20)) ** 2).sum()
    along_y_m2 = (forces_n.sum(1) * geometry.y_m(np.arange(20)) ** 2).sum()
    assert along_x_m2 == pytest.approx(along_y_m2, rel=0.05)
