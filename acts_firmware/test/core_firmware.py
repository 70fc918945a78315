# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The firmware as a whole as a Python object: bytes in, bytes out, no terminal and no clock between."""

from __future__ import annotations

import ctypes
from functools import lru_cache
from types import TracebackType
from typing import Any

import numpy as np
from core_library import installed
from numpy.typing import NDArray

from acts_core.frames import SampleFrame
from acts_core.wire import BoardMessage, Reply, StreamDecoder
from acts_core.wire.board_models import MODEL_CAPACITY

BOARD_ID = 0x1122334455667788
_ROOM = 1 << 18


@lru_cache(maxsize=1)
def _library() -> ctypes.CDLL:
    lib = ctypes.CDLL(str(installed("libcore_probe.so")))
    pointer, u8, i32 = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int
    u32, u64, size = ctypes.c_uint32, ctypes.c_uint64, ctypes.c_size_t
    signatures: dict[str, tuple[Any, list[Any]]] = {
        "firmware_new": (pointer, [i32, u64]),
        "firmware_free": (None, [pointer]),
        "firmware_start_stream": (None, [pointer]),
        "firmware_stop_stream": (None, [pointer]),
        "firmware_receive": (None, [pointer, u8, size]),
        "firmware_measure": (None, [pointer, i32]),
        "firmware_read": (size, [pointer, pointer, size]),
        "firmware_led": (i32, [pointer]),
        "firmware_active_output": (i32, [pointer]),
        "firmware_model": (size, [pointer, pointer]),
        "encode_image": (size, [u32, u64, u32, i32, i32, pointer, pointer]),
        "encode_object": (size, [u32, u64, u32, i32, i32, pointer, pointer]),
    }
    for name, (result, arguments) in signatures.items():
        function = getattr(lib, name)
        function.restype, function.argtypes = result, arguments
    return lib


class CoreFirmware:
    """A board of `side` x `side` row lines and columns that a host has opened.

    What it says is decoded as it is read: replies, images and objects collect in `messages`.
    """

    def __init__(self, side: int = 64) -> None:
        self._probe = _library().firmware_new(side, BOARD_ID)
        self.messages: list[BoardMessage] = []
        self.decoder = StreamDecoder(on_message=self.messages.append)
        self.start_stream()

    def __enter__(self) -> CoreFirmware:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        _library().firmware_free(self._probe)

    def start_stream(self) -> None:
        _library().firmware_start_stream(self._probe)

    def stop_stream(self) -> None:
        _library().firmware_stop_stream(self._probe)

    def receive(self, data: bytes) -> None:
        _library().firmware_receive(self._probe, data, len(data))

    def measure(self, counts: int = 0) -> None:
        """Measure one frame of a skin that has `counts` everywhere."""
        _library().firmware_measure(self._probe, counts)

    def read(self) -> list[SampleFrame]:
        """Frames of all that the board has queued."""
        out = ctypes.create_string_buffer(_ROOM)
        length = _library().firmware_read(self._probe, out, _ROOM)
        frames = self.decoder.feed(out.raw[:length])
        assert self.decoder.malformed == self.decoder.crc_errors == 0, self.decoder.last_error
        return frames

    def replies(self, data: bytes) -> list[Reply]:
        """Replies to some bytes, and to those only."""
        self.read()
        self.messages.clear()
        self.receive(data)
        self.read()
        assert all(isinstance(message, Reply) for message in self.messages)
        return [message for message in self.messages if isinstance(message, Reply)]

    def ask(self, data: bytes) -> Reply:
        """The reply to one command."""
        (reply,) = self.replies(data)
        return reply

    @property
    def led(self) -> bool:
        return bool(_library().firmware_led(self._probe))

    @property
    def active_output(self) -> int:
        return int(_library().firmware_active_output(self._probe))

    @property
    def model(self) -> bytes:
        """Bytes of the model in force; none where there is none."""
        out = ctypes.create_string_buffer(MODEL_CAPACITY)
        length = _library().firmware_model(self._probe, out)
        return out.raw[:length]


def encode_image(sequence: int, board_us: int, duration_us: int, counts: NDArray[np.float32]) -> bytes:
    """The packet, before stuffing."""
    values = np.ascontiguousarray(counts, dtype=np.float32)
    out = ctypes.create_string_buffer(_ROOM)
    length = _library().encode_image(sequence, board_us, duration_us, *values.shape, values.ctypes.data, out)
    return out.raw[:length]


def encode_object(
    sequence: int, board_us: int, duration_us: int, number: int | None, residuals: NDArray[np.float32]
) -> bytes:
    """The packet, before stuffing."""
    values = np.ascontiguousarray(residuals, dtype=np.float32)
    out = ctypes.create_string_buffer(_ROOM)
    object_number = -1 if number is None else number
    length = _library().encode_object(
        sequence, board_us, duration_us, object_number, len(values), values.ctypes.data, out
    )
    return out.raw[:length]
