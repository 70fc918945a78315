# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic spectra over real DDS; ROS_DOMAIN_ID 20."""

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
from acts_core.skin import ForceResponse
from acts_msgs.msg import Spectrum
from acts_recon.nodes.reconstruction_node import ReconstructionNode
from acts_ros import qos

DEADLINE_S = 30.0
GEOMETRY = ArrayGeometry()
RESPONSE = ForceResponse()
FIRST_NS = 1_700_000_000_000_000_000


@pytest.fixture
def context() -> Iterator[Context]:
    context = Context()
    rclpy.init(context=context, domain_id=20)
    yield context
    rclpy.try_shutdown(context=context)


def frame_of(sequence: int) -> SampleFrame:
    """All taxels at once, a thousand frames a second, of something that vibrates at 90 Hz."""
    still = RESPONSE.force_n(bump(GEOMETRY, 15.0, 12.0))
    counts = RESPONSE.counts((1 + 0.1 * np.cos(2 * np.pi * 0.09 * sequence)) * still)
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


def test_the_node_tells_how_a_contact_vibrates_while_somebody_listens(context: Context) -> None:
    given = ["--ros-args", "-p", "spectra_window_s:=0.2", "-p", "spectra_rate_hz:=0.0"]
    node = ReconstructionNode(context=context, namespace="/plate", cli_args=given, subscribes=False)
    listener = Node("listener", namespace="/plate", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    executor.add_node(listener)
    told: list[Spectrum] = []
    spectra = node._abilities.spectra
    assert spectra is not None

    def until(condition: Callable[[], bool]) -> None:
        deadline = time.monotonic() + DEADLINE_S
        while not condition():
            assert time.monotonic() < deadline, "timed out"
            executor.spin_once(timeout_sec=0.05)

    def take(sequence: int) -> None:
        node.take([(frame_of(sequence), FIRST_NS + 1_000_000 * sequence)], "plate")

    take(0)
    assert not spectra._analyser._frames
    listener.create_subscription(Spectrum, "spectra", told.append, qos.STREAM)
    until(lambda: spectra._send)
    for sequence in range(1, 200):
        take(sequence)
    sequence = 200
    while not told and sequence < 4000:
        # What is made beside is published with a frame after it.
        take(sequence)
        executor.spin_once(timeout_sec=0.01)
        sequence += 1
    first = told[0]
    assert (first.header.frame_id, first.contact, first.contacts) == ("plate", 0, 1)
    assert (first.header.stamp.sec, first.header.stamp.nanosec) == (1_700_000_000, 1_000_000 * first.sequence)
    assert first.duration == pytest.approx(0.1, abs=0.01)
    assert first.sample_rate == pytest.approx(1000, rel=1e-3)
    assert first.position.x == pytest.approx(float(GEOMETRY.x_m(12.0)), abs=1e-3)
    assert first.peak_frequency[0] == pytest.approx(90, abs=0.5)
    assert 0 < first.peak_frequency_sigma[0] < 0.5
    assert first.peak_amplitude[0] == pytest.approx(0.1 * first.force, rel=0.05)
    assert 0 < first.peak_amplitude_sigma[0] < first.peak_amplitude[0]
    assert np.argmax(first.amplitude) * first.step == pytest.approx(90, abs=2)
    executor.shutdown()
    node.destroy_node()
    listener.destroy_node()


def test_without_the_parameter_there_is_no_topic(context: Context) -> None:
    node = ReconstructionNode(context=context, namespace="/plate", cli_args=["--ros-args", "-p", "spectra:=false"])
    assert "/plate/spectra" not in dict(node.get_topic_names_and_types())
    node.destroy_node()
