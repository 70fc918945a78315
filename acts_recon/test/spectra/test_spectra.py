# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Spectra of samples at uneven times: which tones are told, how strong, and when there are none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError, SettingsError
from acts_core.skin import ForceResponse, force_table, layout, taxels_named
from acts_recon.images import DeadTaxels
from acts_recon.spectra import SpectraConfig, Spectrum, SpectrumAnalyser

GEOMETRY = ArrayGeometry()
RESPONSE = ForceResponse()
FRAME_S = 1.144e-3
CONTACT = [32 * row + col for row in range(10, 14) for col in range(8, 12)]
SHARE = np.array([1, 2, 2, 1, 2, 4, 4, 2, 2, 4, 4, 2, 1, 2, 2, 1]) / 36


def hear(
    analyser: SpectrumAnalyser,
    tones: dict[float, float],
    *,
    force_n: float = 3.0,
    noise: float = 2.0,
    seed: int = 1,
    lost: float = 0.2,
    in_turn: int = 0,
    first_s: float = 1.7e9,
    frames: int = 880,
    taxels: list[int] = CONTACT,
) -> None:
    """Frames in which taxels are measured in random order, and some not at all; or so many in turn in each."""
    rng = np.random.default_rng(seed)
    for number in range(frames):
        order = rng.permutation(16)[: 16 - rng.binomial(15, lost)]
        if in_turn:
            order = np.arange(number * in_turn, (number + 1) * in_turn) % 16
        sample_s = FRAME_S / order.size
        # The last sample ends with the frame.
        end_s = number * FRAME_S + FRAME_S
        at_s = end_s - sample_s * np.arange(order.size)[::-1]
        force = force_n + sum(size * np.cos(2 * np.pi * hz * at_s + 1.0) for hz, size in tones.items())
        counts = RESPONSE.counts(SHARE[order] * force) + noise * rng.standard_normal(order.size)
        analyser.add(
            np.array(taxels, dtype=np.uint16)[order],
            np.clip(np.rint(counts), 0, 1023).astype(np.uint16),
            first_s + end_s,
            FRAME_S,
        )


def heard(tones: dict[float, float], **options: Any) -> Spectrum:
    analyser = SpectrumAnalyser(GEOMETRY, RESPONSE, noise_counts=2.0)
    hear(analyser, tones, **options)
    (spectrum,) = analyser.spectra()
    return spectrum


def test_what_is_kept_of_frames_whose_stamps_stand_still_is_bounded() -> None:
    """As of a node that leaves them as they were: each frame was kept for good."""
    analyser = SpectrumAnalyser(ArrayGeometry(64, 64))
    taxels = np.arange(4096, dtype=np.uint16)
    for number in range(5000):
        analyser.add(taxels, np.full(4096, 300, dtype=np.uint16), 100.0 + 0.3 * min(number, 3), 1e-3)
    assert analyser.window() == ()
    # Of stamps that go on, all frames of the window are kept.
    for number in range(1, 1001):
        analyser.add(taxels, np.full(4096, 300, dtype=np.uint16), 100.9 + 1e-3 * number, 1e-3)
    window = analyser.window()
    assert sum(one.end_s > 100.9 for one in window) >= 1000
    assert len(window) < 2100


def test_a_short_touch_that_was_hardly_measured_has_no_spectrum() -> None:
    """Nothing was measured of it while it may have gone on but what lies beside and is free: it ended the node."""
    analyser = SpectrumAnalyser(GEOMETRY)
    for number in range(22):
        # Few taxels in each of 20 frames a second; one was pressed in one of them, and free in the next but one.
        taxel, counts = {2: (330, 900), 4: (330, 0)}.get(number, (331, 0))
        indices = np.array([taxel, 5], dtype=np.uint16)
        analyser.add(indices, np.array([counts, 0], dtype=np.uint16), 100.0 + 0.05 * number, 1e-3)
    assert analyser.spectra() == ()


def test_a_frame_of_the_time_of_the_one_before_ends_no_window() -> None:
    """So stamps are that lie a nanosecond apart."""
    analyser = SpectrumAnalyser(GEOMETRY, RESPONSE, noise_counts=2.0)
    hear(analyser, {50.0: 0.5})
    before_s = analyser.window()[-1].end_s
    taxel, counts = np.array(CONTACT[:1], dtype=np.uint16), np.array([300], dtype=np.uint16)
    for number in range(1000):
        analyser.add(taxel, counts, before_s + 1e-9 * number, FRAME_S)
    (spectrum,) = analyser.spectra()
    assert spectrum.sample_rate_hz == pytest.approx(1.0 / FRAME_S, rel=1e-3)
    assert spectrum.peaks[0].frequency_hz == pytest.approx(50.0, abs=0.5)


@settings(max_examples=6, deadline=None)
@given(hz=st.floats(10.0, 420.0), size=st.floats(0.05, 1.0), seed=st.integers(0, 1000))
def test_a_tone_is_found_with_its_uncertainty(hz: float, size: float, seed: int) -> None:
    peak = heard({hz: size}, seed=seed).peaks[0]
    assert abs(peak.frequency_hz - hz) < min(5 * peak.frequency_sd_hz, 0.5)
    assert peak.amplitude_n == pytest.approx(size, rel=0.05)
    assert abs(peak.amplitude_n - size) < 5 * peak.amplitude_sd_n


def test_several_tones_are_told_the_largest_first_and_nothing_else() -> None:
    spectrum = heard({50.0: 0.3, 57.0: 0.1, 333.0: 0.6})
    assert [round(peak.frequency_hz) for peak in spectrum.peaks] == [333, 50, 57]
    assert [peak.amplitude_n for peak in spectrum.peaks] == pytest.approx([0.6, 0.3, 0.1], rel=0.05)
    assert spectrum.sample_rate_hz == pytest.approx(1 / FRAME_S, rel=1e-3)
    assert spectrum.frequency_hz[-1] == pytest.approx(0.5 / FRAME_S, abs=1)
    for peak in spectrum.peaks:
        near = np.abs(spectrum.frequency_hz - peak.frequency_hz) < 1
        assert spectrum.amplitude_n[near].max() == pytest.approx(peak.amplitude_n, rel=0.1)
    assert spectrum.force_n == pytest.approx(3.0, rel=0.02)
    assert spectrum.x_m == pytest.approx(float(GEOMETRY.x_m(9.5)), abs=2e-4)
    assert spectrum.y_m == pytest.approx(float(GEOMETRY.y_m(11.5)), abs=2e-4)


@pytest.mark.parametrize("in_turn", [9, 13, 16])
@pytest.mark.parametrize("hz", [225.0, 300.0, 390.0])
def test_overtones_faster_than_half_the_rate_are_not_told_as_other_tones(hz: float, in_turn: int) -> None:
    """A contact with more taxels than a frame has them at several frequencies, which were taken for other tones."""
    (peak,) = heard({hz: 0.6, 2 * hz: 0.15, 3 * hz: 0.08}, in_turn=in_turn).peaks
    assert peak.frequency_hz == pytest.approx(hz, abs=0.05)
    assert peak.amplitude_n == pytest.approx(0.6, rel=0.05)


def test_a_contact_that_does_not_vibrate_has_no_peaks_and_an_untouched_skin_no_spectrum() -> None:
    assert all(heard({}, seed=seed).peaks == () for seed in range(5))
    # What is slower than what is asked for is not told, and does not hide what is faster.
    assert [round(peak.frequency_hz) for peak in heard({2.0: 0.5, 80.0: 0.05}).peaks] == [80]
    analyser = SpectrumAnalyser(GEOMETRY, RESPONSE)
    hear(analyser, {}, force_n=0.0)
    assert analyser.spectra() == ()


def test_there_is_no_spectrum_before_half_of_the_window_and_after_a_jump_of_the_clock() -> None:
    analyser = SpectrumAnalyser(GEOMETRY, RESPONSE)
    hear(analyser, {100.0: 0.3}, frames=430)
    assert not analyser.window()
    hear(analyser, {100.0: 0.3}, frames=880, first_s=5.0)
    assert len(analyser.window()) == 875
    hear(analyser, {100.0: 0.3}, frames=10, first_s=1.0)
    assert not analyser.window()
    hear(analyser, {100.0: 0.3}, frames=880, first_s=2.0)
    analyser.reset()
    assert analyser.spectra() == ()


@pytest.mark.parametrize("before_s", [0.0, 0.15, 0.35])
@pytest.mark.parametrize("after_s", [0.0, 0.15, 0.35])
def test_a_press_that_begins_or_ends_within_the_window_has_no_tones_of_its_own(before_s: float, after_s: float) -> None:
    analyser = SpectrumAnalyser(GEOMETRY, RESPONSE, noise_counts=2.0)
    first_s, end_s = 1.7e9, 1.7e9
    for seconds, tones, force_n in (
        (before_s, {}, 0.0),
        (1.0 - before_s - after_s, {87.3: 0.3}, 3.0),
        (after_s, {}, 0.0),
    ):
        frames = round(seconds / FRAME_S)
        hear(analyser, tones, force_n=force_n, first_s=end_s, frames=frames)
        end_s += frames * FRAME_S
    spectra = analyser.spectra()
    if before_s + after_s > 0.45:
        assert spectra == ()
    else:
        (spectrum,) = spectra
        assert [peak.frequency_hz for peak in spectrum.peaks] == pytest.approx([87.3], abs=0.1)
        assert spectrum.peaks[0].amplitude_n == pytest.approx(0.3, rel=0.05)
        assert spectrum.force_n == pytest.approx(3.0, rel=0.05)
        assert first_s + before_s - 0.01 < spectrum.begin_s < spectrum.end_s < first_s + 1.01 - after_s


@pytest.mark.parametrize("is_first", [False, True])
def test_a_light_press_that_was_there_for_most_of_the_window_has_a_spectrum(is_first: bool) -> None:
    analyser = SpectrumAnalyser(GEOMETRY, RESPONSE, noise_counts=2.0)
    # 85 counts on the hardest pressed taxels.
    force_n = float(force_table(RESPONSE)[85]) * 9
    end_s = 1.7e9
    for seconds, pressed in ((0.65, True), (0.35, False)) if is_first else ((0.35, False), (0.65, True)):
        frames = round(seconds / FRAME_S)
        hear(analyser, {87.3: 0.03} if pressed else {}, force_n=force_n * pressed, first_s=end_s, frames=frames)
        end_s += frames * FRAME_S
    (spectrum,) = analyser.spectra()
    assert spectrum.peaks[0].frequency_hz == pytest.approx(87.3, abs=0.5)
    assert spectrum.peaks[0].amplitude_n == pytest.approx(0.03, rel=0.2)


@pytest.mark.parametrize("of", ["contacts", "patches"])
def test_no_contact_reaches_over_a_border_and_a_patch_is_one_if_asked_for(of: str) -> None:
    glove = layout("glove", 32, 32)
    geometry = glove.geometry(0.0, 0.0)
    first, second = (glove.taxels[glove.patch_of == patch] for patch in (0, 1))
    analyser = SpectrumAnalyser(geometry, RESPONSE, noise_counts=2.0, config=SpectraConfig(spectra_of=of), layout=glove)
    hear(analyser, {100.0: 0.3}, taxels=[*first[:8].tolist(), *second[-8:].tolist()])
    spectra = analyser.spectra()
    assert len(spectra) >= 2
    for spectrum in spectra:
        assert round(spectrum.peaks[0].frequency_hz) == 100
    if of == "patches":
        assert len(spectra) == 2


def test_a_contact_across_a_dead_row_has_one_spectrum() -> None:
    dead = taxels_named("row=12", GEOMETRY.rows, GEOMETRY.cols)
    around = [32 * row + col for row in (10, 11, 13, 14) for col in range(8, 12)]
    found = []
    for known in (None, DeadTaxels(dead, GEOMETRY)):
        analyser = SpectrumAnalyser(GEOMETRY, RESPONSE, noise_counts=2.0, dead=known)
        hear(analyser, {100.0: 0.3}, taxels=around)
        found.append(analyser.spectra())
    assert len(found[0]) == 2
    (spectrum,) = found[1]
    assert round(spectrum.peaks[0].frequency_hz) == 100
    assert spectrum.taxels >= len(around)
    assert spectrum.force_n == pytest.approx(sum(one.force_n for one in found[0]), rel=0.02)


@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_any_samples_have_finite_spectra(data: st.DataObject) -> None:
    rng = np.random.default_rng(data.draw(st.integers(0, 10**6)))
    analyser = SpectrumAnalyser(GEOMETRY, RESPONSE, config=SpectraConfig(spectra_window_s=0.1))
    end_s = 0.0
    top = data.draw(st.sampled_from([1, 300, 1023]))
    size = data.draw(st.sampled_from([1, 16, 256]))
    for _ in range(data.draw(st.integers(1, 60))):
        end_s += rng.exponential(0.01)
        taxels = rng.permutation(1024)[:size].astype(np.uint16)
        analyser.add(taxels, rng.integers(0, top + 1, size).astype(np.uint16), end_s, rng.uniform(0, 0.01))
    for spectrum in analyser.spectra():
        assert np.isfinite(spectrum.amplitude_n).all()
        for peak in spectrum.peaks:
            assert np.isfinite([*vars(peak).values()]).all()


@pytest.mark.parametrize(("end_s", "duration_s"), [(1.0, -1e-6), (1.0, np.nan), (np.inf, 1e-3)])
def test_times_that_cannot_be_are_refused(end_s: float, duration_s: float) -> None:
    one = np.ones(1, dtype=np.uint16)
    with pytest.raises(ArrayError, match="needed are finite times, none negative"):
        SpectrumAnalyser(GEOMETRY).add(one, one, end_s, duration_s)


def test_settings_out_of_range_are_refused() -> None:
    with pytest.raises(SettingsError, match="contacts, patches"):
        SpectraConfig(spectra_of="hands")
