# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Results of a measurement."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Figure:
    """One number with its meaning.

    Attributes
    ----------
    key : str
        Name in the JSON file.
    label : str
        Description, for a person.
    value : float, int, str or None
        None where it could not be measured.
    unit : str
        Unit after the number; may be empty.
    is_ratio : bool
        Whether it compares two things measured under the same load, so that it is valid for other machines as well.
    """

    key: str
    label: str
    value: float | int | str | None
    unit: str = ""
    is_ratio: bool = False

    @property
    def text(self) -> str:
        """Value and unit; numbers with four significant digits."""
        if self.value is None:
            return "-"
        shown = shortened(self.value) if isinstance(self.value, float) else str(self.value)
        return f"{shown} {self.unit}".strip()


@dataclass(frozen=True)
class Result:
    """Figures of one measurement.

    Attributes
    ----------
    figures : list of Figure
        In the order in which they are shown.
    problems : list of str
        Failures, as sentences; if there are any, `acts bench` ends with code 1.
    """

    figures: list[Figure]
    problems: list[str] = field(default_factory=list)


def shortened(value: float) -> str:
    """A number with four significant digits, never in scientific notation."""
    return f"{value:.0f}" if abs(value) >= 1000 else f"{value:.4g}"
