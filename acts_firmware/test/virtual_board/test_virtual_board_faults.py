# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The virtual board's faults, seen by a reader of bytes."""

import itertools
import json
import os
import subprocess
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from board_process import DEADLINE_S, BoardProcess
from core_library import installed
from waiting import wait_for

from acts_core.frames import SampleFrame
from acts_core.wire import BoardMessage, BoardSettings, Reply, StreamDecoder, encode_configure, encode_query

pytestmark = pytest.mark.slow


@pytest.fixture
def board(tmp_path: Path) -> Iterator[BoardProcess]:
    with BoardProcess(tmp_path, "--control", tmp_path / "control") as board:
        board.open_port()
        board.read_frames(20)
        yield board


def inject(board: BoardProcess, *faults: str) -> None:
    (board.link.parent.parent / "control").write_text("".join(f"{fault}\n" for fault in faults))


def event(board: BoardProcess, fault: str, *, over: bool) -> dict[str, Any]:
    line = board.status()
    assert (line["fault"], line["over"]) == (fault, over)
    return line


def play(board: BoardProcess, fault: str) -> list[SampleFrame]:
    """Frames around a fault, from one before its request to 20 ms after its end."""
    assert board.process.stdout is not None
    os.set_blocking(board.process.stdout.fileno(), False)
    frames = board.read_frames(1)
    # None of them may be waiting from before a pause of this process.
    while board.start["epoch_monotonic_ns"] + frames[-1].board_us * 1000 < time.monotonic_ns() - 5_000_000:
        frames = board.read_frames(1)
    inject(board, fault)
    events: list[bytes] = []
    deadline = time.monotonic() + DEADLINE_S
    while len(events) < 2:
        assert time.monotonic() < deadline, f"no end of {fault}"
        frames += board.read_frames(1)
        events += board.process.stdout.readlines()
    end = json.loads(events[-1])
    # By the board's clock: frames from before the fault may still be waiting to be read.
    while end["epoch_monotonic_ns"] + frames[-1].board_us * 1000 < end["monotonic_ns"] + 20_000_000:
        frames += board.read_frames(1)
    return frames


def missing(frames: list[SampleFrame]) -> int:
    """Frames lost on the way: not those that the board itself dropped."""
    first, last = frames[0], frames[-1]
    return last.sequence - first.sequence + 1 - len(frames) - (last.overruns - first.overruns)


def test_a_burst_of_garbage_costs_one_frame_at_most(board: BoardProcess) -> None:
    frames = play(board, "garbage:5000")
    assert missing(frames) <= 1
    assert board.decoder.malformed + board.decoder.crc_errors > 0


@pytest.mark.parametrize("fault", ["flip:1", "flip:20", "truncate:1"])
def test_a_damaged_packet_is_no_frame(board: BoardProcess, fault: str) -> None:
    assert 1 <= missing(play(board, fault)) <= 2
    assert board.decoder.malformed + board.decoder.crc_errors >= 1


def test_lost_bytes_take_the_packets_they_touch(board: BoardProcess) -> None:
    assert 3 <= missing(play(board, "lose:1000")) <= 5


def test_dropped_packets_are_gone(board: BoardProcess) -> None:
    assert missing(play(board, "drop:7")) == 7
    assert board.decoder.malformed == board.decoder.crc_errors == 0


def test_doubled_packets_come_twice(board: BoardProcess) -> None:
    counts = Counter(frame.sequence for frame in play(board, "double:5"))
    assert Counter(counts.values())[2] == 5
    assert max(counts.values()) == 2


@pytest.mark.parametrize("fault", ["drop:3", "double:3", "truncate:3"])
def test_faults_that_count_frames_pass_over_replies(tmp_path: Path, fault: str) -> None:
    with BoardProcess(tmp_path, "--control", tmp_path / "control", "--rate-hz", 50) as board:
        replies: list[BoardMessage] = []
        board.decoder = StreamDecoder(on_message=replies.append)
        port = board.open_port()
        frames = board.read_frames(1)
        assert board.process.stdout is not None
        os.set_blocking(board.process.stdout.fileno(), False)
        inject(board, fault)
        events: list[bytes] = []
        asked = 0
        deadline = time.monotonic() + DEADLINE_S
        while len(events) < 2:
            asked += 1
            os.write(port, encode_query(asked))
            while len(replies) < asked:
                assert time.monotonic() < deadline, f"no reply to query {asked}"
                frames += board.decoder.feed(board.read_bytes())
            events += board.process.stdout.readlines()
        frames += board.read_frames(2)
        assert asked > 1
        assert [reply.request for reply in replies if isinstance(reply, Reply)] == list(range(1, asked + 1))
        if fault == "double:3":
            counts = Counter(frame.sequence for frame in frames)
            assert sorted(counts.values())[-4:] == [1, 2, 2, 2]
        else:
            assert missing(frames) == 3


def test_a_rate_of_flips_ends_when_it_is_told_to(board: BoardProcess) -> None:
    inject(board, "flip-rate:0.0005")  # about every second packet
    before = board.decoder.malformed + board.decoder.crc_errors
    frames = board.read_frames(100)
    assert missing(frames) > 20
    assert board.decoder.malformed + board.decoder.crc_errors > before + 10
    inject(board, "flip-rate:0")
    event(board, "flip-rate:0.0005", over=False)
    event(board, "flip-rate:0", over=True)
    last = board.read_frames(100)[-1]
    assert missing([frame for frame in board.read_frames(100) if frame.sequence > last.sequence]) == 0


def test_another_version_has_a_right_checksum(board: BoardProcess) -> None:
    inject(board, "version:9")
    while board.decoder.malformed < 10:
        board.decoder.feed(board.read_bytes())
    assert "version 9" in board.decoder.last_error
    assert board.decoder.crc_errors == 0
    inject(board, "version:1")
    board.read_frames(10)


def test_a_stalled_link_catches_up(board: BoardProcess) -> None:
    frames = play(board, "stall:0.2")
    assert missing(frames) == 0
    assert board.decoder.malformed == board.decoder.crc_errors == 0


def test_a_frozen_board_makes_no_frames(board: BoardProcess) -> None:
    frames = play(board, "freeze:0.4")
    assert missing(frames) == 0
    steps = [after.board_us - before.board_us for before, after in itertools.pairwise(frames)]
    assert max(steps) >= 399_000


def test_status_comes_in_a_pause_and_is_not_made_up_for_after_it(tmp_path: Path) -> None:
    with BoardProcess(tmp_path, "--fault", "freeze:1@0.2", "--status-period-s", 0.1) as board:
        lines = [board.status()]
        while not lines[-1].get("over"):
            lines.append(board.status())
        began = next(i for i, line in enumerate(lines) if "fault" in line)
        during = lines[began + 1 : -1]
        assert len(during) >= 3
        assert len({line["frames"] for line in during}) == 1
        after = [board.status()]
        while after[-1]["frames"] < during[-1]["frames"] + 300:
            after.append(board.status())
        assert len(after) <= 8


def test_a_query_that_waited_for_a_frozen_board_is_answered_with_the_time_by_then(board: BoardProcess) -> None:
    replies: list[BoardMessage] = []
    board.decoder = StreamDecoder(on_message=replies.append)
    port = board.open_port()
    board.read_frames(1)
    inject(board, "freeze:1")
    began = event(board, "freeze:1", over=False)
    os.write(port, encode_query(1))
    event(board, "freeze:1", over=True)
    wait_for(lambda: replies, "a reply", DEADLINE_S, lambda: board.read_frames(1))
    (reply,) = replies
    assert isinstance(reply, Reply)
    began_us = (began["monotonic_ns"] - board.start["epoch_monotonic_ns"]) // 1000
    assert reply.state.uptime_us >= began_us + 1_000_000


def test_a_pause_longer_than_the_clock_wraps_is_counted_whole(board: BoardProcess) -> None:
    inject(board, "freeze:1")
    event(board, "freeze:1", over=False)
    # Two hours in all; micros() wraps after 71 minutes.
    for _ in range(2):
        inject(board, "jump:3600")
        line = board.status()
        while (line["fault"], line["over"]) != ("jump:3600", True):
            line = board.status()
    board.read_until(lambda frame: frame.board_us > 7_200_000_000)


@pytest.mark.parametrize(("fault", "step_us"), [("jump:30", 30_000_000), ("jump:-2", 2**32 - 2_000_000)])
def test_a_jump_of_the_clock(board: BoardProcess, fault: str, step_us: int) -> None:
    frames = play(board, fault)

    def largest_step_us() -> int:
        return max(after.board_us - before.board_us for before, after in itertools.pairwise(frames))

    # Frames from before the jump may still be waiting, and their clock does not tell.
    wait_for(
        lambda: largest_step_us() >= 1_000_000, "the jump", DEADLINE_S, lambda: frames.extend(board.read_frames(1))
    )
    assert step_us <= largest_step_us() < step_us + 1_000_000
    assert missing(frames) == 0


def read_to_the_end(board: BoardProcess) -> StreamDecoder:
    """What the open port still gives before it is gone, in a decoder that saw it from its beginning."""
    decoder = StreamDecoder()
    try:
        while data := board.read_bytes(may_end=True):
            decoder.feed(data)
    except OSError:
        pass
    return decoder


def test_unplugged_in_the_middle_of_a_packet_and_back_under_another_name(board: BoardProcess) -> None:
    port = board.start["port"]
    inject(board, "unplug:0.1")
    read_to_the_end(board)
    began = event(board, "unplug:0.1", over=False)
    over = event(board, "unplug:0.1", over=True)
    assert over["monotonic_ns"] - began["monotonic_ns"] >= 100_000_000
    assert str(board.link.readlink()) == over["port"] != port
    board.close_port()
    board.open_port()
    frames = board.read_frames(20)
    assert board.decoder.malformed == board.decoder.crc_errors == 0
    # The board had power all the time.
    assert frames[0].sequence > 100


def test_a_reset_with_a_port_that_stays(board: BoardProcess) -> None:
    inject(board, "reset")
    first = board.read_until(lambda frame: frame.sequence < 5)
    assert first.board_us < 1_000_000
    began = event(board, "reset", over=False)
    event(board, "reset", over=True)
    assert began["port"] == board.start["port"]
    assert began["epoch_monotonic_ns"] > board.start["epoch_monotonic_ns"]
    assert board.decoder.malformed + board.decoder.crc_errors <= 1  # the packet that was cut


def test_a_reset_with_a_port_that_goes(board: BoardProcess) -> None:
    inject(board, "reset:0.05")
    read_to_the_end(board)
    event(board, "reset:0.05", over=False)
    event(board, "reset:0.05", over=True)
    board.close_port()
    board.open_port()
    frames = board.read_frames(3)
    assert frames[0].board_us == frames[0].sequence * 1000 + frames[0].duration_us


def test_a_reset_forgets_what_the_host_had_set(board: BoardProcess) -> None:
    port = board.open_port()
    os.write(port, encode_configure(1, BoardSettings(m=20)))
    board.read_until(lambda frame: len(frame.indices) == 20)
    inject(board, "reset")
    first = board.read_until(lambda frame: frame.sequence < 5)
    assert len(first.indices) == 55


def test_a_schedule_on_the_command_line(tmp_path: Path) -> None:
    with BoardProcess(tmp_path, "--fault", "unplug:0@0.3", "--fault", "freeze:0.01@0.1") as board:
        for fault, over in (("freeze:0.01", False), ("freeze:0.01", True), ("unplug:0", False), ("unplug:0", True)):
            last = event(board, fault, over=over)
        assert last["monotonic_ns"] - board.start["epoch_monotonic_ns"] >= 300_000_000
        board.open_port()
        board.read_frames(3)


@pytest.mark.parametrize("kind", ["freeze", "unplug", "reset"])
def test_of_faults_that_overlap_each_is_over_at_its_own_time(tmp_path: Path, kind: str) -> None:
    long, short = f"{kind}:0.5", f"{kind}:0.2"
    # The last one, so that an end that never comes is missed and not waited for.
    with BoardProcess(tmp_path, "--fault", long, "--fault", short, "--fault", "jump@3") as board:
        lines = [board.status() for _ in range(4)]
        assert [(line["fault"], line["over"]) for line in lines[:2]] == [(long, False), (short, False)]
        ends = {line["fault"]: line for line in lines[2:]}
        assert [ends[fault]["over"] for fault in (long, short)] == [True, True]
        for line, shortest_ns in zip(lines, (500_000_000, 200_000_000), strict=False):
            assert ends[line["fault"]]["monotonic_ns"] - line["monotonic_ns"] >= shortest_ns
        assert str(board.link.readlink()) == ends[long]["port"]
        board.open_port()
        board.read_frames(3)


def test_control_refuses_in_words_and_goes_with_the_board(tmp_path: Path) -> None:
    with BoardProcess(tmp_path, "--control", tmp_path / "control") as board:
        inject(board, "earthquake:9", "drop:0.5", "freeze:0")
        event(board, "freeze:0", over=False)
        assert "unknown fault 'earthquake'; allowed are unplug, reset," in board.errors.read_text()
        assert "drop:0.5: allowed is a whole number N from 1 to 1000000" in board.errors.read_text()
        assert board.terminate() == 0
        assert not (tmp_path / "control").exists()


def test_control_of_a_running_board_is_left_to_it(board: BoardProcess, tmp_path: Path) -> None:
    control = tmp_path / "control"
    command = [str(installed("virtual_board")), "--link", str(tmp_path / "other"), "--control", str(control)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=30)
    assert result.returncode == 2
    assert f"--control {control}: in use by a running board" in result.stderr
    for fault in ("freeze:0", "freeze:0.01"):
        inject(board, fault)
        event(board, fault, over=False)
        event(board, fault, over=True)


def test_control_of_a_killed_board_is_taken_over(tmp_path: Path) -> None:
    control = tmp_path / "control"
    with BoardProcess(tmp_path, "--control", control) as killed:
        killed.process.kill()
        killed.process.wait(DEADLINE_S)
    assert control.is_fifo()
    with BoardProcess(tmp_path, "--control", control) as board:
        inject(board, "freeze:0")
        event(board, "freeze:0", over=False)


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        ("flood", "unknown fault 'flood'"),
        ("unplug:x", "unplug:x: allowed is a number S from 0 to 3600"),
        ("unplug:-1", "unplug:-1: allowed is a number S from 0 to 3600"),
        ("version:256", "allowed is a whole number V from 0 to 255"),
        ("drop:1@-1", "seconds since the start"),
        ("drop:1@", "drop:1@: the time after @ is in seconds"),
    ],
)
def test_refused_faults(fault: str, message: str) -> None:
    result = subprocess.run([installed("virtual_board"), "--fault", fault], capture_output=True, text=True, timeout=30)
    assert result.returncode == 2
    assert message in result.stderr


def test_every_fault_is_documented() -> None:
    result = subprocess.run([installed("virtual_board"), "--help"], capture_output=True, text=True, timeout=30)
    documented = (Path(__file__).resolve().parents[3] / "docs/virtual_board.md").read_text()
    faults = [line.split()[0] for line in result.stdout.split("faults:\n")[1].splitlines()]
    assert len(faults) == 13
    assert [fault for fault in faults if f"| `{fault}`" not in documented] == []
