# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Messages of a board besides samples: replies, and the images and objects that it recovers itself."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, MAX_SIDE
from acts_core.errors import PacketError
from acts_core.wire.board_models import OBJECTS_MAX
from acts_core.wire.commands import Reply, UnknownReply, decode_reply
from acts_core.wire.packets import PacketType, unseal, version_mismatch

# sequence, board_us, duration_us, rows, cols, reserved
_IMAGE = struct.Struct("<IQIBBH")
# sequence, board_us, duration_us, object, objects, reserved
_OBJECT = struct.Struct("<IQIBBH")
_NO_OBJECT = 0xFF
_COMMANDS = frozenset(kind for kind in PacketType if kind >= PacketType.QUERY)
_U2 = np.dtype("<u2")
_F4 = np.dtype("<f4")


@dataclass(frozen=True)
class BoardImage:
    """A full image, recovered on the board from one frame.

    Attributes
    ----------
    sequence, board_us : int
        Of the frame it was recovered from.
    duration_us : int
        What recovery took [us].
    counts : np.ndarray [shape=(rows, cols), dtype=uint16]
        ADC counts, 0 to 1023.
    """

    sequence: int
    board_us: int
    duration_us: int
    counts: NDArray[np.uint16]


@dataclass(frozen=True)
class BoardObject:
    """The object that the board recognises in one frame.

    Attributes
    ----------
    sequence, board_us : int
        Of the frame that was classified.
    duration_us : int
        What classification took [us].
    number : int or None
        The object, None where the frame tells nothing.
    residuals : np.ndarray [shape=(n_objects,), dtype=float32]
        How much of the frame each object leaves unexplained; finite, 0 or more.
    """

    sequence: int
    board_us: int
    duration_us: int
    number: int | None
    residuals: NDArray[np.float32]


BoardMessage: TypeAlias = Reply | UnknownReply | BoardImage | BoardObject


def decode_message(packet: bytes) -> BoardMessage:
    """Read a packet of the board other than samples, given without stuffing.

    Raises
    ------
    ChecksumError
        When the packet was damaged on its way.
    UnknownReplyError, PacketError
        When it is none that this release knows.
    """
    kind, content = unseal(packet)
    if kind == PacketType.REPLY:
        return decode_reply(content)
    if kind == PacketType.IMAGE:
        return _decode_image(content)
    if kind == PacketType.OBJECT:
        return _decode_object(content)
    if kind in _COMMANDS:
        raise version_mismatch(
            f"packet type {kind}, a command: what the host sends comes back, as from a modem or a loop instead of a "
            "board, or the board sends what no board of this release does"
        )
    raise version_mismatch(f"packet type {kind}, which no board of this release sends")


def _decode_image(content: bytes) -> BoardImage:
    if len(content) < _IMAGE.size:
        raise PacketError(f"image of {len(content)} bytes; its head alone has {_IMAGE.size}")
    sequence, board_us, duration_us, rows, cols, reserved = _IMAGE.unpack_from(content)
    if reserved != 0 or not (1 <= rows <= MAX_SIDE and 1 <= cols <= MAX_SIDE):
        raise PacketError(f"image of {rows} x {cols}, reserved {reserved}; 1 to {MAX_SIDE} each and 0 are allowed")
    if len(content) != _IMAGE.size + 2 * rows * cols:
        raise PacketError(f"image of {rows} x {cols} in {len(content)} bytes")
    counts = np.frombuffer(content, dtype=_U2, offset=_IMAGE.size).reshape(rows, cols)
    if counts.max() > COUNT_MAX:
        raise PacketError(f"image with counts of {counts.max()}; {COUNT_MAX} is the largest there is")
    return BoardImage(sequence, board_us, duration_us, counts)


def _decode_object(content: bytes) -> BoardObject:
    if len(content) < _OBJECT.size:
        raise PacketError(f"object of {len(content)} bytes; its head alone has {_OBJECT.size}")
    sequence, board_us, duration_us, number, n_objects, reserved = _OBJECT.unpack_from(content)
    known = number < n_objects or number == _NO_OBJECT
    if reserved != 0 or not 1 <= n_objects <= OBJECTS_MAX or not known:
        raise PacketError(f"object {number} of {n_objects}, reserved {reserved}; up to {OBJECTS_MAX} and 0 are allowed")
    if len(content) != _OBJECT.size + 4 * n_objects:
        raise PacketError(f"{n_objects} residuals in {len(content)} bytes")
    residuals = np.frombuffer(content, dtype=_F4, offset=_OBJECT.size)
    if not np.all((residuals >= 0) & np.isfinite(residuals)):
        raise PacketError("object with residuals that are not finite and 0 or more")
    return BoardObject(sequence, board_us, duration_us, None if number == _NO_OBJECT else number, residuals)
