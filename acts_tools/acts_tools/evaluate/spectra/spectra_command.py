# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate spectra`: motors of 10 to 400 Hz on the simulated skin, by how many taxels a frame has.

What the numbers mean is told in docs/spectra.md.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_recon.spectra import Peak
from acts_sim.vibrations import VIBRATION_RATE_HZ, Motor, Vibration
from acts_tools.evaluate import report
from acts_tools.evaluate.options import add_m, add_scene_arguments
from acts_tools.evaluate.scene_frames import frame_rate_hz
from acts_tools.evaluate.scene_recordings import add_recordings_argument, scene_results, write_recording
from acts_tools.evaluate.spectra import motors
from acts_tools.evaluate.statistics import distribution, distribution_with_max, mean
from acts_tools.progress import Progress

_M = (64, 128, 256, 512)
_SCHEMES = ("tracking", "adaptive")
_NEAR_HZ = 1.0
_NEAR_SHARE = 0.1
_TITLE = (
    f"{'M':>4} {'method':6} {'scheme':9} {'motors':>7} {'up to Hz':>8} {'found':>7} {'error Hz':>8} {'within 1':>8} "
    f"{'amplitude':>9} {'in 10 %':>7} {'within 1':>8} {'further':>7}"
)


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate spectra``."""
    parser = commands.add_parser(
        "spectra",
        help="find the frequencies of motors on the simulated skin",
        description="Hold motors of 10 to 400 Hz onto the simulated skin for a second, and look for their frequency "
        "and amplitude in the samples; with more taxels a frame only those below half the frame rate. Then "
        "the same with all samples of one taxel, and tones up to half of their rate. "
        "docs/spectra.md explains the numbers.",
    )
    add_m(parser, _M)
    add_scene_arguments(parser, 25, "motors for each M")
    add_recordings_argument(parser, "the middle motor of each M")
    parser.set_defaults(evaluate=_run)


def _run(arguments: argparse.Namespace) -> int:
    about = {name: getattr(arguments, name) for name in ("noise_counts", "seed", "seeds")}
    results = scene_results(arguments, about)
    print(_TITLE, flush=True)
    with Progress("spectra", (len(arguments.m) + 4) * arguments.seeds) as progress:
        done = 0
        for m, is_still in [*((m, False) for m in arguments.m), (arguments.m[0], True)]:
            all_motors: list[Motor] = []
            told: dict[tuple[str, str], list[tuple[Peak, ...]]] = {}
            for number in range(arguments.seeds):
                rng = np.random.default_rng([arguments.seed, m, number, is_still])
                motor = motors.random_motor(m, (number + rng.uniform()) / arguments.seeds, rng)
                motor = replace(motor, amplitude_n=0.0, rocking=0.0) if is_still else motor
                all_motors.append(motor)
                shown = motors.shown(motor, m, rng)
                if arguments.recordings is not None and number == arguments.seeds // 2 and not is_still:
                    name = f"motor_{motor.frequency_hz:.1f}_hz"
                    write_recording(arguments.recordings, name, _whole_periods(shown), VIBRATION_RATE_HZ)
                for key, peaks in _told(shown, m, arguments.noise_counts, number + 1).items():
                    told.setdefault(key, []).append(peaks)
                progress.show(done := done + 1)
            for (method, scheme), of_motors in told.items():
                rate_hz, highest_hz = frame_rate_hz(m), motors.highest_hz(m)
                scores = _scores(all_motors, of_motors, rate_hz, highest_hz, is_still=is_still)
                entry = {"m": m, "method": method, "scheme": scheme, **scores}
                results.add(entry, _line(entry))
        for kind in ("motors", "tones", "still"):
            entry = _of_one_taxel(kind, arguments, progress, done)
            done += arguments.seeds
            results.add(entry, _line(entry))
    return 0


def _of_one_taxel(kind: str, arguments: argparse.Namespace, progress: Progress, done: int) -> dict[str, Any]:
    """The same with all samples of one taxel: of motors, of faster tones, and of a constant force."""
    shown: list[Motor | motors.Tone] = []
    told: list[tuple[Peak, ...]] = []
    for number in range(arguments.seeds):
        rng = np.random.default_rng([arguments.seed, 0, number, len(kind)])
        share = (number + rng.uniform()) / arguments.seeds
        if kind == "motors":
            motor = motors.random_motor(_M[0], share, rng)
            spectra = motors.one_taxel_spectra(motors.shown(motor, _M[0], rng), arguments.noise_counts, number + 1)
            # How much of it is on that taxel is not known.
            shown.append(replace(motor, amplitude_n=0.0))
        else:
            tone = motors.random_tone(share, rng)
            tone = tone._replace(amplitude_n=0.0) if kind == "still" else tone
            spectra = motors.tone_on_a_taxel(tone, arguments.noise_counts, rng)
            shown.append(tone)
        told.append(tuple(peak for spectrum in spectra for peak in spectrum.peaks))
        progress.show(done + number + 1)
    m, rate_hz = motors.ONE_TAXEL_M, motors.ONE_TAXEL_RATE_HZ
    highest_hz = motors.HIGHEST_HZ if kind == "motors" else motors.highest_tone_hz()
    scores = _scores(shown, told, rate_hz, highest_hz, is_still=kind == "still")
    return {"m": m, "method": "acts", "scheme": "fixed", "taxels": 1, **scores}


def _whole_periods(shown: Vibration) -> NDArray[np.uint16]:
    """The frames of whole periods, so that a board that repeats them vibrates on."""
    periods = int(shown.duration_s * shown.motor.frequency_hz)
    return shown.frames[: round(periods / shown.motor.frequency_hz * VIBRATION_RATE_HZ)]


def _told(shown: Vibration, m: int, noise_counts: float, seed: int) -> dict[tuple[str, str], tuple[Peak, ...]]:
    """The peaks that are told of a motor, by method and scheme; of the paper's spectrum the largest value."""
    frequency_hz, amplitude_n = motors.paper_spectrum(shown, m, noise_counts, seed)
    # The hand moves below.
    amplitude_n[frequency_hz < motors.LOWEST_HZ / 2] = 0.0
    at = int(amplitude_n.argmax())
    told: dict[tuple[str, str], tuple[Peak, ...]] = {
        ("paper", "adaptive"): (Peak(float(frequency_hz[at]), 0.0, float(amplitude_n[at]), 0.0),)
    }
    for scheme in _SCHEMES:
        spectra = motors.our_spectra(shown, scheme, m, noise_counts, seed)
        told["acts", scheme] = tuple(peak for spectrum in spectra for peak in spectrum.peaks)
    return told


def _scores(
    all_motors: Sequence[Motor | motors.Tone],
    told: Sequence[tuple[Peak, ...]],
    rate_hz: float,
    highest_hz: float,
    *,
    is_still: bool,
) -> dict[str, Any]:
    errors_hz, frequency_sds, shares, amplitude_sds, further = [], [], [], [], 0
    for motor, peaks in zip(all_motors, told, strict=True):
        strongest = max(peaks, key=lambda peak: peak.amplitude_n, default=None)
        expected_hz = () if is_still else (motor.frequency_hz, _mirrored(2 * motor.frequency_hz, rate_hz))
        further += sum(all(abs(peak.frequency_hz - hz) > _NEAR_HZ for hz in expected_hz) for peak in peaks)
        if strongest is None or is_still or abs(strongest.frequency_hz - motor.frequency_hz) > _NEAR_HZ:
            continue
        error_hz = abs(strongest.frequency_hz - motor.frequency_hz)
        errors_hz.append(error_hz)
        if strongest.frequency_sd_hz:
            frequency_sds.append(error_hz / strongest.frequency_sd_hz)
        if not motor.amplitude_n:
            continue
        shares.append(strongest.amplitude_n / motor.amplitude_n)
        if strongest.frequency_sd_hz:
            amplitude_sds.append(abs(strongest.amplitude_n - motor.amplitude_n) / strongest.amplitude_sd_n)
    near = sum(abs(share - 1) <= _NEAR_SHARE for share in shares)
    return {
        "motors": 0 if is_still else len(all_motors),
        "still": len(all_motors) if is_still else 0,
        "rate_hz": rate_hz,
        "highest_hz": highest_hz,
        "found_within_1_hz": len(errors_hz),
        "frequency_error_hz": distribution_with_max(errors_hz),
        "frequency_within_1_sigma": mean(np.array(frequency_sds) <= 1),
        "amplitude_share": distribution(shares),
        "amplitude_share_range": [min(shares), max(shares)] if shares else None,
        "amplitude_within_10_percent": near,
        "amplitude_within_1_sigma": mean(np.array(amplitude_sds) <= 1),
        "further_peaks": further,
    }


def _mirrored(frequency_hz: float, rate_hz: float) -> float:
    """Where a tone appears that is faster than half the frame rate."""
    return abs(frequency_hz - rate_hz * round(frequency_hz / rate_hz))


def _line(entry: dict[str, Any]) -> str:
    return (
        f"{entry['m']:4} {entry['method']:6} {entry['scheme']:9} {entry['motors'] or 'none':>7} "
        f"{entry['highest_hz']:8.1f} {entry['found_within_1_hz']:7} "
        f"{report.number(entry['frequency_error_hz']['mean'], 8, 4)} "
        f"{report.number(entry['frequency_within_1_sigma'], 8, 2)} "
        f"{report.number(entry['amplitude_share']['mean'], 9, 3)} {entry['amplitude_within_10_percent']:7} "
        f"{report.number(entry['amplitude_within_1_sigma'], 8, 2)} {entry['further_peaks']:7}"
    )
