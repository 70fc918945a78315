# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Motors on a skin: what presses, how it changes, and what the skin reads of it."""

from __future__ import annotations

import numpy as np
import pytest

from acts_core.errors import SettingsError
from acts_core.skin import ForceResponse
from acts_sim.pressing import skin_of
from acts_sim.vibrations import VIBRATION_RATE_HZ, Motor, Vibration, vibration


def shown(motor: Motor, seed: int = 1, duration_s: float = 0.1) -> Vibration:
    rng = np.random.default_rng(seed)
    return vibration(skin_of(rng), motor, duration_s, rng)


def test_the_force_rises_and_falls_with_the_motor_and_the_skin_reads_it() -> None:
    one = shown(Motor(frequency_hz=100.0, force_n=5.0, amplitude_n=0.5))
    assert len(one.frames) == len(one.force_n) == 1601
    assert one.duration_s == pytest.approx(0.1)
    turns = np.fft.rfft(one.force_n[:-1]) / 800
    assert abs(turns[10]) == pytest.approx(0.5, rel=0.05)
    assert one.force_n.mean() == pytest.approx(5.0, rel=0.15)
    read_n = ForceResponse().force_n(one.frames).sum(axis=(1, 2))
    assert np.corrcoef(read_n, one.force_n)[0, 1] > 0.999
    assert read_n.mean() == pytest.approx(one.force_n.mean(), rel=0.1)


def test_a_motor_that_rocks_moves_the_centre_and_not_the_force() -> None:
    still, rocking = (
        shown(Motor(frequency_hz=50.0, amplitude_n=0.0, rocking=share)).frames.astype(float) for share in (0.0, 0.3)
    )
    cols = np.arange(32)

    def ways(frames: np.ndarray) -> tuple[float, float]:
        whole = frames.sum(axis=(1, 2))
        return float(np.ptp(frames.sum(axis=1) @ cols / whole)), float(np.ptp(frames.sum(axis=2) @ cols / whole))

    assert max(ways(still)) < 0.02
    assert max(ways(rocking)) > 0.1


def test_the_same_seed_is_the_same_vibration() -> None:
    motor = Motor(frequency_hz=70.0)
    assert np.array_equal(shown(motor, 3, 0.01).frames, shown(motor, 3, 0.01).frames)
    assert not np.array_equal(shown(motor, 3, 0.01).frames, shown(motor, 4, 0.01).frames)
    assert len(shown(motor, duration_s=0.05).force_n) == VIBRATION_RATE_HZ / 20 + 1


def test_what_no_motor_is_is_refused() -> None:
    with pytest.raises(SettingsError, match="frequency_hz"):
        Motor(frequency_hz=0.0)


def test_a_motor_whose_foot_reaches_over_the_edge_is_refused() -> None:
    assert shown(Motor(x_m=0.0599, y_m=-0.0599), duration_s=0.001).frames.any()
    for place in ({"x_m": 0.0601}, {"y_m": -0.0601}, {"radius_m": 0.08}):
        with pytest.raises(SettingsError, match=r"does not stand on the skin .* reaches 0\.07 m along x and 0\.07 m"):
            shown(Motor(**place), duration_s=0.001)


@pytest.mark.parametrize("place", [{"x_m": 0.5}, {"y_m": -0.2}])
def test_a_motor_beside_the_skin_is_refused(place: dict[str, float]) -> None:
    with pytest.raises(SettingsError, match=r"does not stand on the skin"):
        shown(Motor(**place))
