# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Numbers of the command line with the range that is allowed, as `type` of an argument of argparse."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from typing import Any

from acts_core.array import MAX_SIDE, ArrayGeometry


def whole(lowest: int, highest: int | None = None) -> Callable[[str], int]:
    """A whole number from `lowest` to `highest`; without `highest`, any from `lowest` on."""
    allowed = f"{lowest} or more" if highest is None else f"a whole number from {lowest} to {highest}"

    def read(word: str) -> int:
        try:
            value = int(word)
        except ValueError:
            value = None
        if value is None or value < lowest or (highest is not None and value > highest):
            raise argparse.ArgumentTypeError(f"{word}: allowed is {allowed}")
        return value

    return read


def real(lowest: float, highest: float = math.inf) -> Callable[[str], float]:
    """A finite number from `lowest` to `highest`; without `highest`, any from `lowest` on."""
    allowed = f"{lowest:g} or more" if highest == math.inf else f"a number from {lowest:g} to {highest:g}"

    def read(word: str) -> float:
        try:
            value = float(word)
        except ValueError:
            value = math.nan
        if not lowest <= value <= highest or value == math.inf:
            raise argparse.ArgumentTypeError(f"{word}: allowed is {allowed}")
        return value

    return read


def checked_later(kind: type, allowed: str = "") -> Callable[[str], Any]:
    """A value of type int, float or str, in whatever range: who uses it refuses what is not `allowed`.

    Here only what is no number at all is refused, in the same words.
    """
    needed = ", ".join(words for words in ("a whole number" if kind is int else "a number", allowed) if words)

    def read(word: str) -> Any:
        try:
            return kind(word)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{word}: allowed is {needed}") from None

    return read


at_least_one = whole(1)

seconds = real(1e-3)
"""A time for which somebody waits."""

random_seed = whole(0, 2**63 - 1)
"""What random numbers begin from."""

taxels = whole(1, MAX_SIDE**2)
"""How many are measured per frame."""

simulated_taxels = whole(1, ArrayGeometry().size)
"""The same of a simulated skin, whose size is known."""
