# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic impacts over real DDS; ROS_DOMAIN_ID 208."""

import time
from array import array
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np
import pytest
import rclpy
from numpy.typing import NDArray
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from recon_samples import bump

from acts_core.array import ArrayGeometry
from acts_msgs.msg import Impact, TactileSamples
from acts_recon.nodes.reconstruction_node import ReconstructionNode
from acts_ros import qos

DEADLINE_S = 30.0
GEOMETRY = ArrayGeometry()
DURATION_US = 950


@pytest.fixture
def context() -> Iterator[Context]:
    context = Context()
    rclpy.init(context=context, domain_id=208)
    yield context
    rclpy.try_shutdown(context=context)


def samples_of(image: NDArray, sequence: int) -> TactileSamples:
    """All taxels of an image, one frame a millisecond."""
    message = TactileSamples(sequence=sequence, rows=32, cols=32, scheme=TactileSamples.SCHEME_RASTER)
    message.header.frame_id = "plate"
    message.header.stamp.sec = 1_700_000_000
    message.header.stamp.nanosec = 1_000_000 * sequence
    message.duration.nanosec = 1000 * DURATION_US
    message.indices = array("H", np.arange(1024, dtype=np.uint16).tobytes())
    message.counts = array("H", image.astype(np.uint16).tobytes())
    return message


def bounce() -> list[NDArray]:
    """40 frames, of which 10 to 17 show something that moves to the right by 0.3 taxels a frame."""
    images = [np.zeros((32, 32)) for _ in range(40)]
    for number in range(8):
        force = np.sin(np.pi * (number + 0.5) / 8)
        images[10 + number] = force * bump(GEOMETRY, 15.0, 12.0 + 0.3 * number)
    return images


def test_the_node_tells_a_touch_when_it_begins_and_when_it_is_over(context: Context) -> None:
    node = ReconstructionNode(context=context, namespace="/plate", cli_args=[])
    listener = Node("listener", namespace="/plate", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    executor.add_node(listener)

    def until(condition: Callable[[], bool]) -> None:
        deadline = time.monotonic() + DEADLINE_S
        while not condition():
            assert time.monotonic() < deadline, "timed out"
            executor.spin_once(timeout_sec=0.05)

    def has_taken(frames: int) -> bool:
        return node._frames >= frames

    told: list[Impact] = []
    publisher = listener.create_publisher(TactileSamples, "samples", qos.STREAM)
    listener.create_subscription(Impact, "impacts", told.append, qos.STREAM)
    impacts = node._abilities.impacts
    assert impacts is not None
    until(lambda: publisher.get_subscription_count() == 1 and impacts._send)
    for sequence, image in enumerate(bounce()):
        publisher.publish(samples_of(image, sequence))
        until(partial(has_taken, sequence + 1))
    until(lambda: len(told) >= 2)
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
    executor.shutdown()
    node.destroy_node()
    listener.destroy_node()


def test_without_the_parameter_there_is_no_topic(context: Context) -> None:
    node = ReconstructionNode(context=context, namespace="/plate", cli_args=["--ros-args", "-p", "impacts:=false"])
    assert "/plate/impacts" not in dict(node.get_topic_names_and_types())
    node.destroy_node()
