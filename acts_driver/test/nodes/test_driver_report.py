# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The driver's report on frames that are read late or missing, and on bytes that hold none."""

import sys
import threading
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from waiting import wait_for

from acts_core.frames import SampleFrame, Scheme
from acts_core.wire import RasterDecoder, StreamDecoder
from acts_driver.nodes.report import DriverReport, Totals
from acts_driver.port import Reader, SerialSource
from acts_driver.stream import FrameStream
from acts_ros.diagnostics import ERROR, OK, WARN

MS = 1_000_000
NO_TAXELS = np.empty(0, dtype=np.uint16)


@pytest.fixture
def eager_threads() -> Iterator[None]:
    """Let threads take turns as often as they can."""
    interval_s = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(interval_s)


def a_report(**options: Any) -> tuple[DriverReport, FrameStream]:
    """That of a connected board of 32 x 32 taxels, and its stream."""
    source, decoder, stream = SerialSource("/dev/ttyACM0"), StreamDecoder(), FrameStream(32, 32)
    reader = Reader(source, decoder, lambda frames, arrival_ns: None)
    reader.connected = True
    return DriverReport(source, reader, decoder, stream, (32, 32), **options), stream


def test_frames_that_are_read_late_are_told() -> None:
    report, stream = a_report()

    def receive(sequence: int, count: int, late_ms: int) -> None:
        numbers = range(sequence, sequence + count)
        frames = [
            SampleFrame(number, 1000 * number, 900, Scheme.RANDOM, 32, 32, 0, NO_TAXELS, NO_TAXELS)
            for number in numbers
        ]
        stream.accept(frames, (1000 + numbers[-1] + late_ms) * MS)

    for sequence in range(100):
        receive(sequence, 1, late_ms=0)
    report.make("active", 1100 * MS)
    receive(100, 16, late_ms=1300)
    level, message, values = report.make("active", 2500 * MS)
    assert level == WARN
    assert message.startswith("frames are read 1.3 s late: this machine is too slow or too busy")
    assert values["delay_us"] == 1_300_000
    receive(116, 1, late_ms=0)
    _, message, _ = report.make("active", 2600 * MS)
    assert "late" not in message


def test_what_a_board_dropped_before_anybody_read_it_is_no_warning() -> None:
    report, stream = a_report()
    reports = []
    for sequence, overruns in ((0, 70_000), (1, 70_000), (2, 70_002)):
        frame = SampleFrame(sequence, 1000 * sequence, 900, Scheme.RANDOM, 32, 32, overruns, NO_TAXELS, NO_TAXELS)
        stream.accept([frame], (1000 + sequence) * MS)
        reports.append(report.make("active", (1000 + sequence) * MS))
    assert [level for level, _, _ in reports] == [OK, OK, WARN]
    assert reports[-1][1] == "2 overruns of the board"
    assert [values["overruns"] for _, _, values in reports] == [70_000, 70_000, 70_002]


def test_a_slow_board_is_not_silent_between_two_frames() -> None:
    logged: list[tuple[str, str]] = []
    report, stream = a_report(log=lambda level, message: logged.append((level, message)))
    levels = []
    # A frame a second, now before and now after the report of that second.
    for second, late_ms in enumerate((0, 0, 0, 0, 30, 30, 0, 0)):
        frame = SampleFrame(second, 1_000_000 * second, 900, Scheme.RANDOM, 32, 32, 0, NO_TAXELS, NO_TAXELS)
        if late_ms:
            levels.append(report.make("active", (1010 + 1000 * second) * MS)[0])
        stream.accept([frame], (1000 + 1000 * second + late_ms) * MS)
        if not late_ms:
            levels.append(report.make("active", (1010 + 1000 * second) * MS)[0])
    assert levels == [OK] * 8
    assert report.make("active", 11_500 * MS)[:2] == (ERROR, "no frames from /dev/ttyACM0")
    assert logged == []


def test_a_slow_board_of_a_wrong_size_is_an_error_between_two_frames_too() -> None:
    report, stream = a_report()
    reports = []
    for second in range(8):
        rows = 32 if second == 7 else 16
        frame = SampleFrame(second, 1_000_000 * second, 900, Scheme.RANDOM, rows, 32, 0, NO_TAXELS, NO_TAXELS)
        stream.accept([frame], (1000 + 1000 * second) * MS)
        for part_ms in (10, 510):
            reports.append(report.make("active", (1000 + 1000 * second + part_ms) * MS)[:2])
    words = "1 frame of 16 x 32 taxels dropped, expected are 32 x 32 (parameters rows and cols)"
    assert set(reports[4:-2]) == {(ERROR, words)}
    assert [level for level, _ in reports[-2:]] == [OK, OK]


@pytest.mark.usefixtures("eager_threads")
def test_a_report_amid_a_frame_knows_all_of_its_gap_or_nothing() -> None:
    source, decoder = SerialSource("/dev/ttyACM0"), StreamDecoder()
    seen: list[Totals] = []

    def look_meanwhile() -> bool:
        """Look at the counters while frames come; whether that was often enough."""
        stream = FrameStream(32, 32)
        reader = Reader(source, decoder, lambda frames, arrival_ns: None)
        report = DriverReport(source, reader, decoder, stream, (32, 32))

        def receive() -> None:
            for number in range(1, 20_001):
                # The board drops one frame before each that it sends.
                sequence, dropped = 2 * number, number - 1
                frame = SampleFrame(
                    sequence, 1000 * sequence, 900, Scheme.RANDOM, 32, 32, dropped, NO_TAXELS, NO_TAXELS
                )
                stream.accept([frame], sequence * MS)

        reading = threading.Thread(target=receive)
        reading.start()
        while reading.is_alive():
            seen.append(report.totals())
        reading.join()
        assert report.totals().lost == 19_999
        return len(seen) > 100

    # Once, where this machine runs both threads.
    wait_for(look_meanwhile)
    assert {(totals.lost - totals.overruns, totals.frames - totals.lost) for totals in seen} <= {(0, 0), (0, 1)}


@pytest.mark.parametrize(
    ("new_decoder", "sent", "words"),
    [
        (StreamDecoder, b"0,0,3,118,402,29312\r\n", "a board that prints lines of text speaks another protocol"),
        (lambda: RasterDecoder(2, 2), b"0,0,3,118,402,29312\r", "does each frame end with \\n?"),
    ],
    ids=["text", "without a line feed"],
)
def test_bytes_that_never_are_a_frame_are_told_as_long_as_they_come(
    new_decoder: Callable[[], StreamDecoder | RasterDecoder], sent: bytes, words: str
) -> None:
    source, decoder = SerialSource("/dev/ttyACM0"), new_decoder()
    reader = Reader(source, decoder, lambda frames, arrival_ns: None)
    reader.connected = True
    report = DriverReport(source, reader, decoder, FrameStream(2, 2), (2, 2))
    for second in range(1, 4):
        decoder.feed(sent * 1000)
        level, message, _ = report.make("active", 1000 * second * MS)
        assert level == ERROR
        assert message.startswith("no frames from /dev/ttyACM0, ")
        assert words in message
    assert report.make("active", 4000 * MS)[1] == "no frames from /dev/ttyACM0"
