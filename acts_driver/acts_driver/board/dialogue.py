# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Commands to a board and their replies, within bounded time."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from functools import partial

from acts_core.errors import BoardError
from acts_core.sampling import SkinMap
from acts_core.wire import (
    MAP_PIECE_MAX,
    UPLOAD_PIECE_MAX,
    BoardMessage,
    BoardModel,
    BoardSettings,
    Reply,
    ReplyStatus,
    UnknownReply,
    encode_configure,
    encode_map_data,
    encode_map_end,
    encode_query,
    encode_upload_begin,
    encode_upload_data,
    encode_upload_end,
)

REPLY_TIMEOUT_S = 0.1
"""How long one reply is waited for; a virtual board answers after a frame, within a millisecond or two."""

TRIES = 3
"""How often a command is sent before the board counts as silent. Repeating one is harmless."""

COMPUTING_MAX_S = 20.0
"""A board that makes an image or tells an object hears nothing meanwhile; so long is waited for it at most [s]."""

FIRST_RESULT_S = 2.0
"""So long is waited for that until a result has told how long it takes [s]."""

CATCH_UP_S = 1.0
"""How long it is waited for the thread that reads, before it is said that a board does not answer."""

Write = Callable[[bytes, float], None]
"""Writes bytes to the board within a time [s], or raises `PortError`; see `acts_driver.port.source.Source.write`."""


class NoAnswerError(BoardError):
    """The board does not answer: an older firmware, another sketch, or a stuck one."""


class NotHeardError(NoAnswerError):
    """Whether the board answers is not known: this machine is too busy to read what it sends."""


class UnknownAnswerError(BoardError):
    """The board answers as this release does not know it; `reply` is what is known of its answer."""

    def __init__(self, reply: UnknownReply) -> None:
        super().__init__(f"the board answers as this driver does not know it ({reply.problem})")
        self.reply = reply


class RefusedError(BoardError):
    """The board refuses a command; `reply` is its reply."""

    def __init__(self, reply: Reply) -> None:
        super().__init__(reply.problem)
        self.reply = reply


class BoardLink:
    """Commands and replies, one at a time, over a source that somebody else reads.

    Give `receive` to the decoder as `on_message`. Whoever calls a command waits; the thread that reads never does.

    Parameters
    ----------
    write : callable
        See `Write`.
    reply_timeout_s : float
        How long a reply is waited for, and how long writing may take [s].
    tries : int
        How often a command is sent.
    catch_up : callable
        Waits up to a time [s] until all that has arrived is decoded, and says whether it is; see `Reader.catch_up`.
    """

    def __init__(
        self,
        write: Write,
        *,
        reply_timeout_s: float = REPLY_TIMEOUT_S,
        tries: int = TRIES,
        catch_up: Callable[[float], bool] = lambda timeout_s: True,
    ) -> None:
        self._write = write
        self._catch_up = catch_up
        self._has_answered = False
        self._computing_s = 0.0
        self._timeout_s = reply_timeout_s
        self._tries = tries
        self._turn = threading.Lock()
        self._arrived = threading.Condition()
        # Replies to an earlier process may still arrive: begin at a request number of our own.
        self._request = time.monotonic_ns() & 0xFFFFFFFF
        self._reply: Reply | UnknownReply | None = None

    def receive(self, message: BoardMessage) -> None:
        """Handle a message of the board, on the reader's thread: the reply to the last command, or a result.

        A result tells how long the board computes, and hears nothing, after each frame.
        """
        if not isinstance(message, Reply | UnknownReply):
            self._computing_s = min(message.duration_us * 1e-6, COMPUTING_MAX_S)
            return
        if isinstance(message, Reply):
            if message.state.samples_only or message.state.settings.output == "samples":
                self._computing_s = 0.0
            elif not self._computing_s:
                self._computing_s = FIRST_RESULT_S
        with self._arrived:
            if message.request == self._request:
                self._reply = message
                self._has_answered = True
                self._arrived.notify_all()

    def query(self) -> Reply:
        """Ask for the board's state.

        Raises
        ------
        NoAnswerError
            No reply came, however often it was asked; `NotHeardError` where one may have come that was not read yet.
        UnknownAnswerError
            One came that this release does not know.
        PortError
            The port is not open, was lost, or takes no bytes.
        RefusedError
            The board does not know the command.
        """
        return self._done(self._exchange(encode_query))

    def configure(self, settings: BoardSettings) -> Reply:
        """Tell the board its settings; raises as `query` does, `RefusedError` for a setting that it refuses."""
        return self._done(self._exchange(lambda request: encode_configure(request, settings)))

    def arrange(self, skin_map: SkinMap | None) -> Reply:
        """Tell the board how its taxels lie on the skin, None: as in the matrix; raises as `query` does."""
        if skin_map is not None:
            for first in range(0, len(skin_map.taxels), MAP_PIECE_MAX):
                self._done(self._exchange(partial(encode_map_data, skin_map=skin_map, first=first)))
        return self._done(self._exchange(lambda request: encode_map_end(request, skin_map)))

    def announce(self, model: BoardModel) -> Reply:
        """Begin an upload, which ends one under way; raises as `query` does, `RefusedError` where it cannot be held.

        What the board held is gone then.
        """
        return self._done(self._exchange(lambda request: encode_upload_begin(request, model)))

    def upload(self, model: BoardModel, is_wanted: Callable[[], bool] = lambda: True) -> Reply | None:
        """Give the board a model.

        Parameters
        ----------
        model : BoardModel
        is_wanted : callable
            Asked before every piece; the upload is given up where it says no.

        Returns
        -------
        Reply or None
            None where it was given up.

        Raises
        ------
        NoAnswerError, PortError, RefusedError
            As `query`, and for a model that the board cannot hold, or a board that was restarted meanwhile.
        """
        self.announce(model)
        size = len(model.payload)
        at = 0
        not_heard: NotHeardError | None = None
        # Each piece may be asked for again; a board that never gets on is given up.
        for _ in range(2 * (size // UPLOAD_PIECE_MAX + 2)):
            if not is_wanted():
                return None
            if at >= size:
                return self._done(self._exchange(encode_upload_end))
            piece = model.payload[at : at + UPLOAD_PIECE_MAX]
            try:
                reply = self._exchange(partial(encode_upload_data, offset=at, piece=piece))
            except NotHeardError as error:
                # The board keeps what it has: from a busy machine, an upload that begins anew each time would not end.
                not_heard = error
                continue
            not_heard = None
            if reply.status is ReplyStatus.UPLOAD_OUT_OF_ORDER and reply.state.uploading and reply.detail <= size:
                # The board has the piece already; its reply was lost.
                at = reply.detail
                continue
            self._done(reply)
            at += len(piece)
        if not_heard is not None:
            raise not_heard
        raise NoAnswerError(f"the board took no more than {at} of the model's {size} bytes; reset it")

    def _exchange(self, encode: Callable[[int], bytes]) -> Reply:
        with self._turn:
            with self._arrived:
                self._request = (self._request + 1) & 0xFFFFFFFF
                self._reply = None
            packet = encode(self._request)
            for _ in range(self._tries):
                self._write(packet, self._timeout_s)
                with self._arrived:
                    if self._arrived.wait_for(lambda: self._reply is not None, self._timeout_s):
                        return self._known()
            # Not before this machine has seen that there is none: a busy one reads late.
            has_heard_all = self._catch_up(CATCH_UP_S)
            with self._arrived:
                # The answer may be behind the frames that waited on the board until this machine read, or the board
                # still be busy with the last frame.
                if self._arrived.wait_for(lambda: self._reply is not None, self._timeout_s + self._computing_s):
                    return self._known()
        if not has_heard_all:
            raise NotHeardError(
                "this machine is too slow or too busy to read all that the board sends, an answer among it perhaps "
                "(acts doctor tells)"
            )
        if self._has_answered:
            raise NoAnswerError("the board does not answer commands any more (it hangs, or is another one)")
        raise NoAnswerError("the board does not answer commands (an older firmware, or another sketch)")

    def _known(self) -> Reply:
        """The reply that has come."""
        assert self._reply is not None
        if isinstance(self._reply, UnknownReply):
            raise UnknownAnswerError(self._reply)
        return self._reply

    @staticmethod
    def _done(reply: Reply) -> Reply:
        if not reply.ok:
            raise RefusedError(reply)
        return reply
