# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node where frames come late; ROS_DOMAIN_IDs 26, 27 and 217."""

import threading
import time
from collections.abc import Callable
from contextlib import ExitStack

import numpy as np
import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from recon_bench import DEADLINE_S, Bench

from acts_core.frames import SampleFrame, Scheme
from acts_msgs.msg import TactileSamples
from acts_recon.nodes.reconstruction_node import ReconstructionNode
from acts_ros import qos
from acts_ros.executor import make_executor, spin_for
from acts_ros.polled import PolledSubscription, PollingNode

pytestmark = pytest.mark.slow


def test_late_frames_are_published_while_they_are_rare_and_very_late_ones_are_left_out(
    make_bench: Callable[..., Bench], monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = make_bench(26, method="fusion")
    cells = [np.array([cell], dtype=np.uint16) for cell in (100, 140, 180, 220)]

    def take(first: int, age_ms: float, counts: int) -> list[bool]:
        """Give it four frames; which of them the image shows."""
        now_ns = time.time_ns()
        begin_ns = now_ns - round(age_ms * 1e6)
        pressed = np.array([counts], dtype=np.uint16)
        frames = [
            (SampleFrame(first + k, 0, 900, Scheme.TRACKING, 32, 32, 0, cell, pressed), begin_ns + k * 1_000_000)
            for k, cell in enumerate(cells)
        ]
        with monkeypatch.context() as clock:
            # However slow the machine is, they are so old.
            clock.setattr(time, "time_ns", lambda: now_ns)
            bench.node.take(frames, "plate")
        bench.contact(first + 3)
        image = bench.node._recovery.image.ravel()
        return [bool(abs(float(image[cell]) - counts) < 50) for (cell,) in cells]

    assert take(0, 1000.0, 500) == [False, False, False, True]
    assert take(4, 5.0, 600) == [True, True, True, True]
    # Some stalls are caught up with. Then there are too many: the newest is published, then only the newest is used.
    for first in range(8, 112, 4):
        assert take(first, 40.0, 700) == [True, True, True, True]
    assert take(112, 40.0, 800) == [True, True, True, True]
    assert take(116, 80.0, 900) == [False, False, False, True]
    assert [message.sequence for message in bench.received["contact"]] == [3, *range(4, 108), 111, 115, 119]

    def told(status: object, values: dict[str, str]) -> bool:
        counted = (values["not_published"], values["not_used"], values["frames"], values["lost"])
        return counted == ("12", "6", "114", "0")

    bench.diagnostics(told)


def test_contacts_that_are_left_out_are_warned_of(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(27)
    cells = np.arange(10, dtype=np.uint16)
    now_ns = time.time_ns()
    frames = [
        (SampleFrame(k, 0, 900, Scheme.RANDOM, 32, 32, 0, cells, cells), now_ns - (1000 - k) * 1_000_000)
        for k in range(4)
    ]
    bench.node.take(frames, "plate")
    bench.contact(3)
    words = "3 contacts left out because their frames came late, "
    bench.diagnostics(lambda status, _: status.level == b"\x01" and status.message.startswith(words))


def test_a_board_that_begins_anew_among_very_late_frames_is_noticed(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(26, method="fusion")
    pressed = np.array([500], dtype=np.uint16)
    now_ns = time.time_ns()

    def frame(sequence: int, cell: int, age_ms: float) -> tuple[SampleFrame, int]:
        cells = np.array([cell], dtype=np.uint16)
        measured = SampleFrame(sequence, 0, 900, Scheme.TRACKING, 32, 32, 0, cells, pressed)
        return measured, now_ns - round(age_ms * 1e6)

    bench.node.take([frame(7000, 100, 110.0)], "plate")
    image = bench.node._recovery.image.ravel()
    assert image[100] == 500
    bench.node.take([frame(0, 140, 105.0), frame(1, 180, 100.0), frame(2, 220, 95.0)], "plate")
    # Of the life before nothing is known any more, nor of what was left out.
    assert image[[100, 140, 180, 220]].tolist() == [0, 0, 0, 500]


def test_a_very_late_frame_of_another_array_is_refused_as_any_other(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(26, method="fusion")
    cells, pressed = np.array([100], dtype=np.uint16), np.array([500], dtype=np.uint16)
    now_ns = time.time_ns()
    mine = SampleFrame(7000, 0, 900, Scheme.TRACKING, 32, 32, 0, cells, pressed)
    bench.node.take([(mine, now_ns - 110_000_000)], "plate")
    other = mine._replace(sequence=3, rows=16)
    later = mine._replace(sequence=7001, indices=cells + 40)
    bench.node.take([(other, now_ns - 105_000_000), (later, now_ns - 100_000_000)], "plate")
    # The board did not begin anew.
    assert bench.node._recovery.image.ravel()[[100, 140]].tolist() == pytest.approx([500, 500], abs=50)
    bench.diagnostics(lambda _, values: (values["rejected.wrong_array_size"], values["lost"]) == ("1", "0"))


def test_of_messages_that_have_waited_the_newest_is_published_whatever_their_stamps(
    make_bench: Callable[..., Bench],
) -> None:
    bench = make_bench(27)
    cells = np.arange(10)
    # The node stands still for longer than a frame may wait.
    bench.executor.remove_node(bench.node)
    for sequence in range(100):
        bench.post(sequence, cells, cells)
    until_s = time.monotonic() + 0.2
    bench.until(lambda: time.monotonic() > until_s)
    bench.executor.add_node(bench.node)
    bench.contact(99)
    assert [message.sequence for message in bench.received["contact"]] == [99]
    bench.diagnostics(lambda _, values: (values["frames"], values["not_used"], values["lost"]) == ("1", "99", "0"))
    # What is played from a recording is old, and has not waited.
    for sequence in range(100, 103):
        bench.send(sequence, cells, cells)
        bench.contact(sequence)


def test_messages_that_wait_again_and_again_are_each_recovered_once(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(27)
    cells = np.arange(10)
    for newest in (4, 9, 14, 19):
        # The node stands still meanwhile.
        bench.executor.remove_node(bench.node)
        for sequence in range(newest - 4, newest + 1):
            bench.post(sequence, cells, cells)
        bench.executor.add_node(bench.node)
        bench.contact(newest)
    bench.until(lambda: bench.node._frames + bench.node._unused == 20)
    assert not bench.node._rejected.total()


def test_a_node_that_is_too_slow_for_its_frames_still_reports(monkeypatch: pytest.MonkeyPatch) -> None:
    pause = threading.Event()
    with ExitStack() as ends:
        rclpy.init(domain_id=217)
        ends.callback(rclpy.try_shutdown)
        # As the program runs it: on the events executor, where there is one.
        executor = make_executor()
        ends.callback(executor.shutdown)
        node = ReconstructionNode(namespace="/plate")
        ends.callback(node.destroy_node)
        step = node._pipeline.step

        def slow_step(frame: SampleFrame, stamp_ns: int) -> None:
            pause.wait(0.005)
            step(frame, stamp_ns)

        monkeypatch.setattr(node._pipeline, "step", slow_step)
        executor.add_node(node)
        peer = PollingNode("peer", namespace="/plate")
        ends.callback(peer.destroy_node)
        reports: PolledSubscription[DiagnosticArray] = peer.create_polled_subscription(
            DiagnosticArray, "/diagnostics", qos.STREAM
        )
        publisher = peer.create_publisher(TactileSamples, "samples", qos.STREAM)
        ended = threading.Event()

        def spin() -> None:
            while not ended.is_set():
                spin_for(executor, 0.1)

        thread = threading.Thread(target=spin)
        thread.start()
        ends.callback(thread.join)
        ends.callback(ended.set)
        sequence, told = 0, 0
        deadline_s = time.monotonic() + DEADLINE_S
        while told < 8:
            assert time.monotonic() < deadline_s, f"{told} reports in {DEADLINE_S:g} s"
            # Several frames while one is recovered.
            publisher.publish(TactileSamples(sequence=sequence, rows=32, cols=32, indices=[0], counts=[0]))
            sequence += 1
            told += len(reports.take_all())
            pause.wait(0.001)
