# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Commands to a board and its replies. `docs/wire_protocol.md` is the description.

Every command carries a request number, which the reply repeats; a reply carries the board's whole state::

    port.write(encode_configure(7, BoardSettings(m=128)))
    decoder = StreamDecoder(on_message=print)
    decoder.feed(port.read())  # prints Reply(request=7, command=CONFIGURE, status=OK, ...)
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import IntEnum

from acts_core.errors import PacketError
from acts_core.sampling import SkinMap
from acts_core.wire.board_models import BoardModel, ModelKind
from acts_core.wire.board_settings import SETTINGS_SIZE, BoardSettings, SettingField
from acts_core.wire.packets import PacketType, seal, version_mismatch

__all__ = [
    "MAP_PIECE_MAX",
    "UPLOAD_PIECE_MAX",
    "BoardSettings",
    "BoardState",
    "HeldModel",
    "Reply",
    "ReplyStatus",
    "SettingField",
    "UnknownReply",
    "UnknownReplyError",
    "decode_reply",
    "encode_configure",
    "encode_map_data",
    "encode_map_end",
    "encode_query",
    "encode_reply",
    "encode_upload_begin",
    "encode_upload_data",
    "encode_upload_end",
]

UPLOAD_PIECE_MAX = 1024
"""Bytes of a model in one packet."""

MAP_PIECE_MAX = 512
"""Places of a layout in one packet."""

_REQUEST = struct.Struct("<I")
# kind, patch side, patch step, objects, rows, columns, bytes, crc32
_UPLOAD_BEGIN = struct.Struct("<BBBBHHII")
_UPLOAD_DATA = struct.Struct("<I")
# request, command, status, reserved, detail, version, flags, board id, uptime
_REPLY_HEAD = struct.Struct("<IBBHI3BBQQ")
# model: kind, patch side, patch step, objects, rows, columns, crc32; capacity, overruns, bad commands
_REPLY_TAIL = struct.Struct("<BBBBHHIIII")

# Of the map in force; boards of earlier firmware end before.
_REPLY_MAP = struct.Struct("<I")
# first place; rows, columns, patch without skin, reserved, crc32
_MAP_DATA = struct.Struct("<H")
_MAP_END = struct.Struct("<4sI")

_REPLY_SIZE = _REPLY_HEAD.size + SETTINGS_SIZE + _REPLY_TAIL.size
_FLAG_SAMPLES_ONLY = 1
_FLAG_UPLOADING = 2
_FLAGS = _FLAG_SAMPLES_ONLY | _FLAG_UPLOADING


class ReplyStatus(IntEnum):
    """How a command ended."""

    OK = 0
    UNKNOWN_COMMAND = 1
    WRONG_VERSION = 2
    BAD_LENGTH = 3
    SETTING_REFUSED = 4
    MODEL_IMPOSSIBLE = 5
    UPLOAD_OUT_OF_ORDER = 6
    MODEL_CHECKSUM = 7
    MAP_IMPOSSIBLE = 8


@dataclass(frozen=True)
class HeldModel:
    """The model that a board has in force; attributes as of `BoardModel`."""

    kind: ModelKind
    rows: int
    columns: int
    patch_side: int
    patch_step: int
    n_objects: int
    crc32: int

    @classmethod
    def of(cls, model: BoardModel) -> HeldModel:
        """How a board will report a model once it is uploaded."""
        return cls(
            model.kind,
            model.rows,
            model.columns,
            model.patch_side,
            model.patch_step,
            model.n_objects,
            model.crc32,
        )


NO_MODEL = HeldModel(ModelKind.NONE, 0, 0, 0, 0, 0, 0)
"""What a board without a model reports."""


@dataclass(frozen=True)
class BoardState:
    """State of a board, as every reply reports it.

    Attributes
    ----------
    firmware_version : tuple of int
        Major, minor, patch.
    board_id : int
        Which board: the Teensy's serial number, the virtual board's ``--board-id``.
    uptime_us : int
        Time since the board's start [us].
    settings : BoardSettings
        The settings in force.
    samples_only : bool
        Whether `settings.output` asks for more than samples, but the model held does not allow it.
    uploading : bool
        Whether a model is being uploaded.
    model : HeldModel
        The model in force; of kind NONE where there is none.
    model_capacity_bytes : int
        What a model may have at most.
    overruns : int
        Frames the board had to drop since its start, wraps at 2**32.
    bad_commands : int
        Damaged packets from the host since the start, wraps at 2**32.
    map_crc32 : int or None
        `SkinMap.crc32` of the layout in force, 0 where that is the matrix itself; None from a board that knows no
        layouts.
    """

    firmware_version: tuple[int, int, int]
    board_id: int
    uptime_us: int
    settings: BoardSettings
    samples_only: bool
    uploading: bool
    model: HeldModel
    model_capacity_bytes: int
    overruns: int
    bad_commands: int
    map_crc32: int | None = None


@dataclass(frozen=True)
class Reply:
    """A board's answer to one command.

    Attributes
    ----------
    request : int
        Number of the command that is answered.
    command : int
        Its packet type.
    status : ReplyStatus
        How it ended.
    detail : int
        SETTING_REFUSED: the `SettingField`; upload commands: the offset the board wants next; otherwise 0.
    state : BoardState
        The board after the command.
    """

    request: int
    command: int
    status: ReplyStatus
    detail: int
    state: BoardState

    @property
    def ok(self) -> bool:
        """Whether the command was carried out."""
        return self.status is ReplyStatus.OK

    @property
    def problem(self) -> str:
        """What went wrong, in words; empty for nothing."""
        if self.status is ReplyStatus.SETTING_REFUSED:
            return f"the board refuses the setting {_field_name(self.detail)}"
        if self.status is ReplyStatus.UPLOAD_OUT_OF_ORDER:
            return f"the board wants the model from byte {self.detail} on"
        return _PROBLEMS[self.status].format(command=self.command, capacity=self.state.model_capacity_bytes)


@dataclass(frozen=True)
class UnknownReply:
    """A whole reply of which this release knows no more than its head, as of firmware of another release.

    Attributes
    ----------
    request : int
        Number of the command that is answered.
    firmware_version : tuple of int
        Major, minor, patch.
    problem : str
        Why it is not known.
    """

    request: int
    firmware_version: tuple[int, int, int]
    problem: str


class UnknownReplyError(PacketError):
    """A reply that is not known as a whole; `reply` is what is known of it."""

    def __init__(self, reply: UnknownReply) -> None:
        super().__init__(reply.problem)
        self.reply = reply


_PROBLEMS = {
    ReplyStatus.OK: "",
    ReplyStatus.UNKNOWN_COMMAND: "the board's firmware does not know command {command}: install a newer one",
    ReplyStatus.WRONG_VERSION: "the board's firmware speaks another version: install the same release as the driver's",
    ReplyStatus.BAD_LENGTH: "the board's firmware wants command {command} in another length: install the same release "
    "as the driver's",
    ReplyStatus.MODEL_IMPOSSIBLE: "the board cannot hold this model: finite numbers in up to {capacity} bytes",
    ReplyStatus.MAP_IMPOSSIBLE: "the board cannot take this layout: not made for its matrix, or damaged on the way",
    ReplyStatus.MODEL_CHECKSUM: "the model's checksum is wrong on the board: upload it again",
}


def _field_name(number: int) -> str:
    return SettingField(number).name.lower() if number in list(SettingField) else f"number {number}"


def encode_query(request: int) -> bytes:
    """Ask for the board's state. `request` is taken modulo 2**32 in all commands."""
    return _command(PacketType.QUERY, request)


def encode_configure(request: int, settings: BoardSettings) -> bytes:
    """Tell the board its settings."""
    return _command(PacketType.CONFIGURE, request, settings.to_bytes())


def encode_upload_begin(request: int, model: BoardModel) -> bytes:
    """Begin to upload a model; the board forgets the one it has."""
    body = _UPLOAD_BEGIN.pack(
        model.kind,
        model.patch_side,
        model.patch_step,
        model.n_objects,
        model.rows,
        model.columns,
        len(model.payload),
        model.crc32,
    )
    return _command(PacketType.UPLOAD_BEGIN, request, body)


def encode_upload_data(request: int, offset: int, piece: bytes) -> bytes:
    """Send the bytes of a model from `offset` on, in order.

    Raises
    ------
    PacketError
        When the piece is empty or longer than `UPLOAD_PIECE_MAX`.
    """
    if not 1 <= len(piece) <= UPLOAD_PIECE_MAX or not 0 <= offset < 1 << 32:
        raise PacketError(f"{len(piece)} bytes at {offset}: a piece of a model has 1 to {UPLOAD_PIECE_MAX} bytes")
    return _command(PacketType.UPLOAD_DATA, request, _UPLOAD_DATA.pack(offset) + piece)


def encode_upload_end(request: int) -> bytes:
    """Put the uploaded model into force."""
    return _command(PacketType.UPLOAD_END, request)


def encode_map_data(request: int, skin_map: SkinMap, first: int) -> bytes:
    """Send up to `MAP_PIECE_MAX` places of a layout, from the place `first` on."""
    entries = skin_map.entries()[2 * first : 2 * (first + MAP_PIECE_MAX)]
    return _command(PacketType.MAP_DATA, request, _MAP_DATA.pack(first) + entries)


def encode_map_end(request: int, skin_map: SkinMap | None) -> bytes:
    """Put the layout that was sent into force; None: the matrix itself."""
    body = bytes(_MAP_END.size) if skin_map is None else _MAP_END.pack(skin_map.head(), skin_map.crc32)
    return _command(PacketType.MAP_END, request, body)


def _command(kind: PacketType, request: int, body: bytes = b"") -> bytes:
    return seal(kind, _REQUEST.pack(request & 0xFFFFFFFF) + body)


def encode_reply(reply: Reply) -> bytes:
    """Encode a reply as the board does, delimiter included: for boards in Python, as tests have them."""
    state = reply.state
    model = state.model
    head = _REPLY_HEAD.pack(
        reply.request,
        reply.command,
        reply.status,
        0,
        reply.detail,
        *state.firmware_version,
        _FLAG_SAMPLES_ONLY * state.samples_only | _FLAG_UPLOADING * state.uploading,
        state.board_id,
        state.uptime_us,
    )
    tail = _REPLY_TAIL.pack(
        model.kind,
        model.patch_side,
        model.patch_step,
        model.n_objects,
        model.rows,
        model.columns,
        model.crc32,
        state.model_capacity_bytes,
        state.overruns,
        state.bad_commands,
    )
    of_map = b"" if state.map_crc32 is None else _REPLY_MAP.pack(state.map_crc32)
    return seal(PacketType.REPLY, head + state.settings.to_bytes() + tail + of_map)


def decode_reply(content: bytes) -> Reply:
    """Read a reply from what stands between the length and the CRC of its packet.

    Raises
    ------
    UnknownReplyError
        When it is not a reply that this release knows, but has the head of one, which no release moves.
    PacketError
        When it is too short even for that.
    """
    try:
        return _decode_known_reply(content)
    except PacketError as error:
        if len(content) < _REPLY_HEAD.size:
            raise
        request, _, _, _, _, major, minor, patch, *_ = _REPLY_HEAD.unpack_from(content)
        raise UnknownReplyError(UnknownReply(request, (major, minor, patch), str(error))) from error


def _decode_known_reply(content: bytes) -> Reply:
    if len(content) not in (_REPLY_SIZE, _REPLY_SIZE + _REPLY_MAP.size):
        raise version_mismatch(
            f"reply of {len(content)} bytes; this release knows {_REPLY_SIZE} and {_REPLY_SIZE + _REPLY_MAP.size}"
        )
    request, command, status, reserved, detail, major, minor, patch, flags, board_id, uptime_us = (
        _REPLY_HEAD.unpack_from(content)
    )
    if status not in list(ReplyStatus) or reserved != 0 or flags & ~_FLAGS:
        raise version_mismatch(f"reply with status {status}, flags {flags}, reserved {reserved}")
    tail = _REPLY_HEAD.size + SETTINGS_SIZE
    kind, side, step, n_objects, rows, columns, crc32, capacity, overruns, bad_commands = _REPLY_TAIL.unpack_from(
        content, tail
    )
    if kind not in list(ModelKind):
        raise version_mismatch(f"reply with a model of kind {kind}")
    model = HeldModel(ModelKind(kind), rows, columns, side, step, n_objects, crc32)
    if model.kind is ModelKind.NONE and model != NO_MODEL:
        # A reply with two settings less is as long as one without the layout; only this tells them apart.
        raise version_mismatch("reply with a size of the model, but without one")
    state = BoardState(
        firmware_version=(major, minor, patch),
        board_id=board_id,
        uptime_us=uptime_us,
        settings=BoardSettings.from_bytes(content[_REPLY_HEAD.size : tail]),
        samples_only=bool(flags & _FLAG_SAMPLES_ONLY),
        uploading=bool(flags & _FLAG_UPLOADING),
        model=model,
        model_capacity_bytes=capacity,
        overruns=overruns,
        bad_commands=bad_commands,
        map_crc32=None if len(content) == _REPLY_SIZE else _REPLY_MAP.unpack_from(content, _REPLY_SIZE)[0],
    )
    return Reply(request, command, ReplyStatus(status), detail, state)
