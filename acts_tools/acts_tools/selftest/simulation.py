# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A virtual board for the self-test, optionally with faulty wiring, and a rough roller in place of the hand."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_sim.shared import TimedRingWriter
from acts_tools.bench.rigs.processes import virtual_board

_STEP_S = 0.01
_STEPS_MAX = 3000
_LEAD_S = 0.2
_AFTER_S = 3600.0
_WIDTH_TAXELS = 2.5
_PEAK_COUNTS = 550.0
_LEAST_SHARE = 0.35


@dataclass(frozen=True)
class SimulatedSkin:
    """A running virtual board.

    Attributes
    ----------
    port : str
        Its port.
    ring : Path
        Ring with the counts of its skin; the skin is untouched while the file is missing.
    """

    port: str
    ring: Path

    @contextmanager
    def rolled(self, rows: int, cols: int, seconds: float) -> Iterator[None]:
        """Roll over the whole skin for `seconds`, once along the columns and once along the rows."""
        # All of it is kept in memory, so what lasts long has longer steps; 3000 are far below a taxel each.
        steps = max(round((seconds - 2 * _LEAD_S) / _STEP_S), 10)
        step_s = _STEP_S * max(1.0, steps / _STEPS_MAX)
        fields = roller_fields(rows, cols, min(steps, _STEPS_MAX))
        begin_ns = time.monotonic_ns() + int(_LEAD_S * 1e9)
        with TimedRingWriter(self.ring, rows * cols, slots=len(fields) + 2) as writer:
            # Written in advance: the board interpolates, and no process needs to keep up with it.
            for step, field in enumerate(fields):
                writer.write(begin_ns + int(step * step_s * 1e9), field.ravel())
            # Untouched afterwards: a board makes no frames of a ring that ends.
            writer.write(begin_ns + int((seconds + _AFTER_S) * 1e9), fields[-1].ravel())
            yield


def roller_fields(rows: int, cols: int, steps: int) -> NDArray[np.float64]:
    """Counts of every taxel while a roller moves over the skin, starting and ending untouched.

    The roller is rough, like a hand: with a smooth one all lines along it would have the same response.

    Returns
    -------
    np.ndarray [shape=(steps, rows, cols), dtype=float64]
    """
    rng = np.random.default_rng(5)
    fields = np.zeros((steps, rows, cols))
    half = steps // 2
    for first, n, side, axis in ((0, half, cols, 1), (half, steps - half, rows, 0)):
        rough = np.pad(rng.normal(size=(rows, cols)), 1, mode="wrap")
        # Averaged over neighbours: bumps of about two taxels.
        knobs = sum(
            rough[r : r + rows, c : c + cols] * (2.0 if (r, c) == (1, 1) else 0.6) for r in range(3) for c in range(3)
        )
        knobs = np.asarray(knobs)
        knobs = (knobs - knobs.min()) / max(float(np.ptp(knobs)), 1e-9)
        peaks = _PEAK_COUNTS * (_LEAST_SHARE + (1 - _LEAST_SHARE) * knobs)
        margin = 4 * _WIDTH_TAXELS
        for step in range(n):
            centre = -margin + (side - 1 + 2 * margin) * step / max(n - 1, 1)
            band = np.exp(-0.5 * ((np.arange(side) - centre) / _WIDTH_TAXELS) ** 2)
            fields[first + step] = peaks * (band if axis == 1 else band[:, np.newaxis])
    fields[[0, -1]] = 0.0
    return fields


@contextmanager
def simulated_skin(folder: Path, rows: int, cols: int, protocol: str, faults: Sequence[str]) -> Iterator[SimulatedSkin]:
    """Run a virtual board with faulty wiring (see ``docs/virtual_board.md``).

    Raises
    ------
    LaunchError
        When it does not start, for example for an impossible fault.
    """
    ring = folder / "field.ring"
    options = ["--rows", str(rows), "--cols", str(cols), "--protocol", protocol, "--field-ring", str(ring)]
    options += ["--m", str(min(55, rows * cols))]
    for fault in faults:
        options += ["--hardware-fault", fault]
    with virtual_board(folder, *options) as board:
        yield SimulatedSkin(str(board.link), ring)
