# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The reader on imagined sources: how soon a lost one is opened again, and what was thrown away."""

from __future__ import annotations

import threading
import time
from types import SimpleNamespace

import pytest
from pty_board import frame, wait_for

from acts_core.errors import PortError
from acts_core.frames import SampleFrame
from acts_core.wire import StreamDecoder, encode_frame
from acts_driver.port import Reader


class Opens:
    """A source that opens each time and is lost when it is read, `times` times; then nothing comes."""

    silence = ""
    name = "a bad cable"

    def __init__(self, times: int = 0) -> None:
        self.left = times

    def open(self) -> None:
        pass

    def begin(self) -> None:
        pass

    def read(self) -> bytes:
        self.left -= 1
        if self.left >= 0:
            raise PortError("port a bad cable was lost")
        return b""

    def waits(self) -> bool:
        return False

    def write(self, data: bytes, timeout_s: float) -> None:
        pass

    def discard(self) -> None:
        pass

    def close(self) -> None:
        pass


class RecordedWaits(threading.Event):
    """Keeps how long somebody wanted to wait for it [s], and does not wait."""

    def __init__(self) -> None:
        super().__init__()
        self.times_s: list[float] = []

    def wait(self, timeout: float | None = None) -> bool:
        self.times_s.append(timeout or 0.0)
        return super().wait(0.0)


def test_a_port_that_opens_and_is_lost_at_once_is_opened_less_and_less_often() -> None:
    source, told = Opens(6), []
    reader = Reader(
        source,
        StreamDecoder(),
        lambda frames, arrival_ns: None,
        reconnect_s=0.05,
        log=lambda level, message: told.append((level, message.partition(" after ")[0])),
    )
    reader._stop = waits = RecordedWaits()
    reader.start()
    wait_for(lambda: source.left < 0, "the last opening")
    reader.stop()
    assert [wait_s for wait_s in waits.times_s if wait_s] == [0.02, 0.04, 0.05, 0.05, 0.05, 0.05]
    assert reader.reconnects == 6
    # Once each, until bytes have come.
    lost = "port a bad cable was lost; trying again at least every 0.05 s"
    assert told == [("warning", lost), ("info", f"port {source.name} is back")]


class Answers(Opens):
    """A source that reads what it is told; None: it is lost, and then opens at once."""

    def __init__(self, *reads: bytes | None) -> None:
        super().__init__()
        self.reads = list(reads)

    def read(self) -> bytes:
        data = self.reads.pop(0) if self.reads else b""
        if data is None:
            raise PortError("port a bad cable was lost")
        return data


def test_a_port_of_which_bytes_have_come_is_opened_at_once_when_it_is_lost_again() -> None:
    bytes_come = encode_frame(frame(0))
    source = Answers(None, None, None, bytes_come, None, None)
    reader = Reader(source, StreamDecoder(), lambda frames, arrival_ns: None, reconnect_s=0.5)
    reader._stop = waits = RecordedWaits()
    reader.start(is_open=True)
    wait_for(lambda: reader.reconnects == 5, "the last opening")
    reader.stop()
    assert waits.times_s == [0.0, 0.02, 0.04, 0.0, 0.02]


def test_a_reader_that_has_thrown_bytes_away_has_not_decoded_all_that_arrived(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = [100.0]
    clock = SimpleNamespace(monotonic=lambda: now_s[0], time_ns=time.time_ns)
    monkeypatch.setattr("acts_driver.port.reader.time", clock)
    source, decoder = Answers(), StreamDecoder()
    taken: list[SampleFrame] = []

    def take(frames: list[SampleFrame], arrival_ns: int) -> None:
        taken.extend(frames)
        reader.discard()

    reader = Reader(source, decoder, take)
    reader.start(is_open=True)
    assert reader.catch_up(60.0)
    # Its end is thrown away with what waits.
    source.reads.append(encode_frame(frame(0)) + encode_frame(frame(1))[:40])
    wait_for(lambda: taken, "the frame")
    assert not reader.catch_up(60.0), "the answer may have been among it"
    now_s[0] += 0.9
    assert not reader.catch_up(60.0)
    now_s[0] += 0.2
    assert reader.catch_up(60.0)
    source.reads.append(encode_frame(frame(2))[20:] + encode_frame(frame(3)))
    wait_for(lambda: len(taken) == 2, "the next frame")
    reader.stop()
    assert (decoder.crc_errors, decoder.malformed) == (0, 0)
