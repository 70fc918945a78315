# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Messages to the page: a JSON header and typed arrays in one piece of bytes. Knows no ROS.

====================  ==================================================================
bytes                 what
====================  ==================================================================
4                     length n of the header, unsigned, little-endian; a multiple of 4
n                     the header, JSON in UTF-8, blanks behind it
the rest              the arrays, one after another, little-endian, zeros up to a multiple of 4 behind each
====================  ==================================================================

The header has a key ``arrays``: for each its name, its type (one of `DTYPES`) and its shape. A browser can view each
array where it lies, because all begin at multiples of 4. `acts_view/page/codec.js` reads it.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ArrayError

DTYPES = ("uint8", "uint16", "uint32", "float32")
"""Types that an array may have; none is wider than the alignment."""

# To ask numpy for the name of a type takes longer than all else that is done with it.
_NAMES = {np.dtype(name): name for name in DTYPES}

_ALIGNMENT = 4

# Made once: `json.dumps` with such options makes one for each message.
_JSON = json.JSONEncoder(allow_nan=False, separators=(",", ":"))


def encode(header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]] | None = None) -> bytes:
    """Make a message.

    Parameters
    ----------
    header : mapping
        What JSON can say; numbers must be finite.
    arrays : mapping of str to np.ndarray, optional
        Of any shape, each with one of `DTYPES`.

    Raises
    ------
    ArrayError
        For another type of array, or a number in the header that is not finite.
    """
    pieces = []
    described = []
    for name, array in (arrays or {}).items():
        kind = _NAMES.get(array.dtype)
        if kind is None:
            raise ArrayError(f"array {name} of {array.dtype}: the page reads {', '.join(DTYPES)}, native")
        described.append([name, kind, list(array.shape)])
        data = array.tobytes() if sys.byteorder == "little" else array.byteswap().tobytes()
        pieces += [data, bytes(-len(data) % _ALIGNMENT)]
    try:
        text = _JSON.encode({**header, "arrays": described}).encode()
    except ValueError as error:
        raise ArrayError(f"header {dict(header)!r}: {error}") from error
    text += b" " * (-len(text) % _ALIGNMENT)
    return b"".join([len(text).to_bytes(4, "little"), text, *pieces])
