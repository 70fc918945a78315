# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The virtual board from outside: options, stream, pace, terminal."""

import os
import signal
import subprocess
from collections import Counter
from itertools import pairwise
from pathlib import Path

import pytest
from board_process import DEADLINE_S, BoardProcess
from core_library import installed
from waiting import wait_for

from acts_core.frames import SampleFrame, Scheme
from acts_core.sampling import OWN_SETTINGS, SCHEME_NUMBERS
from acts_core.wire import RasterDecoder


def check_stream(frames: list[SampleFrame]) -> None:
    """No frame is lost but those that the board says it dropped, and each has its own time."""
    for before, frame in pairwise(frames):
        lost = frame.sequence - before.sequence - 1
        assert lost == frame.overruns - before.overruns
        assert frame.board_us > before.board_us
        if lost == 0:
            assert frame.board_us - before.board_us == 1000
        assert len(set(frame.indices.tolist())) == len(frame.indices)


def test_stream_of_the_published_settings(tmp_path: Path) -> None:
    with BoardProcess(tmp_path) as board:
        port = board.open_port()
        assert os.read(port, 1) == b"\0"
        frames = board.read_frames(300)
    assert board.decoder.malformed == board.decoder.crc_errors == 0
    check_stream(frames)
    for frame in frames:
        assert (frame.scheme, frame.rows, frame.cols) == (Scheme.ADAPTIVE, 32, 32)
        assert len(frame.indices) == 55
        assert frame.duration_us in (972, 973, 974)  # 973 us on a clock of whole microseconds
        assert frame.board_us // 1000 == frame.sequence
        assert frame.counts.max() < 10  # untouched: noise only


@pytest.mark.parametrize(
    ("scheme", "m"),
    [("uniform", 48), ("random", 40), ("tracking", 60), ("hybrid", 80), ("adaptive", 120), ("raster", 176)],
)
def test_schemes_and_their_pace(tmp_path: Path, scheme: str, m: int) -> None:
    with BoardProcess(tmp_path, "--scheme", scheme, "--m", m, "--rows", 11, "--cols=16", "--sample-us", 10) as board:
        board.open_port()
        frames = board.read_frames(20)
    # A frame takes m * 10 us or the time the rate cap asks for, whichever is longer.
    period_us = max(m * 10, 1000)
    assert [len(frame.indices) for frame in frames] == [m] * len(frames)
    assert {frame.scheme for frame in frames} == {SCHEME_NUMBERS[scheme]}
    for before, frame in pairwise(frames):
        steps = frame.sequence - before.sequence
        assert abs(frame.board_us - before.board_us - steps * period_us) <= 1


def test_published_raster_sketch(tmp_path: Path) -> None:
    with BoardProcess(tmp_path, "--protocol", "raster_ascii") as board:
        board.decoder = RasterDecoder()
        board.open_port()
        frames = board.read_frames(5)
    assert board.decoder.malformed == 0
    for frame in frames:
        assert len(frame.counts) == 1024
        assert frame.duration_us in (17508, 17509)


def test_frames_go_on_while_nobody_reads(tmp_path: Path) -> None:
    with BoardProcess(tmp_path, "--status-period-s", 0.05) as board:
        while board.status()["frames"] < 100:
            pass
        board.open_port()
        first = board.read_frames(1)[0]
        assert first.sequence - first.overruns >= 100  # discarded, not dropped
        board.leave(first)
        beyond = board.status()["frames"] + 50
        while board.status()["frames"] < beyond:
            pass
        # The next reader begins with a whole, new frame.
        port = board.open_port()
        assert os.read(port, 1) == b"\0"
        frames = board.read_frames(50)
        assert frames[0].sequence >= beyond
        assert board.decoder.malformed == board.decoder.crc_errors == board.decoder.partial == 0
        check_stream(frames)


def test_a_port_that_is_not_read_drops_whole_frames_and_says_how_many(tmp_path: Path) -> None:
    # Raster frames with little time each fill the queue in a fraction of a second.
    options = ("--scheme", "raster", "--sample-us", 0.5, "--status-period-s", 0.05)
    with BoardProcess(tmp_path, *options) as board:
        board.open_port()
        frames = board.read_frames(1)
        while board.status()["overruns"] < 20:
            pass
        frames += board.read_frames(200)
        assert frames[-1].overruns >= 20
        assert board.decoder.malformed == board.decoder.crc_errors == 0
        check_stream(frames)


def test_what_a_terminal_has_no_room_for_is_sent_within_a_pause_between_two_frames(tmp_path: Path) -> None:
    size = ("--rows", 64, "--cols", 64, "--scheme", "raster", "--sample-us", 0.5)
    with BoardProcess(tmp_path, *size, "--rate-hz", 2, "--status-period-s", 0.001) as board:
        board.open_port()
        # It looks after the terminal so often in a pause; every 50 ms would be ten times.
        looks: Counter[int] = Counter()
        wait_for(
            lambda: max(looks.values(), default=0) > 50,
            "a board that tries again",
            DEADLINE_S,
            lambda: looks.update([board.status()["frames"]]),
            lambda: looks,
        )
        board.read_frames(2)
    assert board.decoder.malformed == board.decoder.crc_errors == 0


@pytest.mark.parametrize(("stall_s", "skips"), [(0.12, False), (0.8, True)])
def test_a_stalled_board_catches_up_or_skips(tmp_path: Path, stall_s: float, skips: bool) -> None:
    while True:
        with BoardProcess(tmp_path) as board:
            board.open_port()
            frames = board.read_frames(20)
            ended_ns, stood_s = board.stand_still(stall_s)
            while board.start["epoch_monotonic_ns"] + frames[-1].board_us * 1000 < ended_ns:
                frames += board.read_frames(1)
        check_stream(frames)
        # Where the machine prolongs a stall that is to be made up for, another board is to.
        if skips or stood_s < 0.2:
            break
    assert (frames[-1].overruns > 0) == skips


def test_what_the_host_sends_is_taken_and_disturbs_nothing(tmp_path: Path) -> None:
    with BoardProcess(tmp_path) as board:
        port = board.open_port()
        os.set_blocking(port, False)
        frames = board.read_frames(1)
        sent = 0
        while sent < 100_000:
            try:
                sent += os.write(port, b"\x03\x7f\r\n" * 250)
            except BlockingIOError:
                frames += board.read_frames(1)
        frames += board.read_frames(20)
        assert board.decoder.malformed == board.decoder.crc_errors == 0
        check_stream(frames)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--speed", "3"], "unknown option --speed"),
        (["board"], "unknown option board"),
        (["--rows", "65"], "--rows 65: allowed is a whole number from 1 to 64"),
        (["--cols", "3x"], "--cols 3x"),
        (["--m", "0"], "--m 0"),
        (["--rows", "5", "--cols", "5"], "--m 55: an array of 5 x 5 has 25 taxels"),
        (["--scheme", "spiral"], "--scheme spiral: allowed is one of adaptive, "),
        (["--scheme", "uniform", "--m", "53"], "--m 53: no uniform frame"),
        (["--scheme", "fixed", "--fixed-row", "32"], "--fixed-row 32: there is none in an array of 32 x 32"),
        (["--search-share", "0"], "--search-share 0: allowed is a number from 0.0001 to 1"),
        (["--search-share", "1.01"], "--search-share 1.01"),
        (["--adaptive-share", "0"], "--adaptive-share 0: allowed is a number from 0.0001 to 1"),
        (["--threshold", "1024"], "--threshold 1024"),
        (["--neighbour-order", "diagonal"], "columns, rows"),
        (["--rate-hz", "nan"], "--rate-hz nan"),
        (["--sample-us", "0"], "--sample-us 0"),
        (["--noise-counts", "-1"], "--noise-counts -1"),
        (["--seed", "-1"], "--seed -1"),
        (["--protocol", "morse"], "binary, raster_ascii"),
        (["--loop=yes"], "--loop takes no value"),
        (["--m"], "--m needs a value"),
        (["--m", "--ros-args"], "--m needs a value"),
        (["--seed", " -1"], "--seed  -1: allowed is a whole number from 0 to 18446744073709551615"),
        (["--board-id", "0x"], "--board-id 0x: allowed is a whole number from 0 to 18446744073709551615"),
        (["--board-id", "0x-1"], "--board-id 0x-1: allowed is a whole number"),
    ],
)
def test_refused_options(options: list[str], message: str) -> None:
    result = subprocess.run([installed("virtual_board"), *options], capture_output=True, text=True, timeout=30)
    assert result.returncode == 2
    assert message in result.stderr


def test_help_names_every_option() -> None:
    result = subprocess.run([installed("virtual_board"), "--help"], capture_output=True, text=True, timeout=30)
    assert result.returncode == 0
    documented = (Path(__file__).resolve().parents[3] / "docs/virtual_board.md").read_text()
    # docs/reference.md lists the schemes' own settings.
    documented += " ".join(f"`--{own.parameter.replace('_', '-')}`" for own in OWN_SETTINGS)
    options = [line.split()[0] for line in result.stdout.splitlines() if line.startswith("  --")]
    assert len(options) > 15
    assert [option for option in options if f"`{option}" not in documented] == []


def test_ros_arguments_are_left_alone(tmp_path: Path) -> None:
    with BoardProcess(tmp_path, "--m", 10, "--ros-args", "-r", "__node:=board", "--speed") as board:
        assert board.start["m"] == 10


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
@pytest.mark.parametrize("rate_hz", [1000, 1])
def test_ends_in_order_and_clears_its_link(tmp_path: Path, number: signal.Signals, rate_hz: int) -> None:
    with BoardProcess(tmp_path, "--rate-hz", rate_hz) as board:
        assert board.link.is_symlink()
        assert str(board.link.readlink()) == board.start["port"]
        board.open_port()
        assert board.terminate(number) == 0
        assert not board.link.is_symlink()
        assert list(board.link.parent.iterdir()) == []


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGHUP])
def test_a_host_that_is_interrupted_as_well_closes_its_port_first(tmp_path: Path, number: signal.Signals) -> None:
    with BoardProcess(tmp_path) as board:
        board.open_port()
        board.read_frames(3)
        sent_us = board.read_frames(1)[-1].board_us
        board.process.send_signal(number)
        board.process.send_signal(number)
        # It still measures, where a board that ends at once would have left an end of the stream.
        while board.read_frames(1)[-1].board_us < sent_us + 100_000:
            pass
        assert board.process.poll() is None
        assert board.process.wait(30.0) == 0
        assert not board.link.is_symlink()


def test_sigterm_ends_at_once_a_board_that_still_goes_on(tmp_path: Path) -> None:
    with BoardProcess(tmp_path) as board:
        board.process.send_signal(signal.SIGINT)
        assert board.terminate(signal.SIGTERM) == 0


def test_link_of_a_killed_board_is_replaced(tmp_path: Path) -> None:
    with BoardProcess(tmp_path) as killed:
        killed.terminate(signal.SIGKILL)
        assert killed.link.is_symlink()
    with BoardProcess(tmp_path) as board:
        board.open_port()
        board.read_frames(3)


def refusal(link: Path, code: int) -> str:
    command: list[str | Path] = [installed("virtual_board"), "--link", link]
    result = subprocess.run(command, capture_output=True, text=True, timeout=30)
    assert result.returncode == code
    return result.stderr


def test_a_link_in_use_is_refused_with_the_name_of_the_board_that_has_it(tmp_path: Path) -> None:
    with BoardProcess(tmp_path) as first:
        said = refusal(first.link, 2)
        assert f"{first.link} is in use by process {first.process.pid} (" in said
        assert "virtual_board --link" in said
        assert "run_dir:=" in said
        assert "without a launch file: another path" in said
        assert str(first.link.readlink()) == first.start["port"]
        first.open_port()
        first.read_frames(3)


def test_what_another_board_has_made_after_the_folder_was_cleared_stays(tmp_path: Path) -> None:
    # As systemd clears /dev/shm where a user logs out (RemoveIPC), and a board goes on.
    control = tmp_path / "run/control"
    with BoardProcess(tmp_path, "--control", control) as first:
        for path in first.link.parent.iterdir():
            path.unlink()
        with BoardProcess(tmp_path, "--control", control) as second:
            assert first.terminate() == 0
            assert control.is_fifo()
            assert f"in use by process {second.process.pid} (" in refusal(second.link, 2)
            assert str(second.link.readlink()) == second.start["port"]
            assert second.terminate() == 0
        assert list(first.link.parent.iterdir()) == []


@pytest.mark.parametrize("content", [b"mine\n", b"12 of mine\n", b"1" * 25])
def test_a_file_that_is_no_lock_is_refused_and_stays_as_it_is(tmp_path: Path, content: bytes) -> None:
    other = tmp_path / "poetry.lock"
    other.write_bytes(content)
    assert f"{other} is no lock of a file, and would be lost" in refusal(tmp_path / "poetry", 2)
    assert other.read_bytes() == content


def test_the_links_folder_is_made_for_its_user_alone(tmp_path: Path) -> None:
    with BoardProcess(tmp_path) as board:
        assert board.link.parent.stat().st_mode & 0o777 == 0o700


def test_no_folder_is_made_that_is_named_as_the_home_is_by_a_shell(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert "the folder ~/run begins with ~" in refusal(Path("~/run/board"), 2)
    assert list(tmp_path.iterdir()) == []


def test_folders_that_others_have_a_hand_in_are_refused(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    (tmp_path / "run").symlink_to(folder)
    assert "run is a symbolic link" in refusal(tmp_path / "run" / "board", 2)
    folder.chmod(0o777)
    assert "anybody may write to the folder" in refusal(folder / "board", 2)
    folder.chmod(0o755)
    if os.geteuid() == 0:
        os.chown(folder, 1, 1)
        assert "belongs to" in refusal(folder / "board", 2)
    assert list(folder.iterdir()) == []


def test_a_folder_that_is_read_only_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir(mode=0o500)
    # Root may write to any folder but those of the kernel.
    link = folder / "board" if os.geteuid() != 0 else Path("/proc/board")
    assert f"{link}.lock cannot be opened" in refusal(link, 2)


def test_a_file_in_place_of_the_link_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "notes.txt"
    path.write_text("mine")
    result = subprocess.run([installed("virtual_board"), "--link", path], capture_output=True, text=True, timeout=30)
    assert result.returncode == 2
    assert "something else than a symbolic link" in result.stderr
    assert path.read_text() == "mine"


def test_a_link_to_something_else_is_kept(tmp_path: Path) -> None:
    (tmp_path / "board").symlink_to("notes.txt")
    assert "board: a link to notes.txt is there; remove it" in refusal(tmp_path / "board", 2)
    assert (tmp_path / "board").readlink() == Path("notes.txt")
