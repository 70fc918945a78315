# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Taxels of the matrix in words, as parameters and reports name them: ``row=5 col=7 10,12``."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import SettingsError

_WORD = re.compile(r"(?P<line>row|col)=(?P<number>[0-9]{1,4})|(?P<row>[0-9]{1,4}),(?P<col>[0-9]{1,4})")

TAXELS_RULE = "row=R for a whole row, col=C for a whole column, R,C for one taxel, from 0, with blanks between them"
"""How taxels are named, for descriptions and messages."""


def taxels_named(words: str, rows: int, cols: int) -> NDArray[np.bool_]:
    """The taxels that a text names.

    Parameters
    ----------
    words : str
        See `TAXELS_RULE`; empty for none.
    rows, cols : int
        Of the matrix.

    Returns
    -------
    np.ndarray [shape=(rows, cols), dtype=bool]

    Raises
    ------
    SettingsError
        The text is another one, or names what is outside of the matrix.
    """
    named = np.zeros((rows, cols), dtype=np.bool_)
    for word in words.split():
        found = _WORD.fullmatch(word)
        if found is None:
            raise SettingsError(f"{word!r} names no taxels: allowed are {TAXELS_RULE}, as in 'row=5 10,12'")
        is_row, is_col = found["line"] == "row", found["line"] == "col"
        row = 0 if is_col else int(found["number"] if is_row else found["row"])
        col = 0 if is_row else int(found["number"] if is_col else found["col"])
        if row >= rows or col >= cols:
            raise SettingsError(
                f"{word!r} is outside of an array of {rows} x {cols}: it has rows 0 to {rows - 1} and columns 0 to "
                f"{cols - 1}"
            )
        named[slice(None) if is_col else row, slice(None) if is_row else col] = True
    return named


def dead_taxels_named(words: str, rows: int, cols: int) -> NDArray[np.bool_]:
    """`taxels_named` of a setting `dead_taxels`, which its errors name, and which leaves at least one taxel.

    Raises
    ------
    SettingsError
        As of `taxels_named`, or all taxels are named.
    """
    try:
        named = taxels_named(words, rows, cols)
    except SettingsError as error:
        raise SettingsError(f"dead_taxels: {error}") from None
    if named.all():
        raise SettingsError(f"dead_taxels = {words!r}: these are all taxels; leave out those that work")
    return named


def taxels_in_words(taxels: NDArray[np.bool_]) -> str:
    """What `taxels_named` makes these taxels of: whole rows, whole columns, and what is left.

    Parameters
    ----------
    taxels : np.ndarray [shape=(rows, cols), dtype=bool]
    """
    rows, cols = np.flatnonzero(taxels.all(axis=1)), np.flatnonzero(taxels.all(axis=0))
    left = taxels.copy()
    left[rows, :] = False
    left[:, cols] = False
    lines = [f"row={row}" for row in rows] + [f"col={col}" for col in cols if not taxels.all()]
    return " ".join([*lines, *(f"{row},{col}" for row, col in np.argwhere(left))])
