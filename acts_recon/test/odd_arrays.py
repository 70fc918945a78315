# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Arrays as callers without types give them, and whether kernels are compiled for them."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numba.core.dispatcher import Dispatcher
from numpy.typing import NDArray

KINDS = ("list", "None", "number", "empty", "short", "long", "stacked", "big-endian", "int64", "other float", "object")
"""Names of what `of_another_kind` makes: none of them is what an entry takes."""

ORDERS = ("slice", "reversed", "Fortran", "read-only", "unaligned")
"""Names of what `in_another_order` makes: the same values, for which numba would compile a kernel anew."""


def of_another_kind(right: NDArray[Any], kind: str) -> Any:
    """Something like an array, of another type, shape or size."""
    finite = np.nan_to_num(right, posinf=0.0)
    made: dict[str, Any] = {
        "list": right.tolist(),
        "None": None,
        "number": right.ravel()[0],
        "empty": right[:0],
        "short": right[:-1],
        "long": np.concatenate([right, right]),
        "stacked": right[None],
        "big-endian": right.astype(right.dtype.newbyteorder(">")),
        "int64": finite.astype(np.int64),
        "other float": finite.astype(np.float32 if right.dtype == np.float64 else np.float64),
        "object": right.astype(object),
    }
    return made[kind]


def in_another_order(right: NDArray[Any], order: str) -> NDArray[Any]:
    """The same values of the same type and shape, otherwise in memory."""
    if order == "slice":
        every_second = (slice(None, None, 2),) * right.ndim
        wide = np.zeros([2 * side for side in right.shape], dtype=right.dtype)
        wide[every_second] = right
        return wide[every_second]
    if order == "reversed":
        return np.ascontiguousarray(right[::-1])[::-1]
    if order == "Fortran":
        return np.asfortranarray(right)
    if order == "unaligned":
        made = np.zeros(right.nbytes + 1, dtype=np.uint8)[1:].view(right.dtype).reshape(right.shape)
        made[...] = right
        return made
    fixed = right.copy()
    fixed.flags.writeable = False
    return fixed


@contextmanager
def nothing_compiled() -> Iterator[None]:
    """Fail where a kernel is compiled within, or loaded for arrays of another kind."""
    before = _signatures()
    yield
    assert _signatures() == before


def _signatures() -> dict[str, int]:
    """For how many kinds of arguments each kernel of ours is there."""
    return {
        f"{package}.{name}": len(value.signatures)
        for package, module in list(sys.modules.items())
        if package.startswith("acts_")
        for name, value in vars(module).items()
        if isinstance(value, Dispatcher)
    }
