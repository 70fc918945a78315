# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Every node with use_sim_time and no /clock, one that stands still, and one that jumps back; ROS_DOMAIN_ID 174."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.clock import ClockType
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from waiting import wait_for

from acts_control.ball.nodes.ball_control_node import BallControlNode
from acts_control.ball.nodes.ball_state_node import BallStateNode
from acts_control.ball.nodes.ball_trajectory_node import BallTrajectoryNode
from acts_core.errors import RobotError
from acts_driver.nodes.driver_node import DriverNode
from acts_msgs.msg import BallReference, SkinContacts, TactileSamples
from acts_recon.nodes.reconstruction_node import ReconstructionNode
from acts_ros import qos
from acts_ros.executor import spin_for
from acts_ros.messages import stamp_ns_of
from acts_sim.ball.ball_world_node import BallWorld
from acts_skins.contacts.node import SkinContactsNode
from acts_skins.overview.diagnostics_node import SkinDiagnosticsNode
from acts_skins.overview.frames_node import SkinFramesNode

try:
    from rclpy.experimental import EventsExecutor
except ImportError:
    EventsExecutor = SingleThreadedExecutor

DEADLINE_S = 30.0
NS_PER_S = 1_000_000_000
KEEP_THE_SYSTEMS_CLOCK = ("driver", "ball_world", "ball_state", "ball_trajectory", "ball_control")
SKINS = "base_frame: base\nskins: {plate: {pose: {parent: base}}}\n"


class NoRobot:
    """Never there: the control loop goes on trying."""

    address = "nowhere"
    is_busy = False

    def connect(self, is_wanted: Callable[[], bool]) -> None:
        raise RobotError("no robot")

    def release(self) -> None:
        pass

    def disconnect(self) -> None:
        pass


class Bench:
    """All nodes with use_sim_time, and what they say."""

    def __init__(self, folder: Path) -> None:
        self.context = Context()
        rclpy.init(context=self.context, domain_id=174)
        skins_file = folder / "skins.yaml"
        skins_file.write_text(SKINS)
        replay = folder / "samples.npz"
        np.savez(
            replay,
            indices=np.tile(np.arange(64), (500, 1)),
            counts=np.zeros((500, 64), dtype=np.uint16),
            stamp_ns=np.arange(500) * 2_000_000,
            scheme="uniform",
            duration_us=500,
        )
        self.nodes: dict[str, Node] = {}
        plate: dict[str, Any] = {"namespace": "/plate"}
        self._add(DriverNode, replay=replay, **plate)
        self._add(ReconstructionNode, **plate)
        self._add(BallWorld, field_ring=folder / "field.ring", joint_ring="none", **plate)
        self._add(BallStateNode, **plate)
        self._add(BallTrajectoryNode, **plate)
        self._add(lambda **arguments: BallControlNode(lambda _settings: NoRobot(), **arguments), **plate)  # type: ignore[arg-type, return-value]
        for kind in (SkinContactsNode, SkinFramesNode, SkinDiagnosticsNode):
            self._add(kind, skins_file=skins_file)
        self.heard: set[str] = set()
        self.sample_ages_s: list[float] = []
        listener = Node("listener", context=self.context)
        listener.create_subscription(DiagnosticArray, "/diagnostics", self._on_diagnostics, 100)
        listener.create_subscription(
            DiagnosticArray, "/diagnostics_agg", lambda _: self.heard.add("skin_diagnostics"), 10
        )
        listener.create_subscription(
            BallReference, "/plate/ball/reference", lambda _: self.heard.add("plate/ball_trajectory"), qos.STATE
        )
        listener.create_subscription(SkinContacts, "/skin_contacts", lambda _: self.heard.add("merged"), qos.STREAM)
        listener.create_subscription(TactileSamples, "/plate/samples", self._on_samples, qos.STREAM)
        self.clock = listener.create_publisher(Clock, "/clock", 1)
        self._executor = EventsExecutor(context=self.context)
        for node in (*self.nodes.values(), listener):
            self._executor.add_node(node)
        self._listener = listener
        for node in self.nodes.values():
            getattr(node, "begin", lambda: None)()

    def _add(self, make: Callable[..., Node], namespace: str = "", **parameters: object) -> None:
        words = [word for name, value in parameters.items() for word in ("-p", f"{name}:={value}")]
        arguments = ["--ros-args", "-p", "use_sim_time:=true", *words]
        node = make(context=self.context, cli_args=arguments, **({"namespace": namespace} if namespace else {}))
        self.nodes[node.get_name()] = node

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        self.heard |= {status.name for status in message.status}

    def _on_samples(self, message: TactileSamples) -> None:
        self.heard.add("samples")
        self.sample_ages_s.append((time.time_ns() - stamp_ns_of(message)) / NS_PER_S)

    def await_all(self, time_s: float | None) -> None:
        """Wait until everybody has said something, while simulated time stands at `time_s`."""
        others = {"reconstruction", *KEEP_THE_SYSTEMS_CLOCK}
        needed = {"merged", "samples", "skin_contacts", "skin_diagnostics", *(f"plate/{name}" for name in others)}
        self.heard.clear()

        def turn() -> None:
            if time_s is not None:
                message = Clock()
                message.clock.sec = round(time_s)
                self.clock.publish(message)
            spin_for(self._executor, 0.05)

        wait_for(lambda: needed <= self.heard, lambda: str(sorted(needed - self.heard)), DEADLINE_S, turn)

    def close(self) -> None:
        for node in self.nodes.values():
            getattr(node, "close", lambda: None)()
        self._executor.shutdown()
        for node in (*self.nodes.values(), self._listener):
            node.destroy_node()
        rclpy.try_shutdown(context=self.context)


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Bench]:
    bench = Bench(tmp_path)
    yield bench
    bench.close()


def test_all_nodes_go_on_whatever_simulated_time_does(bench: Bench) -> None:
    # rclpy's own timers go by the node's clock, and stand still with it.
    clocks = {timer.clock.clock_type for node in bench.nodes.values() for timer in node.timers}
    assert clocks == {ClockType.STEADY_TIME}
    for time_s in (None, 5000.0, 100.0):
        bench.await_all(time_s)
    for name in KEEP_THE_SYSTEMS_CLOCK:
        assert abs(bench.nodes[name].get_clock().now().nanoseconds - time.time_ns()) < 10 * NS_PER_S
        assert bench.nodes[name].get_parameter("use_sim_time").value is False
    assert bench.nodes["skin_contacts"].get_clock().now().nanoseconds == 100 * NS_PER_S
    assert max(map(abs, bench.sample_ages_s)) < 10.0
