# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The host's side of the dialogue with a board, and a board and a way to it that are imagined."""

from __future__ import annotations

import time
from pathlib import Path

from acts_core.frames import SampleFrame
from acts_core.wire import BoardMessage, BoardSettings, BoardState, Reply, ReplyStatus, StreamDecoder, cobs
from acts_core.wire.board_messages import decode_message
from acts_core.wire.board_settings import SETTINGS_SIZE
from acts_core.wire.commands import NO_MODEL, encode_reply
from acts_core.wire.packets import PacketType, seal, unseal
from acts_driver.board import BoardLink, BoardParameters, BoardSession
from acts_driver.board.session import FIRMWARE
from acts_driver.port import Reader, SerialSource

SIZE = (32, 32)
# Long enough for a machine that does not run the board for a while.
PATIENT_S = 2.0


class Host:
    """A reader on a port, a link to its board, and what is wanted of it."""

    def __init__(self, path: Path, reply_timeout_s: float = PATIENT_S, write_limit_s: float = 10.0) -> None:
        self.source = SerialSource(str(path))
        self.link = BoardLink(
            self.source.write, reply_timeout_s=reply_timeout_s, catch_up=lambda timeout_s: self.catch_up(timeout_s)
        )
        self.decoder = StreamDecoder(self.link.receive)
        self.sizes: list[int] = []
        self.published = 0
        self.log: list[str] = []
        self.session: BoardSession | None = None
        self.reader = Reader(
            self.source, self.decoder, self._take, reconnect_s=0.05, on_reconnect=lambda: self.reconnected()
        )
        self.source.open()
        self.reader.start(is_open=True)

    def _take(self, frames: list[SampleFrame], arrival_ns: int) -> None:
        self.sizes += [len(one.indices) for one in frames]
        if self.session is not None and self.session.may_publish:
            self.published += len(frames)

    def catch_up(self, timeout_s: float) -> bool:
        return self.reader.catch_up(timeout_s)

    def reconnected(self) -> None:
        if self.session is not None:
            self.session.reconnected()

    def start_session(self, size: tuple[int, int] = SIZE, **parameters: object) -> BoardSession:
        self.session = BoardSession(
            self.link,
            BoardParameters(**parameters),  # type: ignore[arg-type]
            size=size,
            log=lambda level, words: self.log.append(words),
        )
        self.session.start()
        assert self.session.wait_for_verdict(20.0)
        return self.session

    def close(self) -> None:
        if self.session is not None:
            self.session.stop()
        self.reader.stop()


class LossyWay:
    """A way to an imagined board that loses commands and replies as it is told, and keeps the others in order.

    Without `is_read` the losses are of a machine that does not get to reading.
    """

    def __init__(self, board: SimpleBoard, losses: list[tuple[bool, bool]], *, is_read: bool = True) -> None:
        self.link = BoardLink(self._write, reply_timeout_s=0.001, catch_up=lambda _timeout_s: is_read)
        self._board = board
        self._losses = losses

    def _write(self, data: bytes, timeout_s: float) -> None:
        lost_out, lost_in = self._losses.pop(0) if self._losses else (False, False)
        if not lost_out:
            for reply in self._board.receive(data):
                if not lost_in:
                    self.link.receive(reply)


class SimpleBoard:
    """Takes uploads as docs/wire_protocol.md says, with the real codec of this host on both ends."""

    def __init__(self) -> None:
        self.uploaded = bytearray()
        self.held = b""
        self.begun = 0

    def receive(self, data: bytes) -> list[BoardMessage]:
        kind, content = unseal(cobs.decode(data[:-1]))
        request = int.from_bytes(content[:4], "little")
        status, detail = ReplyStatus.OK, 0
        if kind == PacketType.UPLOAD_BEGIN:
            self.uploaded.clear()
            self.begun += 1
        elif kind == PacketType.UPLOAD_DATA:
            if int.from_bytes(content[4:8], "little") == len(self.uploaded):
                self.uploaded += content[8:]
            else:
                status = ReplyStatus.UPLOAD_OUT_OF_ORDER
            detail = len(self.uploaded)
        elif kind == PacketType.UPLOAD_END:
            self.held = bytes(self.uploaded)
        state = BoardState((0, 1, 0), 1, 0, BoardSettings(), False, True, NO_MODEL, 262_144, 0, 0)
        packet = encode_reply(Reply(request, kind, status, detail, state))
        return [decode_message(cobs.decode(packet[:-1]))]


class OtherBoard:
    """An imagined board with firmware of another release: its replies hold a setting that this one does not know."""

    def __init__(self, version: tuple[int, int, int]) -> None:
        self.link = BoardLink(self._write, reply_timeout_s=0.001)
        self._version = version
        self._decoder = StreamDecoder(self.link.receive)

    def _write(self, data: bytes, timeout_s: float) -> None:
        kind, content = unseal(cobs.decode(data[:-1]))
        request = int.from_bytes(content[:4], "little")
        state = BoardState(self._version, 1, 0, BoardSettings(), False, False, NO_MODEL, 262_144, 0, 0, 0)
        _, known = unseal(cobs.decode(encode_reply(Reply(request, kind, ReplyStatus.OK, 0, state))[:-1]))
        before_model = 32 + SETTINGS_SIZE
        self._decoder.feed(seal(PacketType.REPLY, known[:before_model] + bytes(2) + known[before_model:]))


class OtherLink(BoardLink):
    """A way to an imagined board, or to another one in its place, that may be reset just before it is told settings."""

    def __init__(self) -> None:
        super().__init__(lambda data, timeout_s: None)
        self.board_id, self.settings = 7, BoardSettings(m=55)
        self.started_s = time.monotonic() - 100.0
        self.is_reset_by_configuring = False

    def query(self) -> Reply:
        uptime_us = int((time.monotonic() - self.started_s) * 1e6)
        state = BoardState((*FIRMWARE, 0), self.board_id, uptime_us, self.settings, False, False, NO_MODEL, 0, 0, 0, 0)
        return Reply(0, PacketType.QUERY, ReplyStatus.OK, 0, state)

    def configure(self, settings: BoardSettings) -> Reply:
        if self.is_reset_by_configuring:
            self.is_reset_by_configuring, self.started_s = False, time.monotonic()
        self.settings = settings
        return self.query()
