# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Latency from the last measurement of a frame to its publication and reception, and error of its stamp, at 1 kHz.

The virtual board reports the start of its clock, so that the true time of every measurement is known independently of
the driver's stamps. The board's clock is fast by `DRIFT_PPM`, as a quartz may be. Latencies begin at the true time and
include the wake-up delay of the board's process. To show that delay, a reader without ROS reads the same board first.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from acts_core.frames import SampleFrame
from acts_core.runtime import StreamCounter
from acts_core.wire import StreamDecoder
from acts_driver.port import SerialSource
from acts_msgs.msg import TactileSamples
from acts_ros.messages import ns_of
from acts_ros.qos import STREAM
from acts_tools.bench.result import Figure, Result
from acts_tools.bench.rigs.graph import Graph
from acts_tools.bench.rigs.processes import START_TIMEOUT_S, Board, check_alive, driver, virtual_board
from acts_tools.bench.rigs.skin import pressed
from acts_tools.bench.rigs.true_time import TrueTime
from acts_tools.bench.workbench import Workbench
from acts_tools.percentiles import percentiles

DRIFT_PPM = 30.0
_PERIOD_US = 1000
# The driver's clock estimate includes the drift after 2.5 s, and has settled after 5 s.
_SETTLE_S = 6.0
_NAMES = {"median": "median", "p99": "99 % within", "p999": "99.9 % within"}


@dataclass
class Arrivals:
    """Number, stamp and a time [ns] of every message of a subscriber, one list each, and counts."""

    sequence: list[int] = field(default_factory=list)
    stamp_ns: list[int] = field(default_factory=list)
    time_ns: list[int] = field(default_factory=list)
    counter: StreamCounter = field(default_factory=StreamCounter)

    def add(self, message: TactileSamples, time_ns: int) -> None:
        """Add one message."""
        stamp_ns = ns_of(message.header.stamp)
        self.counter.step(message.sequence, (time_ns - stamp_ns) * 1e-9)
        self.sequence.append(message.sequence)
        self.stamp_ns.append(stamp_ns)
        self.time_ns.append(time_ns)

    def after(self, truth: TrueTime) -> NDArray[np.float64]:
        """Time from the true time of each measurement to the recorded time [ms]."""
        return _after(truth, self.sequence, self.time_ns)


def measure(workbench: Workbench) -> Result:
    """For a third of the time each: read without ROS, receive messages, and get the times of their publication."""
    options = ("--rate-hz", "1000", "--drift-ppm", str(DRIFT_PPM), *pressed(workbench.folder))
    with virtual_board(workbench.folder, *options) as board:
        direct, arrivals_ns = _read_directly(board, workbench)
        truth = TrueTime(direct, _PERIOD_US, board.epoch_monotonic_ns, DRIFT_PPM)
        received, sent = Arrivals(), Arrivals()
        with driver(workbench.folder, board.link) as process:

            def check() -> None:
                check_alive(process, workbench.folder / "driver.log")

            with Graph(workbench) as graph:
                settled: list[TactileSamples] = []
                subscription = graph.node.create_subscription(TactileSamples, "samples", settled.append, STREAM)
                graph.spin_until(lambda: settled, START_TIMEOUT_S, "the first message", check)
                graph.spin_for(min(_SETTLE_S, workbench.seconds))
                graph.node.destroy_subscription(subscription)
                truth.observe_host()
                graph.node.create_subscription(
                    TactileSamples, "samples", lambda message: received.add(message, time.time_ns()), STREAM
                )
                graph.spin_until(lambda: received.sequence, START_TIMEOUT_S, "messages", check)
                graph.spin_for(workbench.seconds / 3)
                truth.observe_host()
            # The times of sending are there for who takes messages himself; callbacks get them only from Iron on.
            with Graph(workbench) as graph:
                polled = graph.node.create_polled_subscription(TactileSamples, "samples", STREAM)

                def take() -> None:
                    for message, sent_ns in polled.take_all_sent():
                        sent.add(message, sent_ns)
                    check()

                graph.spin_until(lambda: sent.sequence, START_TIMEOUT_S, "messages", take)
                graph.spin_for(workbench.seconds / 3, take)
                truth.observe_host()
    direct_ms = _after(truth, [frame.sequence for frame in direct], arrivals_ns)
    return Result(_figures(received, sent, direct_ms, truth))


def _figures(received: Arrivals, sent: Arrivals, direct_ms: NDArray[np.float64], truth: TrueTime) -> list[Figure]:
    received_ms = received.after(truth)
    stamps_ns = np.array(received.stamp_ns + sent.stamp_ns, dtype=np.int64)
    error_us = (stamps_ns - truth.at(received.sequence + sent.sequence)) * 1e-3
    by_stamp_ms = np.asarray(received.counter.take_latencies(), dtype=np.float64) * 1e3
    figures = []
    for key, label, values, unit in (
        ("received", "measurement to reception in another process", received_ms, "ms"),
        ("sent", "measurement to publishing", sent.after(truth), "ms"),
        ("direct", "measurement to frame, reader without ROS", direct_ms, "ms"),
        ("by_stamp", "stamp to reception in another process", by_stamp_ms, "ms"),
        ("stamp_error", "stamp minus true time, absolute", np.abs(error_us), "us"),
    ):
        for name, value in percentiles(values).items():
            shown = f"{label}, {_NAMES[name]}" if name == "median" else f"    {_NAMES[name]}"
            figures.append(Figure(f"{key}_{unit}.{name}", shown, value, unit))
    bias_us = float(np.median(error_us)) if error_us.size else None
    ratio = float(np.median(received_ms) / np.median(direct_ms))
    return [
        *figures,
        Figure("ratio", "reception in another process to reader without ROS", ratio, "times", is_ratio=True),
        Figure("stamp_bias_us", "stamp minus true time, median with sign", bias_us, "us"),
        Figure("frames", "frames received", received.counter.received + sent.counter.received),
        Figure("lost", "frames lost on the way", received.counter.lost + sent.counter.lost),
    ]


def _read_directly(board: Board, workbench: Workbench) -> tuple[list[SampleFrame], list[int]]:
    """Frames read from the port without ROS, and the host's real time at which each was decoded [ns]."""
    source = SerialSource(str(board.link))
    decoder = StreamDecoder()
    frames: list[SampleFrame] = []
    arrivals_ns: list[int] = []
    source.open()
    end_s = time.monotonic() + workbench.seconds / 3
    try:
        while time.monotonic() < end_s or not frames:
            workbench.check_stop()
            new = decoder.feed(source.read())
            arrivals_ns += [time.time_ns()] * len(new)
            frames += new
    finally:
        source.close()
    return frames, arrivals_ns


def _after(truth: TrueTime, sequence: Sequence[int], time_ns: Sequence[int]) -> NDArray[np.float64]:
    """Time from the true time of each frame's measurement to a time of the host [ms]."""
    return np.asarray((np.array(time_ns, dtype=np.int64) - truth.at(sequence)) * 1e-6, dtype=np.float64)
