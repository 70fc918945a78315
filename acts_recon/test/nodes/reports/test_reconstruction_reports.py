# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the node tells of itself in diagnostics and in the log; ROS_DOMAIN_ID 184."""

import time
from collections.abc import Callable
from itertools import count
from types import SimpleNamespace

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from rclpy.node import Node
from recon_bench import Bench
from std_msgs.msg import Header

from acts_msgs.msg import Baseline, Contact, Contacts, TactileSamples
from acts_recon.nodes import reconstruction_node
from acts_ros import qos
from acts_ros.diagnostics import OK, WARN

pytestmark = pytest.mark.slow

CELLS = np.arange(10)
NOTHING = np.zeros((32, 32))


def test_a_report_tells_the_rate_and_the_time_of_a_frame_since_the_last_one(
    make_bench: Callable[..., Bench], monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = make_bench(184)
    now_s, counter_s = 5000.0, count(0.0, 0.25)
    clocks = {"monotonic": lambda: now_s, "perf_counter": lambda: next(counter_s), "time_ns": time.time_ns}
    monkeypatch.setattr(reconstruction_node, "time", SimpleNamespace(**clocks))
    bench.node._report()
    now_s += 4.0
    for sequence in range(1, 21):
        bench.take(sequence, NOTHING)
    level, words, values = bench.node._report()
    assert (level, words) == (OK, "5 frames/s")
    assert (values["rate_hz"], values["frames"], values["frame_us.median"]) == (5.0, 20, 250_000.0)
    now_s += 0.1
    bench.take(21, NOTHING)
    _, words, values = bench.node._report()
    assert words == "10 frames/s"
    assert values["frames"] == 21
    now_s += 1000.0
    level, words, values = bench.node._report()
    assert (level, words) == (WARN, "no samples")
    assert (values["rate_hz"], values["frame_us.median"]) == (0.0, 0.0)


def test_of_several_causes_the_first_is_told(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(184)

    def told_of(*sequences: int) -> tuple[int, str]:
        for sequence in sequences:
            bench.take(sequence, NOTHING)
        level, words, _ = bench.node._report()
        return level, words

    assert told_of(1, 2)[0] == OK
    level, words = told_of(3, 6)
    assert (level, words.partition(",")[0]) == (WARN, "2 frames lost before they came here")
    # A board may well begin anew twice between two reports.
    assert told_of(4, 3)[0] == OK
    level, words = told_of(2, 1, 0)
    assert level == WARN
    assert words.startswith("3 frames with a number that is not above that of the frame before, each taken for a board")
    level, words = told_of(1000, 500_000, 1001, 500_001)
    assert level == WARN
    assert words == (
        "frames of two sources come in turn, and each change is taken for another board: end all but one that "
        "publishes /plate/samples"
    )
    # The same frame once more.
    level, words = told_of(500_001, 1002, 500_002)
    assert (level, words) == (WARN, "1 message dropped that does not fit, see the log")


def test_a_second_publisher_of_what_it_takes_or_gives_is_told(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(184)
    for name in ("one", "other"):
        node = bench.add(Node(name, namespace="/forged", context=bench.context))
        node.create_publisher(Contacts, "/plate/contacts", qos.STREAM)
        node.create_publisher(TactileSamples, "/plate/samples", qos.STREAM)
        node.create_publisher(Baseline, "/plate/baseline", qos.LATCHED)
    topics = {
        "contacts": "3 publishers (/forged/one, /forged/other, /plate/reconstruction)",
        "samples": "3 publishers (/forged/one, /forged/other, /plate/peer)",
        "baseline": "2 publishers (/forged/one, /forged/other)",
    }
    bench.diagnostics(
        lambda status, _: (
            status.level == b"\x01"
            and all(f"/plate/{topic} has {words}" in status.message for topic, words in topics.items())
        )
    )


def test_what_the_taxels_read_untouched_is_subtracted_from_the_next_frame_on(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(184)
    publisher = bench.peer.create_publisher(Baseline, "baseline", qos.LATCHED)
    pressed = np.full(10, 500)
    bench.send(0, CELLS, pressed)
    assert bench.contact(0).peak == pytest.approx(500)
    bench.diagnostics(lambda _, values: values["baseline"] == "none")
    offset = Baseline(rows=32, cols=32, valid=[True] * 1024, noise=[2.0] * 1024, baseline=[100.0] * 1024)
    publisher.publish(offset)
    bench.diagnostics(lambda _, values: values["baseline"] == "subtracted")
    bench.send(1, CELLS, pressed)
    assert bench.contact(1).peak == pytest.approx(400)
    # One that is of another array changes nothing, and is told.
    publisher.publish(Baseline(rows=16, cols=32, valid=[True] * 512, noise=[2.0] * 512, baseline=[0.0] * 512))
    bench.diagnostics(
        lambda status, values: (
            (values["rejected.bad_baseline"], status.message)
            == ("1", "1 message dropped that does not fit, see the log")
        )
    )
    bench.send(2, CELLS, pressed)
    assert bench.contact(2).peak == pytest.approx(400)


def test_samples_whose_stamp_is_no_time_are_dropped_and_told_once(
    make_bench: Callable[..., Bench], capfd: pytest.CaptureFixture[str]
) -> None:
    bench = make_bench(184)
    bad = Header(frame_id="plate", stamp=Time(sec=100, nanosec=2_000_000_000))
    for sequence in (0, 1, 2):
        bench.send(sequence, CELLS, CELLS, header=bad)
    bench.send(3, CELLS, CELLS)
    assert bench.contact(3) == Contact(header=bench.contact(3).header, sequence=3)
    bench.diagnostics(lambda _, values: (values["rejected.bad_stamp"], values["frames"]) == ("3", "1"))
    assert [message.sequence for message in bench.received["contact"]] == [3]
    lines = [line for line in capfd.readouterr().err.splitlines() if "samples dropped" in line]
    assert len(lines) == 1
    assert "stamp of 2000000000 nanoseconds" in lines[0]


def test_parameters_that_the_method_does_not_use_are_told_at_the_start(
    make_bench: Callable[..., Bench], capfd: pytest.CaptureFixture[str]
) -> None:
    make_bench(184, patch_step=2, keep_measured=False)
    assert "patch_step, keep_measured: not used by method fusion" in capfd.readouterr().err
