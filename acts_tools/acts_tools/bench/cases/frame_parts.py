# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""CPU time of each step in the processing of a frame, at 1 kHz.

In one process a frame is decoded, stamped and recovered, and its contact is published. With driver and reconstruction
in two processes, it is also sent and received as a message. The CPU time of the thread is measured at the rate of the
board: between two frames others use the caches, so that a step takes three to six times its time in a loop.
"""

from __future__ import annotations

import gc
import time
from collections.abc import Callable
from contextlib import ExitStack
from typing import TypeVar

import numpy as np

from acts_core.frames import SampleFrame
from acts_core.wire import StreamDecoder
from acts_driver.baseline import BaselineTracker
from acts_driver.port import SerialSource
from acts_driver.stream import FrameStream
from acts_msgs.msg import TactileSamples
from acts_recon.nodes.reconstruction_node import ReconstructionNode
from acts_ros.messages import SamplesMessage, frame_of, stamp_ns_of
from acts_ros.polled import PollingNode
from acts_ros.qos import STREAM
from acts_tools.bench.result import Figure, Result
from acts_tools.bench.rigs.graph import Graph
from acts_tools.bench.rigs.processes import NAMESPACE, START_TIMEOUT_S, check_alive, python_module, virtual_board
from acts_tools.bench.rigs.skin import pressed
from acts_tools.bench.workbench import Workbench

T = TypeVar("T")

_LISTENER = "acts_tools.bench.rigs.silent_listener"

_IN_MEMORY = {
    "read": "bytes read from the port",
    "decode": "bytes to frame",
    "stamp": "counted and stamped",
    "baseline": "baseline followed",
    "recover": "image, contact, and the contact published",
}
_AS_MESSAGE = {
    "fill": "samples: frame to message",
    "send": "samples: message published",
    "take": "samples: message received",
    "unpack": "samples: message to frame",
}


class Stopwatch:
    """CPU times of this thread by step [us]."""

    def __init__(self) -> None:
        self.times_us: dict[str, list[float]] = {}

    def time(self, part: str, function: Callable[..., T], *arguments: object) -> T:
        """Call a function and record its CPU time."""
        began_ns = time.thread_time_ns()
        result = function(*arguments)
        self.times_us.setdefault(part, []).append((time.thread_time_ns() - began_ns) * 1e-3)
        return result

    def median_us(self, part: str) -> float:
        """Median of all times of a step; 0 without any [us]."""
        return float(np.median(self.times_us[part])) if part in self.times_us else 0.0


def measure(workbench: Workbench) -> Result:
    """Process frames of a virtual board, with a subscriber of samples and contacts in another process."""
    watch = Stopwatch()
    with ExitStack() as stack:
        board = stack.enter_context(virtual_board(workbench.folder, "--rate-hz", "1000", *pressed(workbench.folder)))
        graph = stack.enter_context(Graph(workbench))
        listener = stack.enter_context(python_module(workbench.folder, _LISTENER, [NAMESPACE]))
        node = ReconstructionNode(subscribes=False, namespace=NAMESPACE)
        stack.callback(node.destroy_node)
        loop = PollingNode("bench_loop", namespace=NAMESPACE)
        stack.callback(loop.destroy_node)
        publisher = graph.node.create_publisher(TactileSamples, "samples", STREAM)
        samples = loop.create_polled_subscription(TactileSamples, "samples", STREAM)

        def check() -> None:
            check_alive(listener, workbench.folder / f"{_LISTENER}.log")

        def is_heard() -> bool:
            return publisher.get_subscription_count() == 2 and node.count_subscribers(f"{NAMESPACE}/contact") == 1

        graph.spin_until(is_heard, START_TIMEOUT_S, "the subscribers", check)
        source = SerialSource(str(board.link))
        source.open()
        stack.callback(source.close)
        gc.collect()
        gc.freeze()
        _work(workbench, watch, source, node.take, publisher.publish, samples.take_all)
    return Result(_figures(watch))


def _work(
    workbench: Workbench,
    watch: Stopwatch,
    source: SerialSource,
    recover: Callable[[list[tuple[SampleFrame, int]], str], None],
    send: Callable[[TactileSamples], None],
    take: Callable[[], list[tuple[TactileSamples, int]]],
) -> None:
    decoder, stream, baseline = StreamDecoder(), FrameStream(32, 32), BaselineTracker(32, 32)
    message = SamplesMessage("bench")
    end_s = time.monotonic() + workbench.seconds
    while time.monotonic() < end_s:
        workbench.check_stop()
        data = watch.time("read", source.read)
        arrival_ns = time.time_ns()
        frames = watch.time("decode", decoder.feed, data)
        if len(frames) != 1:
            # Several frames at once were delayed: they are not processed at 1 kHz, and not measured.
            stream.accept(frames, arrival_ns)
            continue
        accepted = watch.time("stamp", stream.accept, frames, arrival_ns)
        if not accepted:
            continue
        watch.time("baseline", baseline.observe, accepted)
        watch.time("recover", recover, accepted, "bench")
        frame, stamp_ns = accepted[0]
        filled = watch.time("fill", message.fill, frame, stamp_ns)
        watch.time("send", send, filled)
        received = watch.time("take", take)
        if received:
            watch.time("unpack", _unpack, received[-1][0])


def _unpack(message: TactileSamples) -> tuple[SampleFrame, int]:
    return frame_of(message), stamp_ns_of(message)


def _figures(watch: Stopwatch) -> list[Figure]:
    figures = [
        Figure(f"{part}_us", label, watch.median_us(part), "us")
        for part, label in {**_IN_MEMORY, **_AS_MESSAGE}.items()
    ]
    in_memory = sum(watch.median_us(part) for part in _IN_MEMORY)
    as_message = sum(watch.median_us(part) for part in _AS_MESSAGE)
    frames = len(watch.times_us.get("recover", []))
    return [
        *figures,
        Figure("in_memory_us", "a frame in one process", in_memory, "us"),
        Figure("as_message_us", "    and what a message between two processes adds", as_message, "us"),
        Figure("ratio", "one process to two", in_memory / max(in_memory + as_message, 1e-9), "times", is_ratio=True),
        Figure("frames", "frames that were measured", frames),
    ]
