# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the self-test finds, and the thresholds it finds it by."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from acts_core.array import TOUCH_COUNTS
from acts_core.settings import setting, validate


class Level(IntEnum):
    """How bad a finding is."""

    PASS = 0
    WARN = 1
    FAIL = 2


@dataclass(frozen=True)
class Finding:
    """One item of the report.

    Attributes
    ----------
    level : Level
    name : str
        What was looked at, for example ``open rows``.
    text : str
        What was found.
    advice : str
        What to do; empty where nothing is to be done.
    rows, cols : tuple of int
        Lines that are faulty as a whole.
    taxels : tuple of (int, int)
        Single faulty taxels, row and column.
    """

    level: Level
    name: str
    text: str
    advice: str = ""
    rows: tuple[int, ...] = ()
    cols: tuple[int, ...] = ()
    taxels: tuple[tuple[int, int], ...] = ()


@dataclass(frozen=True)
class Thresholds:
    """What counts as a fault. `docs/selftest.md` says how each is used.

    They are no parameters: a class, so that the result can hold them.
    """

    noise_ratio: float = setting(3.0, "noise over that of the median taxel that is a warning", minimum=1.0)
    noise_warn_counts: float = setting(5.0, "and at least so much", minimum=0.0)
    noise_fail_counts: float = setting(20.0, "noise that is a fault: a third of the touch threshold", minimum=0.0)
    high_counts: float = setting(
        float(TOUCH_COUNTS), "untouched reading that is a fault: the touch threshold", minimum=1.0
    )
    rate_share: float = setting(0.98, "least share of the rate that the board could have", minimum=0.0, maximum=1.0)
    lost_share: float = setting(0.001, "largest share of frames lost", minimum=0.0, maximum=1.0)
    drift_ppm: float = setting(200.0, "largest drift of the board's clock against the host's", minimum=0.0)
    jitter_share: float = setting(
        0.05, "largest deviation of a frame's beginning, in shares of the time between frames", minimum=0.0
    )
    taxel_us: tuple[float, ...] = setting((8.0, 30.0), "usual time of one measurement [us]", length=2)
    response_counts: float = setting(30.0, "rise over the baseline that is a response", minimum=1.0)
    response_sigmas: float = setting(8.0, "and at least so many times the taxel's noise", minimum=1.0)
    line_silent: float = setting(0.1, "largest share of a silent line's taxels that respond", minimum=0.0, maximum=1.0)
    line_alive: float = setting(0.5, "least share of the taxels of the lines beside it", minimum=0.0, maximum=1.0)
    same_median: float = setting(0.04, "median difference of lines that are one, over their sum", minimum=0.0)
    same_p90: float = setting(0.12, "and the difference that 90 % keep below", minimum=0.0)
    same_readings: int = setting(60, "pressed pairs of readings that this needs", minimum=1)
    weak_share: float = setting(0.2, "response over that of the taxels around it that is weak", minimum=0.0)
    covered_share: float = setting(0.95, "least share of the sound taxels that were pressed", minimum=0.0, maximum=1.0)

    def __post_init__(self) -> None:
        validate(self)


def listed(numbers: tuple[int, ...]) -> str:
    """Numbers as a person writes them: ``3, 5 to 7``."""
    pieces: list[str] = []
    begin = 0
    for end in range(1, len(numbers) + 1):
        if end == len(numbers) or numbers[end] != numbers[end - 1] + 1:
            first, last = numbers[begin], numbers[end - 1]
            pieces.append(str(first) if first == last else f"{first}{' to ' if last > first + 1 else ', '}{last}")
            begin = end
    return ", ".join(pieces)


def taxels_listed(taxels: tuple[tuple[int, int], ...], most: int = 8) -> str:
    """Taxels as a person writes them, the first few of many."""
    words = ", ".join(f"({row}, {col})" for row, col in taxels[:most])
    return words if len(taxels) <= most else f"{words} and {len(taxels) - most} more"
