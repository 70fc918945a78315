# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Consistent Overhead Byte Stuffing in numba; the tests compare it with `acts_core.wire.cobs`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel


@kernel
def decode_into(encoded: bytes, decoded: NDArray[np.uint8]) -> int:
    """Undo the stuffing of one packet.

    Parameters
    ----------
    encoded : bytes
        The packet without its delimiter.
    decoded : np.ndarray [shape=(n,), dtype=uint8]
        Where the result goes; `len(encoded)` bytes always suffice.

    Returns
    -------
    int
        Number of bytes written, or -1 where `encoded` is not a valid encoding.
    """
    end = len(encoded)
    position = 0
    written = 0
    while position < end:
        code = encoded[position]
        if code == 0 or position + code > end:
            return -1
        position += 1
        for _ in range(code - 1):
            value = encoded[position]
            if value == 0:
                return -1
            decoded[written] = value
            written += 1
            position += 1
        if code < 0xFF and position < end:
            decoded[written] = 0
            written += 1
    return written


@kernel
def encode_into(data: bytes, encoded: NDArray[np.uint8]) -> int:
    """Stuff one packet, without a delimiter.

    Parameters
    ----------
    data : bytes
        The packet.
    encoded : np.ndarray [shape=(n,), dtype=uint8]
        Where the result goes; `acts_core.wire.cobs.encoded_size_max` bytes always suffice.

    Returns
    -------
    int
        Number of bytes written.
    """
    code_at = 0
    written = 1
    code = 1
    end = len(data)
    for position in range(end):
        value = data[position]
        if value != 0:
            encoded[written] = value
            written += 1
            code += 1
        # A full block carries no zero of its own, so it is closed only where something follows.
        if value == 0 or (code == 0xFF and position + 1 < end):
            encoded[code_at] = code
            code_at = written
            written += 1
            code = 1
    encoded[code_at] = code
    return written
