# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Unpack what bags hold compressed, with a limit that holds whatever size a bag itself says."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Protocol

from lz4.frame import LZ4FrameDecompressor

from acts_core.errors import RecordingError

if sys.version_info >= (3, 14):
    from compression import zstd as zstd
else:
    from backports import zstd as zstd

# Recorders close a chunk after some megabytes. It is unpacked as a whole, so a larger one could fill the memory.
CHUNK_BYTES_MAX = 1 << 28
"""Largest size of a chunk, and of a message that is compressed by itself, when unpacked."""

_PIECE_BYTES = 1 << 20


class _Decompressor(Protocol):
    @property
    def eof(self) -> bool: ...

    @property
    def unused_data(self) -> bytes | None: ...

    def decompress(self, data: bytes, max_length: int = -1) -> bytes: ...


_KINDS: dict[str, type[_Decompressor]] = {"lz4": LZ4FrameDecompressor, "zstd": zstd.ZstdDecompressor}


def unpack(data: bytes, kind: str, bytes_max: int = CHUNK_BYTES_MAX) -> bytes:
    """Unpack a chunk or a message.

    Parameters
    ----------
    data : bytes
        One or several frames, one after another.
    kind : str
        lz4 or zstd.
    bytes_max : int
        Not more than this is unpacked [bytes].

    Raises
    ------
    RecordingError
        It is damaged, or larger.
    """
    parts, left = [], bytes_max
    while data:
        decompressor = _KINDS[kind]()
        try:
            # One byte more than allowed shows that there is more.
            parts.append(decompressor.decompress(data, left + 1))
        except (RuntimeError, zstd.ZstdError) as error:
            raise RecordingError(f"data compressed by {kind} are damaged: {error}") from error
        left -= len(parts[-1])
        if left < 0:
            raise RecordingError(f"data compressed by {kind} unpack to more than the {bytes_max} bytes that are due")
        if not decompressor.eof:
            raise RecordingError(f"data compressed by {kind} end too early")
        data = decompressor.unused_data or b""
    return b"".join(parts)


def unpacked_bytes(path: Path, bytes_max: int) -> int:
    """Size of a zstd file when unpacked, or the first one found above `bytes_max` [bytes].

    Raises
    ------
    RecordingError
        It is damaged.
    """
    total = 0
    try:
        with zstd.open(path, "rb") as stream:
            while total <= bytes_max and (piece := stream.read(_PIECE_BYTES)):
                total += len(piece)
    except (EOFError, zstd.ZstdError) as error:
        raise RecordingError(f"{path}: compressed data are damaged: {error}") from error
    return total
