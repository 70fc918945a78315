# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Spectra of one taxel, or a few, that are measured many times in a frame."""

from __future__ import annotations

import numpy as np
import pytest

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.skin import ForceResponse
from acts_recon.spectra import SpectraConfig, Spectrum, SpectrumAnalyser

GEOMETRY = ArrayGeometry()
RESPONSE = ForceResponse()
SAMPLE_S = 17.877e-6
FIRST_S = 1.7e9


def heard(
    tones: dict[float, float], *, m: int = 50, taxels: int = 1, frame_s: float = 1e-3, window_s: float = 0.1
) -> Spectrum:
    """Frames of `m` samples of neighbouring taxels in turns; stamps in whole microseconds, as a board has them."""
    rng = np.random.default_rng(1)
    config = SpectraConfig(spectra_window_s=window_s)
    analyser = SpectrumAnalyser(GEOMETRY, RESPONSE, noise_counts=2.0, config=config)
    indices = (500 + np.arange(m) % taxels).astype(np.uint16)
    for number in range(int(window_s / frame_s) + 10):
        end_s = number * frame_s + m * SAMPLE_S
        at_s = end_s - SAMPLE_S * np.arange(m)[::-1]
        force_n = 0.4 + sum(size * np.cos(2 * np.pi * hz * at_s + 1.0) for hz, size in tones.items())
        counts = np.rint(RESPONSE.counts(force_n) + 2.0 * rng.standard_normal(m)).astype(np.uint16)
        analyser.add(indices, counts, FIRST_S + round(end_s, 6), round(m * SAMPLE_S, 6), may_repeat=True)
    (spectrum,) = analyser.spectra()
    return spectrum


@pytest.mark.parametrize("hz", [10.3, 400.7, 3000.2, 24000.9])
def test_a_tone_up_to_half_the_sample_rate_of_a_taxel(hz: float) -> None:
    spectrum = heard({hz: 0.03}, window_s=0.5 if hz < 100 else 0.1)
    assert [peak.frequency_hz for peak in spectrum.peaks] == pytest.approx([hz], abs=0.2)
    assert spectrum.peaks[0].amplitude_n == pytest.approx(0.03, rel=0.05)
    assert spectrum.taxels == 1
    assert spectrum.sample_rate_hz == pytest.approx(1 / SAMPLE_S, rel=1e-3)
    assert spectrum.frequency_hz[-1] == pytest.approx(0.5 / SAMPLE_S, rel=1e-3)


def test_several_tones_though_the_board_pauses_between_frames() -> None:
    spectrum = heard({2000.0: 0.05, 3000.0: 0.02, 15000.0: 0.01})
    assert [round(peak.frequency_hz) for peak in spectrum.peaks] == [2000, 3000, 15000]


def test_of_several_taxels_each_has_its_share_of_the_rate() -> None:
    spectrum = heard({1500.0: 0.03}, m=48, taxels=4)
    assert spectrum.sample_rate_hz == pytest.approx(0.25 / SAMPLE_S, rel=1e-3)
    assert spectrum.taxels == 4
    assert spectrum.peaks[0].frequency_hz == pytest.approx(1500.0, abs=0.2)


def test_a_frame_without_repeats_holds_the_rate_down() -> None:
    analyser = SpectrumAnalyser(GEOMETRY, RESPONSE, config=SpectraConfig(spectra_window_s=0.1))
    for number in range(120):
        repeats = 10 if number > 60 else 1
        taxels = np.full(repeats, 500, dtype=np.uint16)
        analyser.add(taxels, np.full(repeats, 400, dtype=np.uint16), 1e-3 * number, 1e-4, may_repeat=True)
    (spectrum,) = analyser.spectra()
    assert spectrum.sample_rate_hz == pytest.approx(1000, rel=1e-3)


def test_frames_that_say_no_duration_have_the_rate_of_frames() -> None:
    """A million samples a second were told of them, and a window of 10 s took gigabytes."""
    analyser = SpectrumAnalyser(GEOMETRY, RESPONSE, config=SpectraConfig(spectra_window_s=0.1))
    taxels = np.full(10, 500, dtype=np.uint16)
    for number in range(120):
        analyser.add(taxels, np.full(10, 400, dtype=np.uint16), 1e-3 * number, 0.0, may_repeat=True)
    (spectrum,) = analyser.spectra()
    assert spectrum.sample_rate_hz == pytest.approx(1000, rel=1e-3)
    assert spectrum.frequency_hz[-1] <= 500


def test_a_taxel_twice_is_an_error_unless_the_scheme_repeats() -> None:
    analyser = SpectrumAnalyser(GEOMETRY, RESPONSE)
    twice = np.full(2, 500, dtype=np.uint16)
    with pytest.raises(ArrayError, match="occurs twice"):
        analyser.add(twice, twice, 0.0, 1e-3)
    analyser.add(twice, twice, 0.0, 1e-3, may_repeat=True)
    with pytest.raises(ArrayError, match="an array of 32 x 32"):
        analyser.add(np.full(2, 1024, dtype=np.uint16), twice, 1.0, 1e-3, may_repeat=True)
