# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The reader on a real pseudo-terminal: garbage, unplugging, a failing consumer; and ports that do not open."""

import errno
import os
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
import serial
from pty_board import PtyBoard, frame, wait_for

from acts_core.errors import PortError
from acts_core.frames import SampleFrame
from acts_core.runtime import is_stale_link
from acts_core.wire import DelimitedDecoder, RasterDecoder, StreamDecoder, encode_frame
from acts_driver.port import Reader, SerialSource
from acts_driver.port.port import explain, open_port


class Collector:
    """A reader with everything it said."""

    def __init__(self, path: Path, decoder: DelimitedDecoder | None = None) -> None:
        self.frames: list[SampleFrame] = []
        self.arrivals_ns: list[int] = []
        self.log: list[tuple[str, str]] = []
        self.fail = False
        self.reconnected = 0
        self.decoder = decoder if decoder is not None else StreamDecoder()
        self.source = SerialSource(str(path))
        self.reader = Reader(
            self.source,
            self.decoder,
            self.take,
            reconnect_s=0.05,
            log=lambda level, message: self.log.append((level, message)),
            on_reconnect=self.count_reconnect,
        )

    def take(self, frames: list[SampleFrame], arrival_ns: int) -> None:
        if self.fail:
            raise ValueError("no room")
        self.frames += frames
        self.arrivals_ns += [arrival_ns] * len(frames)

    def count_reconnect(self) -> None:
        self.reconnected += 1

    def sequences(self) -> list[int]:
        return [one.sequence for one in self.frames]

    def open(self) -> None:
        self.source.open()
        self.reader.start(is_open=True)


@pytest.fixture
def board(tmp_path: Path) -> Iterator[PtyBoard]:
    with PtyBoard(tmp_path) as board:
        yield board


@pytest.fixture
def collector(board: PtyBoard) -> Iterator[Collector]:
    collector = Collector(board.path)
    yield collector
    collector.reader.stop()


def test_frames_arrive_in_order_with_their_arrival(board: PtyBoard, collector: Collector) -> None:
    collector.open()
    for k in range(200):
        board.write_frames(frame(k))
    wait_for(lambda: len(collector.frames) == 200, "200 frames")
    assert collector.sequences() == list(range(200))
    assert collector.arrivals_ns == sorted(collector.arrivals_ns)
    assert collector.decoder.crc_errors + collector.decoder.malformed + collector.decoder.partial == 0


def test_bad_bytes_are_dropped_without_opening_the_port_again(board: PtyBoard, collector: Collector) -> None:
    collector.open()
    good = encode_frame(frame(1))
    flipped = bytearray(good)
    flipped[20] ^= 0x40
    swapped = bytearray(good)
    swapped[33], swapped[34] = swapped[34], swapped[33]
    board.write(encode_frame(frame(0)) + b"boot messages\r\n\xff\xfe\x00")
    board.write(good[:30] + b"\x00" + bytes(flipped) + bytes(swapped) + os.urandom(5000) + b"\x00")
    board.write_frames(frame(2), frame(3))
    wait_for(lambda: 3 in collector.sequences(), "the last frame")
    assert collector.sequences() == [0, 2, 3]
    assert collector.decoder.crc_errors + collector.decoder.malformed >= 5
    assert collector.reader.reconnects == 0
    assert collector.log == []


@pytest.mark.parametrize("where", ["source.open", "decoder.feed"])
def test_an_error_that_nobody_expected_is_told_and_does_not_end_the_reading(
    board: PtyBoard, collector: Collector, monkeypatch: pytest.MonkeyPatch, where: str
) -> None:
    part, name = getattr(collector, where.split(".")[0]), where.split(".")[1]
    works = getattr(part, name)
    mended = threading.Event()

    def fail_at_first(*arguments: object) -> object:
        if not mended.is_set():
            raise OverflowError("cannot convert float infinity to integer")
        return works(*arguments)

    def is_told() -> bool:
        board.write_frames(frame(0)) if where == "decoder.feed" else None
        told = [collector.reader.problem, *(message for _, message in collector.log)]
        return any("OverflowError: cannot convert float infinity to integer" in one for one in told)

    monkeypatch.setattr(part, name, fail_at_first)
    collector.reader.start()
    wait_for(is_told, "what is wrong")
    mended.set()
    wait_for(lambda: collector.reader.connected, "the port")
    board.write_frames(frame(1), frame(2))
    wait_for(lambda: 2 in collector.sequences(), "frames")


def test_unplugged_in_the_middle_of_a_frame_and_plugged_in_again(board: PtyBoard, collector: Collector) -> None:
    collector.open()
    board.write_frames(frame(0))
    wait_for(lambda: collector.frames, "a frame")
    board.write(encode_frame(frame(1))[:40])
    for again in (1, 2):
        board.unplug()
        wait_for(lambda: not collector.reader.connected, "the loss")
        wait_for(lambda: "is not there" in collector.reader.problem, "a failed attempt")
        board.plug_in()
        wait_for(lambda: collector.reader.connected, "the recovery")
        # The rest of a packet, since the port is opened at any time.
        board.write(encode_frame(frame(9))[10:] + encode_frame(frame(10 * again)))
        wait_for(lambda: collector.sequences()[-1] == 10 * again, "frames after the recovery")  # noqa: B023
    assert collector.sequences() == [0, 10, 20]
    assert collector.reader.reconnects == collector.reconnected == 2
    assert collector.decoder.partial == 2
    assert collector.decoder.crc_errors + collector.decoder.malformed == 0
    # Loss and recovery once each, however many attempts there were.
    assert [level for level, _ in collector.log] == ["warning", "info"] * 2
    assert str(board.path) in collector.log[0][1]
    assert "is back after" in collector.log[1][1]


def test_a_reader_waits_for_a_port_that_is_not_there_yet(tmp_path: Path) -> None:
    board = PtyBoard(tmp_path)
    collector = Collector(board.path)
    collector.reader.start()
    wait_for(lambda: "is not there" in collector.reader.problem, "a failed attempt")
    with board:
        wait_for(lambda: collector.reader.connected, "the port")
        board.write_frames(frame(5))
        wait_for(lambda: collector.sequences() == [5], "a frame")
        collector.reader.stop()
    assert collector.reader.reconnects == 0
    assert collector.log == []


def test_a_failing_consumer_does_not_end_reading(board: PtyBoard, collector: Collector) -> None:
    collector.fail = True
    collector.open()
    for k in range(3):
        board.write_frames(frame(k))
        wait_for(lambda: collector.reader.consumer_errors == k + 1, "the failure")  # noqa: B023
    collector.fail = False
    board.write_frames(frame(3))
    wait_for(lambda: collector.sequences() == [3], "the next frame")
    assert collector.log == [("error", "frames could not be handed on: ValueError: no room")]
    assert collector.reader.connected


def test_a_consumer_that_fails_in_other_words_each_time_does_not_fill_the_log(board: PtyBoard) -> None:
    def take(frames: list[SampleFrame], arrival_ns: int) -> None:
        if frames[-1].sequence % 2:
            raise KeyError(frames[-1].sequence)
        raise ValueError(f"no room for frame {frames[-1].sequence}")

    log: list[str] = []
    source = SerialSource(str(board.path))
    reader = Reader(source, StreamDecoder(), take, log=lambda level, message: log.append(message))
    source.open()
    reader.start(is_open=True)
    for k in range(10):
        board.write_frames(frame(k))
        wait_for(lambda: reader.consumer_errors == k + 1, "the failure")  # noqa: B023
    reader.stop()
    assert log == [
        "frames could not be handed on: ValueError: no room for frame 0",
        "frames could not be handed on: KeyError: 1",
    ]


def test_a_reader_tells_when_all_that_has_arrived_is_decoded(board: PtyBoard, collector: Collector) -> None:
    goes_on = threading.Event()
    take = collector.take

    def wait(frames: list[SampleFrame], arrival_ns: int) -> None:
        goes_on.wait(60.0)
        take(frames, arrival_ns)

    collector.reader = Reader(collector.source, collector.decoder, wait)
    collector.open()
    assert collector.reader.catch_up(60.0), "nothing has arrived"
    board.write_frames(frame(0))
    wait_for(lambda: collector.decoder.frames == 1, "the first frame")
    board.write_frames(frame(1))
    assert not collector.reader.catch_up(0.0), "its consumer stands still"
    goes_on.set()
    assert collector.reader.catch_up(60.0)
    assert collector.decoder.frames == 2
    board.unplug()
    wait_for(lambda: not collector.reader.connected, "the loss")
    assert collector.reader.catch_up(0.0), "nothing can arrive"


def test_raster_lines(board: PtyBoard) -> None:
    collector = Collector(board.path, RasterDecoder(2, 2))
    collector.open()
    board.write(b"3,4,100\r\n1,2,3,4,100\r\n1,2,3,100\r\n5,6,7,8,100\r\n")
    wait_for(lambda: len(collector.frames) == 2, "two scans")
    collector.reader.stop()
    assert [one.counts.tolist() for one in collector.frames] == [[1, 2, 3, 4], [5, 6, 7, 8]]
    assert collector.sequences() == [0, 2]
    assert (collector.decoder.partial, collector.decoder.malformed) == (1, 1)


def test_a_stopped_reader_has_closed_its_port(board: PtyBoard, collector: Collector) -> None:
    collector.open()
    collector.reader.stop()
    collector.reader.stop()
    open_port(str(board.path), 115200).close()


def test_a_command_amid_an_opening_does_not_go_to_the_file_that_has_the_old_ports_number(
    board: PtyBoard, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = SerialSource(str(board.path))
    source.open()
    number = source._fd
    source.close()
    other = tmp_path / "other"
    file = os.open(other, os.O_RDWR | os.O_CREAT)
    if file != number:
        os.dup2(file, number)
        os.close(file)
    opened = serial.Serial(str(board.path), timeout=0)

    class Opening:
        """The port, while another thread writes."""

        def fileno(self) -> int:
            with pytest.raises(PortError, match="is not open"):
                source.write(b"command", 0.0)
            return int(opened.fileno())

        def close(self) -> None:
            opened.close()

    monkeypatch.setattr("acts_driver.port.source.open_port", lambda *_: Opening())
    try:
        source.open()
        assert other.read_bytes() == b""
    finally:
        source.close()
        os.close(number)


def test_the_terminal_multiplexer_is_no_port(tmp_path: Path) -> None:
    (tmp_path / "board").symlink_to("/dev/ptmx")
    with pytest.raises(PortError, match="makes a new terminal each time"):
        open_port(str(tmp_path / "board"), 115200)


def test_a_busy_port_names_its_holder(board: PtyBoard) -> None:
    first = open_port(str(board.path), 115200)
    with pytest.raises(PortError, match=r"board.*is held .*(process|lsof).*stop that program"):
        open_port(str(board.path), 115200)
    first.close()
    open_port(str(board.path), 115200).close()


def test_a_missing_port_lists_those_present() -> None:
    with pytest.raises(PortError, match=r"/dev/ttyNONE is not there.*another port\. (Ports present:|No serial ports)"):
        open_port("/dev/ttyNONE", 115200)


def test_a_dangling_link_tells_where_it_points(tmp_path: Path) -> None:
    (tmp_path / "board").symlink_to("/dev/pts/nothing")
    with pytest.raises(PortError, match=r"board \(a link to /dev/pts/nothing\) is not there"):
        open_port(str(tmp_path / "board"), 115200)


def test_a_link_older_than_its_terminal_is_stale(board: PtyBoard, tmp_path: Path) -> None:
    # As when a board was killed and its terminal's number has gone to another program.
    link = tmp_path / "stale"
    link.symlink_to(board.path.readlink())
    assert not is_stale_link(str(link))
    os.utime(link, (0, 0), follow_symlinks=False)
    assert is_stale_link(str(link))
    with pytest.raises(PortError, match="is not there: the link is older"):
        open_port(str(link), 115200)


def test_a_port_whose_name_no_file_can_have_is_told() -> None:
    with pytest.raises(PortError, match=r"port /tmp/x+ cannot be opened: .*File name too long"):
        open_port(f"/tmp/{'x' * 300}", 115200)


def test_a_plain_file_is_no_port(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_text("")
    with pytest.raises(PortError, match="is no serial port"):
        open_port(str(path), 115200)


def test_missing_permission_names_the_group() -> None:
    # Tests may run as root, whom nothing is denied.
    assert "dialout" in explain("/dev/ttyACM0", errno.EACCES, "")


def test_any_other_reason_is_passed_on() -> None:
    assert "the moon" in explain("/dev/ttyACM0", None, "the moon")
