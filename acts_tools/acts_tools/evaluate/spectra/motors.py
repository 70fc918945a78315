# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Random motors on the simulated skin, their spectra as ours, and as of the recovered images alone."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.sampling import MEASUREMENT_US
from acts_core.skin import ForceResponse
from acts_recon.spectra import Spectrum, SpectrumAnalyser
from acts_sim.pressing import FoamConfig, skin_of
from acts_sim.vibrations import VIBRATION_RATE_HZ, Motor, Vibration, vibration
from acts_tools.evaluate.estimators.methods import PAPER_TOUCH_COUNTS, paper_method
from acts_tools.evaluate.scene_frames import DETECTOR_TOUCH_COUNTS, FOLLOW_COUNTS, frame_rate_hz, frames_of

Array = NDArray[np.float64]

LOWEST_HZ, HIGHEST_HZ = 10.0, 400.0
WINDOW_S = 1.0

# Of half the frame rate: a tone right below is sampled at its zeros for as long as the window lasts.
_SHARE_OF_HALF = 0.92
_FORCE_N, _AMPLITUDE, _RADIUS_M = (3.0, 9.0), (0.03, 0.20), (0.007, 0.014)
_OVERTONE, _ROCKING = (0.0, 0.3), (0.0, 0.3)
_MIDDLE_M = 0.03

ONE_TAXEL_M = 55
"""Samples a frame where all are of one taxel: a thousand frames a second."""
ONE_TAXEL_RATE_HZ = 1e6 / MEASUREMENT_US
_TONE_RATE_HZ = 500e3
# The smallest array that has frames of so many samples.
_TONE_SIDE = 8
_TAXEL_FORCE_N = (0.1, 0.6)


class Tone(NamedTuple):
    """The force on one taxel: its mean and the amplitude of its change [N]."""

    frequency_hz: float
    force_n: float
    amplitude_n: float


def highest_hz(m: int) -> float:
    """The fastest motor that is asked for with `m` taxels a frame."""
    return min(HIGHEST_HZ, _SHARE_OF_HALF * frame_rate_hz(m) / 2)


def random_motor(m: int, share: float, rng: np.random.Generator) -> Motor:
    """A motor of 10 Hz (`share` = 0) to the fastest (1), on a logarithmic scale; all else is random."""
    frequency_hz = LOWEST_HZ * (highest_hz(m) / LOWEST_HZ) ** share
    force_n = rng.uniform(*_FORCE_N)
    x_m, y_m = rng.uniform(-_MIDDLE_M, _MIDDLE_M, 2).tolist()
    return Motor(
        frequency_hz=frequency_hz,
        force_n=force_n,
        amplitude_n=force_n * rng.uniform(*_AMPLITUDE),
        overtone=rng.uniform(*_OVERTONE),
        rocking=rng.uniform(*_ROCKING),
        radius_m=rng.uniform(*_RADIUS_M),
        x_m=x_m,
        y_m=y_m,
    )


def shown(motor: Motor, m: int, rng: np.random.Generator) -> Vibration:
    """A second of a motor, and two frames, on a skin with random taxels."""
    return vibration(skin_of(rng), motor, WINDOW_S + 2 / frame_rate_hz(m), rng)


def our_spectra(seen: Vibration, scheme: str, m: int, noise_counts: float, seed: int) -> tuple[Spectrum, ...]:
    """What `SpectrumAnalyser` tells of the samples of a second."""
    analyser = SpectrumAnalyser(ArrayGeometry(), touch_counts=DETECTOR_TOUCH_COUNTS, noise_counts=noise_counts)
    for frame in frames_of(seen.frames, VIBRATION_RATE_HZ, scheme, m, FOLLOW_COUNTS, noise_counts, seed):
        analyser.add(frame.indices, frame.counts, frame.end_s, frame.duration_s)
    return analyser.spectra()


def paper_spectrum(seen: Vibration, m: int, noise_counts: float, seed: int) -> tuple[Array, Array]:
    """The Fourier transform of the force in the recovered image of each frame: frequencies [Hz] and amplitudes [N].

    Adaptive sampling, and recovery of each frame by itself, as in the paper. A frame is taken for one moment.
    """
    recovery = paper_method()
    response = ForceResponse()
    forces = []
    for frame in frames_of(seen.frames, VIBRATION_RATE_HZ, "adaptive", m, PAPER_TOUCH_COUNTS, noise_counts, seed):
        image = recovery.step(frame.indices, frame.counts, frame.end_s, frame.duration_s)
        forces.append(float(response.force_n(np.where(image > PAPER_TOUCH_COUNTS, image, 0.0)).sum()))
    force_n = np.array(forces) - np.mean(forces)
    frequency_hz: Array = np.arange(force_n.size // 2 + 1, dtype=np.float64) * (frame_rate_hz(m) / force_n.size)
    return frequency_hz, 2 * np.abs(np.fft.rfft(force_n)) / force_n.size


def one_taxel_spectra(seen: Vibration, noise_counts: float, seed: int) -> tuple[Spectrum, ...]:
    """What `SpectrumAnalyser` tells where only the taxel is measured that the motor presses most."""
    row, col = divmod(int(seen.frames[0].argmax()), seen.frames.shape[2])
    return _of_one_taxel(seen.frames, VIBRATION_RATE_HZ, row, col, noise_counts, seed)


def tone_on_a_taxel(tone: Tone, noise_counts: float, rng: np.random.Generator) -> tuple[Spectrum, ...]:
    """The same of a tone of any frequency: all its force is on one taxel of a small array."""
    time_s = np.arange(int((WINDOW_S + 0.01) * _TONE_RATE_HZ)) / _TONE_RATE_HZ
    angle = 2 * np.pi * tone.frequency_hz * time_s + rng.uniform(0, 2 * np.pi)
    sensitivity = 1 + FoamConfig().gain_spread * rng.standard_normal()
    counts = ForceResponse().counts(sensitivity * (tone.force_n + tone.amplitude_n * np.cos(angle)))
    frames = np.zeros((time_s.size, _TONE_SIDE, _TONE_SIDE), dtype=np.uint16)
    row, col = rng.integers(_TONE_SIDE, size=2).tolist()
    frames[:, row, col] = np.rint(counts)
    return _of_one_taxel(frames, _TONE_RATE_HZ, row, col, noise_counts, int(rng.integers(2**31)))


def random_tone(share: float, rng: np.random.Generator) -> Tone:
    """A tone on one taxel of 400 Hz (`share` = 0) to the fastest that can be told (1), on a logarithmic scale."""
    force_n = rng.uniform(*_TAXEL_FORCE_N)
    return Tone(
        frequency_hz=HIGHEST_HZ * (highest_tone_hz() / HIGHEST_HZ) ** share,
        force_n=force_n,
        amplitude_n=force_n * rng.uniform(*_AMPLITUDE),
    )


def highest_tone_hz() -> float:
    """The fastest tone on one taxel that is asked for."""
    return _SHARE_OF_HALF * ONE_TAXEL_RATE_HZ / 2


def _of_one_taxel(
    frames: NDArray[np.uint16], rate_hz: float, row: int, col: int, noise_counts: float, seed: int
) -> tuple[Spectrum, ...]:
    rows, cols = frames.shape[1:]
    analyser = SpectrumAnalyser(
        ArrayGeometry(rows, cols), touch_counts=DETECTOR_TOUCH_COUNTS, noise_counts=noise_counts
    )
    chosen: dict[str, Any] = {"fixed_row": row, "fixed_col": col, "fixed_taxels": 1}
    for frame in frames_of(frames, rate_hz, "fixed", ONE_TAXEL_M, FOLLOW_COUNTS, noise_counts, seed, **chosen):
        analyser.add(frame.indices, frame.counts, frame.end_s, frame.duration_s, may_repeat=True)
    return analyser.spectra()
