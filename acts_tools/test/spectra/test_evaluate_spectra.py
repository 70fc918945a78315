# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate spectra`: what it reports of a few motors."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from acts_sim.vibrations import VIBRATION_RATE_HZ
from acts_tools.cli import main

pytestmark = pytest.mark.slow


def test_motors_are_found_and_what_is_still_has_no_tone(tmp_path: Path) -> None:
    out = tmp_path / "spectra.json"
    words = ["evaluate", "spectra", "--seeds", "1", "--m", "128", "--json", str(out)]
    assert main([*words, "--recordings", str(tmp_path)]) == 0
    results = json.loads(out.read_text())["results"]
    names = [(entry["method"], entry["scheme"]) for entry in results]
    of_frames = [("paper", "adaptive"), ("acts", "tracking"), ("acts", "adaptive")]
    assert names == of_frames * 2 + [("acts", "fixed")] * 3
    paper, tracking, _ = results[:3]
    assert 200 < tracking["highest_hz"] < 218
    assert paper["motors"] == tracking["motors"] == tracking["found_within_1_hz"] == 1
    assert tracking["amplitude_within_10_percent"] == 1
    assert tracking["frequency_error_hz"]["max"] < 0.05
    still = results[4]
    assert (still["motors"], still["still"], still["further_peaks"]) == (0, 1, 0)
    motor, tone, silent = results[6:]
    assert motor["found_within_1_hz"] == tone["found_within_1_hz"] == 1
    assert 25_000 < tone["highest_hz"] < tone["rate_hz"] / 2
    assert (silent["still"], silent["further_peaks"]) == (1, 0)
    (recording,) = tmp_path.glob("motor_*_hz.npy")
    frames = np.load(recording)
    # Whole periods, so that it can be repeated; its name says the frequency to 0.05 Hz.
    periods = len(frames) / VIBRATION_RATE_HZ * float(recording.name.split("_")[1])
    assert periods == pytest.approx(round(periods), abs=0.06)
    assert np.ptp(frames.sum(axis=(1, 2), dtype=np.int64)) > 100
