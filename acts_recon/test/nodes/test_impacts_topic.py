# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic impacts over real DDS; ROS_DOMAIN_ID 208."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from builtin_interfaces.msg import Duration, Time
from numpy.typing import NDArray
from recon_bench import EVERYWHERE, Bench, publisher_of
from recon_samples import bump
from std_msgs.msg import Header

from acts_core.array import ArrayGeometry
from acts_msgs.msg import Impact, TactileSamples
from acts_recon.nodes.impacts_publisher import ImpactsPublisher
from acts_ros import qos

GEOMETRY = ArrayGeometry()


def fields_of(sequence: int) -> dict[str, Any]:
    """Of a frame of all taxels, one a millisecond."""
    stamp = Time(sec=1_700_000_000, nanosec=1_000_000 * sequence)
    return {
        "header": Header(frame_id="plate", stamp=stamp),
        "duration": Duration(nanosec=950_000),
        "scheme": TactileSamples.SCHEME_RASTER,
    }


def bounce() -> list[NDArray]:
    """40 frames, of which 10 to 17 show something that moves to the right by 0.3 taxels a frame."""
    images = [np.zeros((32, 32)) for _ in range(40)]
    for number in range(8):
        force = np.sin(np.pi * (number + 0.5) / 8)
        images[10 + number] = force * bump(GEOMETRY, 15.0, 12.0 + 0.3 * number)
    return images


def test_the_node_tells_a_touch_when_it_begins_and_when_it_is_over(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(208)
    impacts = publisher_of(bench.node, ImpactsPublisher)
    bench.listen(Impact, "impacts", qos.STREAM)
    bench.until(lambda: impacts.is_wanted)

    for sequence, image in enumerate(bounce()):
        bench.send(sequence, EVERYWHERE, image, **fields_of(sequence))
    told = bench.received["impacts"]
    bench.until(lambda: len(told) >= 2)
    begun, over = told
    assert (begun.number, begun.is_over, begun.kind) == (1, False, Impact.UNKNOWN)
    assert begun.header.stamp.nanosec in (10_000_000, 11_000_000)
    assert len(begun.time) == 0
    assert (over.number, over.is_over, over.kind, over.bounced) == (1, True, Impact.IMPACT, True)
    assert over.header.frame_id == "plate"
    assert over.onset.sec == 1_700_000_000
    assert over.onset.nanosec == pytest.approx(9_500_000, abs=1_500_000)
    assert over.duration == pytest.approx(0.008, abs=0.002)
    assert over.frames in (7, 8)
    assert over.position.y == pytest.approx(float(GEOMETRY.y_m(15)), abs=0.002)
    assert over.peak_force > 1
    assert over.impulse > 0.001
    assert over.velocity.x == pytest.approx(300 * GEOMETRY.pitch_m, rel=0.2)
    assert over.direction == pytest.approx(0.0, abs=0.2)
    assert 0 < over.direction_sigma < 0.3
    assert len(over.time) == len(over.force) == len(over.path_x) == len(over.path_y) >= 5
    assert np.isfinite([*over.time, *over.force, *over.path_x, *over.path_y]).all()


def test_a_long_press_of_images_without_times_is_told(make_bench: Callable[..., Bench]) -> None:
    """The method per_frame knows no time of a sample, so that the beginning is not followed back."""
    bench = make_bench(208, method="per_frame")
    impacts = publisher_of(bench.node, ImpactsPublisher)
    bench.listen(Impact, "impacts", qos.STREAM)
    bench.until(lambda: impacts.is_wanted)

    press = bump(GEOMETRY, 15.0, 12.0)
    for sequence in range(100):
        image = press if 10 <= sequence < 80 else np.zeros((32, 32))
        bench.send(sequence, EVERYWHERE, image, **fields_of(sequence))
    told = bench.received["impacts"]
    bench.until(lambda: len(told) >= 2)
    assert [(one.is_over, one.kind) for one in told] == [(False, Impact.UNKNOWN), (True, Impact.TAP)]
    assert told[1].duration == pytest.approx(0.070, abs=0.003)


def test_a_touch_that_grows_into_another_says_which_it_has_joined(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(208)
    impacts = publisher_of(bench.node, ImpactsPublisher)
    bench.listen(Impact, "impacts", qos.STREAM)
    bench.until(lambda: impacts.is_wanted)
    nothing, both, bar = np.zeros((32, 32)), bump(GEOMETRY, 10.0, 15.0) + bump(GEOMETRY, 21.0, 15.0), np.zeros((32, 32))
    bar[9:23, 14:17] = 500
    for sequence in range(120):
        image = both if 10 <= sequence < 20 else bar if 20 <= sequence < 100 else nothing
        bench.take(sequence, image)
    told = bench.received["impacts"]
    bench.until(lambda: bool(told) and told[-1].is_over)
    assert [one.is_over for one in told] == [False, False, False, True]
    begun, joined, over = told[:2], told[2], told[3]
    assert [one.joined for one in told] == [0, 0, over.number, 0]
    assert {joined.number, over.number} == {one.number for one in begun}
    assert joined.sequence >= 20
    assert joined.duration == pytest.approx(0.011, abs=0.004)


def test_a_tare_neither_ends_a_touch_nor_begins_one(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(208)
    impacts = publisher_of(bench.node, ImpactsPublisher)
    bench.listen(Impact, "impacts", qos.STREAM)
    bench.until(lambda: impacts.is_wanted)
    press, nothing = bump(GEOMETRY, 15.0, 12.0), np.zeros((32, 32))
    noise, valid = np.ones(1024, dtype=np.float32), np.ones(1024, dtype=np.bool_)

    for sequence in range(260):
        if sequence in (60, 100):
            # Tared while it is pressed, and then untouched again though it still is.
            baseline = (press if sequence == 60 else nothing).ravel().astype(np.float32)
            bench.node._pipeline.set_baseline(baseline, noise, valid)
        bench.take(sequence, press if 10 <= sequence < 140 or 170 <= sequence < 230 else nothing)
    told = bench.received["impacts"]
    bench.until(lambda: bool(told) and told[-1].is_over)
    assert [one.is_over for one in told] == [False, False, True]
    assert [(one.header.stamp.nanosec - one.onset.nanosec) * 1e-6 for one in told[:2]] == pytest.approx([0, 0], abs=2)
    assert [one.sequence for one in told[:2]] == [10, 170]
    assert told[2].number == told[1].number


def test_without_the_parameter_there_is_no_topic(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(208, impacts=False)
    assert "/plate/impacts" not in dict(bench.node.get_topic_names_and_types())
