# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A host that talks to a virtual board: commands and their replies, uploads, and what the board sends by itself."""

from __future__ import annotations

import os

from board_process import DEADLINE_S, BoardProcess
from waiting import wait_for

from acts_core.frames import SampleFrame
from acts_core.wire import (
    UPLOAD_PIECE_MAX,
    BoardMessage,
    BoardModel,
    BoardSettings,
    Reply,
    ReplyStatus,
    StreamDecoder,
    encode_configure,
    encode_upload_begin,
    encode_upload_data,
    encode_upload_end,
)


class BoardClient:
    """Opens the board's port; `frames` and `messages` hold what came so far."""

    def __init__(self, board: BoardProcess) -> None:
        self._board = board
        self._request = 0
        self.frames: list[SampleFrame] = []
        self.messages: list[BoardMessage] = []
        board.decoder = StreamDecoder(on_message=self.messages.append)
        self._port = board.open_port()

    def read(self) -> None:
        self.frames += self._board.decoder.feed(self._board.read_bytes())

    def read_until_messages(self, kind: type, count: int) -> list[BoardMessage]:
        """The first `count` messages of a kind."""

        def found() -> list[BoardMessage]:
            return [message for message in self.messages if isinstance(message, kind)]

        wait_for(lambda: len(found()) >= count, f"{count} {kind.__name__}", DEADLINE_S, self.read, found)
        return found()[:count]

    def _reply(self, packet: bytes) -> Reply:
        assert os.write(self._port, packet) == len(packet)

        def reply() -> Reply | None:
            replies = (message for message in self.messages if isinstance(message, Reply))
            return next((reply for reply in replies if reply.request == self._request), None)

        message = wait_for(reply, "a reply", DEADLINE_S, self.read)
        assert message.status is ReplyStatus.OK, message
        return message

    def _next(self) -> int:
        self._request += 1
        return self._request

    def configure(self, settings: BoardSettings) -> Reply:
        return self._reply(encode_configure(self._next(), settings))

    def upload(self, model: BoardModel) -> Reply:
        self._reply(encode_upload_begin(self._next(), model))
        for offset in range(0, len(model.payload), UPLOAD_PIECE_MAX):
            piece = model.payload[offset : offset + UPLOAD_PIECE_MAX]
            self._reply(encode_upload_data(self._next(), offset, piece))
        return self._reply(encode_upload_end(self._next()))
