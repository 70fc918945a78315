# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Words for a person."""

from __future__ import annotations


def counted(number: int, one: str, several: str = "") -> str:
    """A number before what is counted: ``1 frame``, ``2 frames``.

    Parameters
    ----------
    number : int
    one : str
        What stands behind 1.
    several : str
        What stands behind any other number; empty: `one` with an s.
    """
    return f"{number} {one if number == 1 else several or one + 's'}"
