# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Commands to the virtual board over its terminal, as a driver sends them, between the frames of a running stream."""

import os
import time
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from board_process import DEADLINE_S, BoardProcess
from core_library import installed
from waiting import wait_for

from acts_core.frames import SampleFrame, Scheme
from acts_core.wire import (
    UPLOAD_PIECE_MAX,
    BoardMessage,
    Reply,
    StreamDecoder,
    encode_configure,
    encode_query,
    encode_upload_begin,
    encode_upload_data,
    encode_upload_end,
    patch_dictionary,
)
from acts_core.wire.commands import BoardSettings, HeldModel


class Host:
    """A host with a board's port open."""

    def __init__(self, board: BoardProcess) -> None:
        self.board = board
        self.frames: list[SampleFrame] = []
        self.replies: list[Reply] = []
        board.decoder = StreamDecoder(on_message=self._take)
        self._port = board.open_port()

    def _take(self, message: BoardMessage) -> None:
        assert isinstance(message, Reply)
        self.replies.append(message)

    def ask(self, command: bytes, count: int = 1) -> list[Reply]:
        """The replies to as many commands; the frames between collect in `frames`."""
        self.replies.clear()
        os.write(self._port, command)
        wait_for(lambda: len(self.replies) >= count, f"{count} replies", DEADLINE_S, self.read, lambda: self.replies)
        return list(self.replies)

    def say(self, words: bytes) -> None:
        os.write(self._port, words)

    def await_reply(self, request: int) -> None:
        """Read until it is there."""
        wait_for(
            lambda: request in [reply.request for reply in self.replies], f"reply {request}", DEADLINE_S, self.read
        )

    def read(self) -> None:
        self.frames += self.board.decoder.feed(self.board.read_bytes())


def test_the_first_words_of_a_host_are_answered_also_where_they_come_between_two_looks(tmp_path: Path) -> None:
    for number in range(1, 6):
        # Between looking whether somebody is there and reading what is said, 3 ms pass.
        with BoardProcess(tmp_path, preload=installed("libslow_poll.so")) as board:
            (reply,) = Host(board).ask(encode_query(number))
        assert reply.request == number


def test_the_first_words_of_a_host_are_answered_also_where_another_has_just_left(tmp_path: Path) -> None:
    unanswered: list[int] = []
    with BoardProcess(tmp_path, preload=installed("libslow_poll.so")) as board:
        for number in range(0, 20, 2):
            host = Host(board)
            host.say(encode_query(number))
            while len(host.frames) < 2:
                host.read()
            host.say(encode_query(number + 1))
            host.await_reply(number + 1)
            # Replies come in order.
            if number not in [reply.request for reply in host.replies]:
                unanswered.append(number)
            # With last words that are still to be read when the board sees that it has left.
            host.say(b"\1\1\0")
            board.close_port()
            # The board takes as long to see that; the next host comes just after it.
            left_s = time.monotonic()
            wait_for(lambda left_s=left_s: time.monotonic() > left_s + 0.005, "a look")  # type: ignore[misc]
    # A board that is put off the processor between its last look and reading may still confuse two hosts.
    assert len(unanswered) < 5


def test_settings_change_the_running_stream(tmp_path: Path) -> None:
    with BoardProcess(tmp_path, "--board-id", "0xABC", "--rate-hz", 700, "--sample-us", 10) as board:
        host = Host(board)
        (reply,) = host.ask(encode_query(7))
        assert (reply.request, reply.state.board_id) == (7, 0xABC)
        assert reply.state.settings == BoardSettings(frame_period_us=1429)  # 1 / (700 Hz), rounded up
        wanted = BoardSettings(scheme="random", rows=16, cols=8, m=40, frame_period_us=2500, seed=9)
        (reply,) = host.ask(encode_configure(8, wanted))
        assert reply.ok
        assert reply.state.settings == wanted
        frames = board.read_frames(20)
        for frame in frames:
            assert (frame.scheme, frame.rows, frame.cols, len(frame.indices)) == (Scheme.RANDOM, 16, 8, 40)
        for before, frame in pairwise(frames):
            assert frame.board_us - before.board_us == 2500 * (frame.sequence - before.sequence)
        # The change itself cost no frame, and board time never went back.
        for before, frame in pairwise(host.frames + frames):
            assert frame.sequence - before.sequence - 1 == frame.overruns - before.overruns
            assert frame.board_us > before.board_us
        (reply,) = host.ask(encode_query(9))
        assert reply.state.uptime_us >= frames[-1].board_us
        assert board.decoder.malformed == board.decoder.crc_errors == 0


@pytest.mark.parametrize(("given", "board_id"), [("0010", 10), ("0X10", 16), ("18446744073709551615", 2**64 - 1)])
def test_a_board_id_is_decimal_unless_it_says_hexadecimal(tmp_path: Path, given: str, board_id: int) -> None:
    with BoardProcess(tmp_path, "--board-id", given) as board:
        (reply,) = Host(board).ask(encode_query(1))
    assert reply.state.board_id == board_id


def test_a_slow_board_hears_commands_between_its_frames(tmp_path: Path) -> None:
    with BoardProcess(tmp_path, "--rate-hz", 1) as board:
        host = Host(board)
        (reply,) = host.ask(encode_configure(1, BoardSettings(frame_period_us=1000)))
        assert reply.ok
        frames = board.read_frames(30)
        assert frames[-1].overruns == frames[0].overruns


def test_settings_outlive_the_host(tmp_path: Path) -> None:
    settings = BoardSettings(scheme="uniform", m=64, led="touch")
    with BoardProcess(tmp_path, "--status-period-s", 0.02) as board:
        Host(board).ask(encode_configure(1, settings))
        board.leave(board.read_frames(1)[0])
        host = Host(board)
        (reply,) = host.ask(encode_query(2))
        assert reply.state.settings == settings
        assert board.read_frames(3)[-1].scheme is Scheme.UNIFORM


def test_a_host_that_leaves_at_once_is_heard(tmp_path: Path) -> None:
    settings = BoardSettings(m=33, led="off")
    with BoardProcess(tmp_path) as board:
        os.write(board.open_port(), encode_configure(1, settings))
        board.close_port()
        host = Host(board)
        host.ask(encode_query(2))
        # A board that did not notice the gap answers the first command here as well.
        wait_for(lambda: host.replies[-1].request == 2, "the reply to the second", DEADLINE_S, host.read)
        reply = host.replies[-1]
        assert (reply.request, reply.state.settings) == (2, settings)


def test_garbage_from_the_host_leaves_the_stream_alone(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    with BoardProcess(tmp_path) as board:
        host = Host(board)
        noise = rng.integers(0, 256, 20_000).astype(np.uint8).tobytes() + b"\0"
        (reply,) = host.ask(noise + encode_query(3))
        assert reply.request == 3
        assert reply.state.bad_commands > 0
        assert reply.state.settings == BoardSettings()
        assert board.decoder.malformed == board.decoder.crc_errors == 0


def test_a_dictionary_is_uploaded_while_frames_go_on(tmp_path: Path) -> None:
    model = patch_dictionary(np.random.default_rng(2).normal(size=(64, 1000)))
    offsets = range(0, len(model.payload), UPLOAD_PIECE_MAX)
    with BoardProcess(tmp_path) as board:
        host = Host(board)
        assert host.ask(encode_upload_begin(1, model))[0].ok
        for first in range(0, len(offsets), 8):
            pieces = offsets[first : first + 8]
            commands = [
                encode_upload_data(offset, offset, model.payload[offset : offset + UPLOAD_PIECE_MAX])
                for offset in pieces
            ]
            replies = host.ask(b"".join(commands), len(commands))
            assert [reply.request for reply in replies] == list(pieces)
            assert all(reply.ok for reply in replies)
        (reply,) = host.ask(encode_upload_end(2))
        assert reply.ok
        assert reply.state.model == HeldModel.of(model)
        for before, frame in pairwise(host.frames):
            assert frame.sequence - before.sequence - 1 == frame.overruns - before.overruns


def test_a_reset_board_starts_with_its_own_settings(tmp_path: Path) -> None:
    control = tmp_path / "control"
    with BoardProcess(tmp_path, "--control", control) as board:
        host = Host(board)
        assert host.ask(encode_configure(1, BoardSettings(m=20)))[0].state.settings.m == 20
        control.write_text("reset:0\n")
        board.read_until(lambda frame: len(frame.indices) == 55)
        (reply,) = host.ask(encode_query(2))
        assert reply.state.settings == BoardSettings()
