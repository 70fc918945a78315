# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The rotator figure: spectra of a small motor at nine voltages, over the taxels measured."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_sim.vibrations import Motor
from acts_tools.evaluate.scene_frames import frame_rate_hz
from acts_tools.evaluate.spectra import motors
from acts_tools.figures.figure import Figure
from acts_tools.figures.published import PublishedData
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OURS, PUBLISHED, SAME, TRUTH, Curve, Panel

_VOLTS = (1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0)
_VOLTS_FAST = (1.0, 5.0)
_M = (64, 128, 256, 512)
_M_FAST = (64,)
_SHOWN = (1.0, 3.0, 5.0)
_HZ_PER_VOLT = 13.1
"""Turns a second of the simulated motor; the published peaks at M = 64 lie near this line."""

_SHOWN_HZ = 150.0
"""More than twice the fastest motor's tone; nothing is above."""

_FORCE_N, _AMPLITUDE_N, _OVERTONE, _ROCKING = 6.0, 0.6, 0.2, 0.2
_NOISE_COUNTS = 3.0
_LOWEST_HZ = motors.LOWEST_HZ / 2
"""Below, the hand that holds the motor moves."""

_FILE = "figS_rotator/rot.fig"


def _as_share(frequency_hz: NDArray[np.floating], amplitude: NDArray[np.floating]) -> tuple[list[float], list[float]]:
    """A spectrum above the hand's motion, divided by its largest value."""
    kept = frequency_hz >= _LOWEST_HZ
    return frequency_hz[kept].tolist(), (amplitude[kept] / amplitude[kept].max()).tolist()


def _peak_hz(frequency_hz: NDArray[np.floating], amplitude: NDArray[np.floating]) -> float:
    kept = frequency_hz >= _LOWEST_HZ
    return float(frequency_hz[kept][amplitude[kept].argmax()])


def _measure_all(run: Run) -> Any:
    volts, ms = run.pick(_VOLTS, _VOLTS_FAST), run.pick(_M, _M_FAST)
    found = []
    with run.progress("motors", len(volts) * len(ms)) as progress:
        for m in ms:
            for volt in volts:
                motor = Motor(_HZ_PER_VOLT * volt, _FORCE_N, _AMPLITUDE_N, _OVERTONE, _ROCKING)
                rng = np.random.default_rng([run.seed, m, round(10 * volt)])
                shown = motors.shown(motor, m, rng)
                frequency_hz, amplitude_n = motors.paper_spectrum(shown, m, _NOISE_COUNTS, run.seed)
                spectra = motors.our_spectra(shown, "tracking", m, _NOISE_COUNTS, run.seed)
                entry = {
                    "m": m,
                    "volt": volt,
                    "paper_hz": _peak_hz(frequency_hz, amplitude_n),
                    "paper": _as_share(frequency_hz, amplitude_n),
                    "peaks_hz": [],
                    "ours": None,
                }
                if spectra:
                    largest = max(spectra, key=lambda one: one.force_n)
                    own_hz = np.arange(largest.amplitude_n.size) * largest.step_hz
                    entry["ours"] = _as_share(own_hz, largest.amplitude_n)
                    entry["peaks_hz"] = [peak.frequency_hz for peak in largest.peaks]
                found.append(entry)
                progress.show(len(found))
    return found


def _measure(run: Run) -> list[Panel]:
    found = run.shared("motors", lambda: _measure_all(run))
    panels = []
    for entry in found:
        if entry["m"] == _M[0] and entry["volt"] in _SHOWN:
            x, y = entry["paper"]
            curves = [Curve("paper's method", x, y, SAME, "adaptive")]
            if entry["ours"]:
                x, y = entry["ours"]
                curves.append(Curve("ours", x, y, OURS, "tracking"))
            title = f"{entry['volt']:g} V, M = {entry['m']}"
            panels.append(Panel(title, "frequency [Hz]", "amplitude / largest", curves, x_min=0.0, x_max=_SHOWN_HZ))
    for m in sorted({entry["m"] for entry in found}):
        own = [entry for entry in found if entry["m"] == m]
        volts = [entry["volt"] for entry in own]
        half = frame_rate_hz(m) / 2
        told = [(entry["volt"], entry["peaks_hz"][0]) for entry in own if entry["peaks_hz"]]
        curves = [
            Curve("motor", volts, [_HZ_PER_VOLT * volt for volt in volts], TRUTH, "truth"),
            Curve("paper's method", volts, [entry["paper_hz"] for entry in own], SAME, "adaptive"),
            Curve("ours", [volt for volt, _ in told], [hz for _, hz in told], OURS, "tracking"),
        ]
        # Above twice the fastest motor, half the frame rate is of no interest.
        if half < 2 * _HZ_PER_VOLT * _VOLTS[-1]:
            curves.insert(1, Curve("half the frame rate", [volts[0], volts[-1]], [half, half], TRUTH, "raster"))
        panels.append(Panel(f"strongest tone, M = {m}", "voltage [V]", "frequency [Hz]", curves))
    return panels


def _published(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
    found = {}
    for panel in panels:
        m = int(panel.title.rpartition(" ")[2])
        if panel.x_label.startswith("voltage"):
            peaks = [_peak_hz(*data.points(_FILE, f"M={m}", axes).T) for axes in range(len(_VOLTS))]
            curve = Curve(
                "published, peak", list(_VOLTS), peaks, PUBLISHED, "tab:green", points=True, beside="paper's method"
            )
        else:
            volt = float(panel.title.partition(" ")[0])
            x, y = _as_share(*data.points(_FILE, f"M={m}", _VOLTS.index(volt)).T)
            curve = Curve("published", x, y, PUBLISHED, "tab:green")
        found[panel.title] = [curve]
    return found


FIGURES = (
    Figure(
        "rotator",
        "spectra of a motor at nine voltages",
        _measure,
        _published,
        notes=(
            "Simulated: 13.1 turns a second a volt, near the published peaks at M = 64. Force 6 N, amplitude 0.6 N.",
        ),
    ),
)
