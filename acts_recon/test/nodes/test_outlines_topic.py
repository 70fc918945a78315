# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic outlines over real DDS; ROS_DOMAIN_ID 21."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from recon_bench import Bench, publisher_of
from recon_samples import bump

from acts_core.array import ArrayGeometry
from acts_msgs.msg import Outline
from acts_recon.nodes.outlines_publisher import OutlinesPublisher
from acts_ros import qos

GEOMETRY = ArrayGeometry()


def counts_of(sequence: int) -> NDArray[np.floating]:
    """Something that grows."""
    return min(sequence / 10, 1) * bump(GEOMETRY, 15.0, 12.0)


def test_the_node_tells_outlines_while_somebody_listens(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(21)
    outlines = publisher_of(bench.node, OutlinesPublisher)
    bench.take(0, counts_of(0))
    bench.listen(Outline, "outlines", qos.STREAM)
    bench.until(lambda: outlines.is_wanted)
    for sequence in range(1, 21):
        bench.take(sequence, counts_of(sequence))
    told = bench.received["outlines"]
    bench.until(lambda: bool(told) and told[-1].sequence == 20)
    last = told[-1]
    assert (last.header.frame_id, last.number) == ("plate", 1)
    assert last.header.stamp.nanosec == 20_000_000
    assert last.before_stamp == pytest.approx(0.5e-6, abs=1e-6)
    assert last.centre.x == pytest.approx(float(GEOMETRY.x_m(12.0)), abs=1e-3)
    assert last.centre.y == pytest.approx(float(GEOMETRY.y_m(15.0)), abs=1e-3)
    assert last.area > told[0].area > 0
    assert max(one.growth for one in told) > 0
    x, y = np.array(last.x), np.array(last.y)
    assert len(x) == len(y) > 8
    assert float(x @ np.roll(y, -1) - np.roll(x, -1) @ y) / 2 == pytest.approx(last.area, rel=1e-4)
    assert last.perimeter**2 >= 4 * np.pi * last.area


def test_a_short_touch_beside_an_old_contact_is_told_at_any_rate(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(21, outlines_rate_hz=0.1)
    outlines = publisher_of(bench.node, OutlinesPublisher)
    bench.listen(Outline, "outlines", qos.STREAM)
    bench.until(lambda: outlines.is_wanted)
    old, touch = bump(GEOMETRY, 8.0, 8.0), bump(GEOMETRY, 24.0, 24.0)
    for sequence in range(240):
        bench.take(sequence, old + touch if 200 <= sequence < 208 else old)
    told = bench.received["outlines"]
    bench.until(lambda: sum(one.number == 2 for one in told) >= 8)
    assert {one.number for one in told} == {1, 2}
    assert sum(one.number == 1 and 100 <= one.sequence < 200 for one in told) <= 1


def test_an_old_contact_is_told_of_in_every_frame_where_that_is_the_rate(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(21, outlines_rate_hz=0.0)
    outlines = publisher_of(bench.node, OutlinesPublisher)
    bench.listen(Outline, "outlines", qos.STREAM)
    bench.until(lambda: outlines.is_wanted)
    told = bench.received["outlines"]
    for sequence in range(400):
        bench.take(sequence, bump(GEOMETRY, 8.0, 8.0))
        # The queue is not as long as all of them.
        if sequence % 50 == 49:
            bench.until(lambda sequence=sequence: told and told[-1].sequence == sequence)  # type: ignore[misc]
    assert [one.sequence for one in told[-300:]] == list(range(100, 400))


def test_without_the_parameter_there_is_no_topic(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(21, outlines=False)
    assert "/plate/outlines" not in dict(bench.node.get_topic_names_and_types())
