# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Dictionaries for the evaluation: from files, and two that are not learnt."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import DictionaryError
from acts_core.files import read_npz
from acts_recon.sparse import Dictionary, load_dictionary

_ATOMS = 1000
_SIDE = 8


def dictionary_named(word: str) -> Dictionary:
    """A dictionary from a file of `acts train`, or for ``FILE:ARRAY`` from an array (pixels, atoms) of any npz file.

    Raises
    ------
    DictionaryError
        When there is none.
    """
    name, separator, array = word.rpartition(":")
    if not separator or Path(word).exists():
        return load_dictionary(Path(word))
    atoms = read_npz(Path(name), (array,), error=DictionaryError).get(array)
    if atoms is None or atoms.ndim != 2:
        found = "there is none" if atoms is None else f"it has shape {atoms.shape}"
        raise DictionaryError(f"{word}: needed is an array {array!r} (pixels, atoms); {found} in {name}")
    return Dictionary(atoms, math.isqrt(atoms.shape[0]), {}, word)


def cosine_dictionary() -> Dictionary:
    """Overcomplete discrete cosine transform of a patch's pixels as one sequence, as in the paper's comparison (S8).

    Atom k is ``cos(pi * k * pixel / atoms)`` over the pixels of the patch, column by column, minus its mean (except
    atom 0), and normalised.
    """
    pixel, k = np.arange(_SIDE**2)[:, None], np.arange(_ATOMS)[None, :]
    waves = np.cos(np.pi * k * pixel / _ATOMS)
    waves[:, 1:] -= waves[:, 1:].mean(axis=0)
    return Dictionary((waves / np.linalg.norm(waves, axis=0)).astype(np.float32), _SIDE, {}, "overcomplete DCT")


def haar_dictionary() -> Dictionary:
    """Overcomplete Haar: products of boxes and steps of 1, 2, 4, ... pixels at every position along rows and columns.

    There are 1156 products for a patch of 8 x 8; the 1000 that cover most pixels are used, normalised.
    """
    line = _haar_line(_SIDE)
    products = np.array([np.kron(along_cols, along_rows) for along_cols in line for along_rows in line])
    widest = np.argsort(-np.count_nonzero(products, axis=1), kind="stable")[:_ATOMS]
    chosen = products[widest].T
    return Dictionary((chosen / np.linalg.norm(chosen, axis=0)).astype(np.float32), _SIDE, {}, "overcomplete Haar")


def _haar_line(side: int) -> NDArray[np.float64]:
    """Boxes of every dyadic width, then steps, each at every position; np.ndarray [shape=(n, side)]."""
    rows = []
    for step in (False, True):
        width = 2 if step else 1
        while width <= side:
            for start in range(side - width + 1):
                row = np.zeros(side)
                row[start : start + width] = 1
                if step:
                    row[start + width // 2 : start + width] = -1
                rows.append(row)
            width *= 2
    return np.array(rows)
