# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The system's clock is set while frames come: stamps follow it with the next frame."""

import time

import numpy as np
import pytest

from acts_core.frames import SampleFrame, Scheme
from acts_driver.stream import FrameStream
from acts_driver.stream.host_clock import HostClock

MS = 1_000_000
EPOCH_NS = 1_700_000_000_000_000_000
NONE = np.zeros(0, dtype=np.uint16)


class Clocks:
    """A machine's two clocks."""

    def __init__(self) -> None:
        self.steady_ns = 5_000 * MS
        self.system_ns = EPOCH_NS
        self.reading_takes_ns = 0

    def run(self, time_ns: int) -> None:
        self.steady_ns += time_ns
        self.system_ns += time_ns

    def read_steady(self) -> int:
        return self.steady_ns

    def read_system(self) -> int:
        self.run(self.reading_takes_ns)
        return self.system_ns


@pytest.mark.parametrize("step_ms", [-3_600_000, -60, 60, 500, 3_600_000])
def test_stamps_follow_the_systems_clock_at_once(step_ms: int) -> None:
    clocks = Clocks()
    stream = FrameStream(4, 4, host_clock=HostClock(lambda: clocks.system_ns, clocks.read_steady))
    for k in range(3000):
        if k == 2000:
            clocks.system_ns += step_ms * MS
        frame = SampleFrame(k, 7_000_000 + 1000 * k, 0, Scheme.UNIFORM, 4, 4, 0, NONE, NONE)
        [(_, stamp_ns)] = stream.accept([frame], clocks.system_ns)
        assert abs(stamp_ns - clocks.system_ns) < MS // 10
        clocks.run(MS)
    assert stream.clock.state.resets == 1
    assert stream.statistics.restarts == 0


@pytest.mark.parametrize("has_board_clock", [True, False])
@pytest.mark.parametrize("step_ms", [-3_600_000, -500, 60, 3_600_000])
def test_the_rate_is_the_same_after_the_clock_was_set(step_ms: int, has_board_clock: bool) -> None:
    clocks = Clocks()
    host_clock = HostClock(lambda: clocks.system_ns, clocks.read_steady)
    stream = FrameStream(4, 4, has_board_clock=has_board_clock, host_clock=host_clock)
    rates_hz = []
    for k in range(4000):
        if k == 2050:
            clocks.system_ns += step_ms * MS
        frame = SampleFrame(k, 7_000_000 + 1000 * k, 0, Scheme.UNIFORM, 4, 4, 0, NONE, NONE)
        stream.accept([frame], clocks.system_ns)
        clocks.run(MS)
        if k >= 1200:
            rates_hz.append(stream.statistics.rate_hz(clocks.system_ns))
    assert set(rates_hz) == {1000.0}


@pytest.mark.parametrize("step_ms", [-3_600_000, 60, 3_600_000])
def test_a_clock_that_is_set_while_a_frame_is_decoded(step_ms: int) -> None:
    clocks = Clocks()
    stream = FrameStream(4, 4, host_clock=HostClock(lambda: clocks.system_ns, clocks.read_steady))
    for k in range(3000):
        arrival_ns = clocks.system_ns
        if k == 2000:
            clocks.system_ns += step_ms * MS
        clocks.run(MS // 20)
        frame = SampleFrame(k, 7_000_000 + 1000 * k, 0, Scheme.UNIFORM, 4, 4, 0, NONE, NONE)
        [(_, stamp_ns)] = stream.accept([frame], arrival_ns)
        assert abs(stamp_ns - clocks.system_ns) < MS // 10
        clocks.run(MS - MS // 20)
    assert stream.clock.state.resets == 1


@pytest.mark.parametrize("step_ms", [-3_600_000, 60, 3_600_000])
def test_a_clock_that_is_set_while_the_port_is_lost_makes_no_restart_of_the_board(step_ms: int) -> None:
    clocks = Clocks()
    stream = FrameStream(4, 4, host_clock=HostClock(lambda: clocks.system_ns, clocks.read_steady))

    def accept(number: int, board_ms: int) -> None:
        frame = SampleFrame(number, 1000 * board_ms, 0, Scheme.UNIFORM, 4, 4, 0, NONE, NONE)
        stream.accept([frame], clocks.system_ns)
        clocks.run(MS)

    for number in range(1000):
        accept(number, 7000 + number)
    clocks.run(3000 * MS)
    clocks.system_ns += step_ms * MS
    stream.reconnected()
    accept(4000, 11_000)
    assert (stream.statistics.restarts, stream.statistics.lost) == (0, 3000)
    # Off for a minute, and then on for longer than before.
    clocks.run(80_000 * MS)
    clocks.system_ns += step_ms * MS
    stream.reconnected()
    accept(5000, 20_000)
    assert (stream.statistics.restarts, stream.statistics.lost) == (1, 3000)


def test_frames_from_before_a_suspension_of_the_machine_are_as_old_as_they_are(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clocks = Clocks()
    monkeypatch.setattr(time, "clock_gettime_ns", lambda clock: {time.CLOCK_BOOTTIME: clocks.steady_ns}[clock])
    stream = FrameStream(4, 4, host_clock=HostClock(lambda: clocks.system_ns))

    def delay_ns(number: int, board_ms: int) -> int:
        frame = SampleFrame(number, 1000 * board_ms, 0, Scheme.UNIFORM, 4, 4, 0, NONE, NONE)
        [(_, stamp_ns)] = stream.accept([frame], clocks.system_ns)
        return clocks.system_ns - stamp_ns

    for number in range(3000):
        clocks.run(MS)
        assert delay_ns(number, 7000 + number) < MS // 10
    # The board goes on, and keeps the oldest of its frames.
    clocks.run(60_000 * MS)
    for number in range(3000, 3100):
        age_ms = 60_000 - (number - 2999)
        assert abs(delay_ns(number, 7000 + number) - age_ms * MS) < MS
    for number in range(62_999, 63_999):
        assert delay_ns(number, 7000 + number) < MS
        clocks.run(MS)
    assert (stream.clock.state.resets, stream.statistics.restarts) == (0, 0)


def test_a_clock_that_is_made_to_run_faster_was_not_set() -> None:
    clocks = Clocks()
    clock = HostClock(lambda: clocks.system_ns, clocks.read_steady)
    for _ in range(1000):
        clocks.run(1000 * MS)
        clocks.system_ns += MS // 2
        assert not clock.was_set()


def test_clocks_that_were_not_read_at_once_are_not_compared() -> None:
    clocks = Clocks()
    clock = HostClock(clocks.read_system, clocks.read_steady)
    assert not clock.was_set()
    clocks.reading_takes_ns = 100 * MS
    assert not clock.was_set()
    clocks.reading_takes_ns = 0
    assert not clock.was_set()
    clocks.system_ns += 50 * MS
    assert clock.was_set()
    assert not clock.was_set()
