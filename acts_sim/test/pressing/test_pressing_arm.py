# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest

from acts_core.errors import SettingsError
from acts_sim.pressing import PressingArm, PressingConfig, object_named

CIRCLE, BALL = object_named("circle"), object_named("rubber_ball")


def test_presses_meet_the_same_spot_nearly() -> None:
    arm = PressingArm([CIRCLE, BALL], PressingConfig(spot_taxels=3.0, miss_taxels=0.2), seed=4)
    pitch_m = arm.model.geometry.pitch_m
    for number, item in enumerate(arm.objects):
        presses = [arm.press(number) for _ in range(200)]
        places = np.array([(press.x_m, press.y_m) for press in presses]) / pitch_m
        assert np.abs(places.mean(axis=0)).max() < 3.1
        assert places.std(axis=0) == pytest.approx([0.2, 0.2], rel=0.3)
        depths = [press.depth_m for press in presses]
        assert 0.75 * item.depth_m[1] <= min(depths) < max(depths) <= item.depth_m[1]


def test_a_recording_rises_to_its_depth_and_holds() -> None:
    frames = PressingArm([CIRCLE], seed=1).recording(0, 0.010, 0.060)
    assert frames.shape == (70, 32, 32)
    sums = frames.sum(axis=(1, 2), dtype=np.int64)
    assert frames[:10].max() < 20
    assert sums[15] < sums[20] < sums[28] < 1.1 * sums[45]
    assert sums[41:].std() < 0.01 * sums[41:].mean()


def test_the_same_seed_gives_the_same_frames() -> None:
    one, same, other = (PressingArm([BALL], seed=seed).held_frames(2) for seed in (1, 1, 2))
    assert np.array_equal(one[0], same[0])
    assert not np.array_equal(one[0], other[0])
    assert one[1] == ["rubber_ball", "rubber_ball"]
    assert not np.array_equal(one[0][0], one[0][1])


def test_settings_out_of_range_are_refused() -> None:
    with pytest.raises(SettingsError, match="miss_taxels = -1"):
        PressingConfig(miss_taxels=-1.0)
    with pytest.raises(SettingsError, match=r"rise_min_s = 0\.04: allowed is rise_max_s = 0\.03 or less"):
        PressingConfig(rise_min_s=0.040)
