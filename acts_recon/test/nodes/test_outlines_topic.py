# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic outlines over real DDS; ROS_DOMAIN_ID 21."""

import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from recon_samples import bump

from acts_core.array import ArrayGeometry
from acts_core.frames import SampleFrame
from acts_msgs.msg import Outline
from acts_recon.nodes.reconstruction_node import ReconstructionNode
from acts_ros import qos

DEADLINE_S = 30.0
GEOMETRY = ArrayGeometry()
FIRST_NS = 1_700_000_000_000_000_000


@pytest.fixture
def context() -> Iterator[Context]:
    context = Context()
    rclpy.init(context=context, domain_id=21)
    yield context
    rclpy.try_shutdown(context=context)


def frame_of(sequence: int) -> SampleFrame:
    """All taxels at once, a thousand frames a second, of something that grows."""
    counts = min(sequence / 10, 1) * bump(GEOMETRY, 15.0, 12.0)
    return SampleFrame(
        sequence=sequence,
        board_us=1000 * sequence,
        duration_us=1,
        overruns=0,
        scheme="raster",
        rows=32,
        cols=32,
        indices=np.arange(1024, dtype=np.uint16),
        counts=np.rint(counts.ravel()).astype(np.uint16),
    )


def test_the_node_tells_outlines_while_somebody_listens(context: Context) -> None:
    node = ReconstructionNode(context=context, namespace="/plate", cli_args=[], subscribes=False)
    listener = Node("listener", namespace="/plate", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    executor.add_node(listener)
    told: list[Outline] = []
    outlines = node._abilities.outlines
    assert outlines is not None

    def until(condition: Callable[[], bool]) -> None:
        deadline = time.monotonic() + DEADLINE_S
        while not condition():
            assert time.monotonic() < deadline, "timed out"
            executor.spin_once(timeout_sec=0.05)

    def take(sequence: int) -> None:
        node.take([(frame_of(sequence), FIRST_NS + 1_000_000 * sequence)], "plate")

    take(0)
    listener.create_subscription(Outline, "outlines", told.append, qos.STREAM)
    until(lambda: outlines._send)
    for sequence in range(1, 21):
        take(sequence)
    until(lambda: bool(told) and told[-1].sequence == 20)
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
    executor.shutdown()
    node.destroy_node()
    listener.destroy_node()


def test_without_the_parameter_there_is_no_topic(context: Context) -> None:
    node = ReconstructionNode(context=context, namespace="/plate", cli_args=["--ros-args", "-p", "outlines:=false"])
    assert "/plate/outlines" not in dict(node.get_topic_names_and_types())
    node.destroy_node()
