# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Result of a self-test, as text and for JSON."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.skin import taxels_in_words
from acts_core.words import counted
from acts_driver.selftest import Finding, Level, Thresholds, Timing, Touched, Untouched

_WIDTH = 16
# Faults by which the readings of taxels say nothing of what presses them. Shorted lines tell that one of both is
# pressed, and what is noisy may have been touched.
_DEAD = ("open rows", "open columns", "stuck taxels", "dead taxels")


@dataclass(frozen=True, eq=False)
class SelfTest:
    """Result of one self-test; `touch` is None where it was skipped."""

    board: str
    rows: int
    cols: int
    scheme: str
    thresholds: Thresholds
    findings: list[Finding]
    skin: Untouched
    timing: Timing
    touch: Touched | None

    @property
    def level(self) -> Level:
        """Level of the worst finding."""
        return max((finding.level for finding in self.findings), default=Level.PASS)

    @property
    def verdict(self) -> str:
        """Summary in one line."""
        counts = {level: sum(finding.level is level for finding in self.findings) for level in Level}
        if self.level is Level.PASS:
            return f"PASS: {counted(len(self.findings), 'item')}, nothing found"
        faults, warnings = counted(counts[Level.FAIL], "fault"), counted(counts[Level.WARN], "warning")
        return f"{self.level.name}: {faults}, {warnings}, {counts[Level.PASS]} good"

    @property
    def dead_taxels(self) -> str:
        """What the parameter of that name is to be until they are mended; empty: none."""
        dead = np.zeros((self.rows, self.cols), dtype=np.bool_)
        for finding in self.findings:
            if finding.name in _DEAD and finding.level is Level.FAIL:
                dead[list(finding.rows), :] = True
                dead[:, list(finding.cols)] = True
                for taxel in finding.taxels:
                    dead[taxel] = True
        return taxels_in_words(dead)

    def text(self) -> str:
        """The report for a person."""
        lines = [f"{self.board}: {self.rows} x {self.cols} taxels, {self.scheme}", ""]
        for finding in self.findings:
            lines.append(f"{finding.level.name}  {finding.name:<{_WIDTH}} {finding.text}")
            if finding.advice:
                lines.append(f"{'':{_WIDTH + 6}} -> {finding.advice}")
        lines += ["", self.verdict]
        if dead := self.dead_taxels:
            lines.append(f"until they are mended, driver and reconstruction do without: dead_taxels: '{dead}'")
        return "\n".join(lines)

    def as_json(self) -> dict[str, Any]:
        """The report for a program; maps are lists of rows, with null for unknown values."""
        timing = self.timing
        late_us = timing.late_us
        return {
            "ok": self.level is not Level.FAIL,
            "level": self.level.name,
            "board": self.board,
            "rows": self.rows,
            "cols": self.cols,
            "scheme": self.scheme,
            "dead_taxels": self.dead_taxels,
            "findings": [{**asdict(finding), "level": finding.level.name} for finding in self.findings],
            "timing": {
                "frames": timing.frames,
                "lost": timing.lost,
                "restarts": timing.restarts,
                "rate_hz": _number(timing.rate_hz),
                "possible_hz": _number(timing.possible_hz),
                "taxel_us": _number(timing.taxel_us),
                "jitter_us": _number(timing.jitter_us),
                "drift_ppm": _number(timing.drift_ppm),
                "late_us_p99": _number(float(np.percentile(late_us, 99))) if len(late_us) else None,
            },
            "noise_counts": _map(self.skin.noise_counts),
            "baseline_counts": _map(self.skin.baseline_counts),
            "response_counts": None if self.touch is None else _map(self.touch.response_counts),
            "thresholds": asdict(self.thresholds),
        }


def _number(value: float) -> float | None:
    return round(float(value), 3) if np.isfinite(value) else None


def _map(values: NDArray[np.float64]) -> list[list[float | None]]:
    return [[_number(value) for value in row] for row in values.tolist()]
