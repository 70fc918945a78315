# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the tests over DDS share: a simulated UR5e, node processes, and a ball that rolls on published tilts."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Sequence
from types import TracebackType

import rclpy
from geometry_msgs.msg import Vector3Stamped
from rclpy.client import Client
from rclpy.context import Context
from rclpy.node import Node
from spinning import Spinning
from std_srvs.srv import Trigger
from ur_process import UrProcess
from waiting import wait_for

from acts_control.ball.plate import acceleration_of
from acts_core.robots import ur5e
from acts_msgs.msg import BalanceStatus, BallReference, BallState, Contact, StreamStatistics
from acts_ros.messages import set_stamp
from acts_ros.qos import STATE, STREAM

START_TIMEOUT_S = 30.0


class SimulatedRobot(UrProcess):
    """A simulated UR5e, to begin with in the level pose."""

    def __init__(self, host: str, q_rad: Sequence[float] = ur5e.LEVEL_Q_RAD) -> None:
        super().__init__(host, "--unlock-after-s", "0", "--q0", ", ".join(map(str, q_rad)))


class Bench:
    """A ROS context of its own with a node that spins in a thread, in the namespace /plate."""

    def __init__(self, domain: int) -> None:
        self.context = Context()
        rclpy.init(context=self.context, domain_id=domain)
        self.node = Node("bench", namespace="/plate", context=self.context)
        self._nodes = [self.node]
        self._spinning: Spinning | None = None
        self.statuses: list[BalanceStatus] = []
        self.states: list[BallState] = []
        self.references: list[BallReference] = []
        self.statistics: list[StreamStatistics] = []
        self.contacts = self.node.create_publisher(Contact, "contact", STREAM)
        for kind, topic, into in (
            (BalanceStatus, "ball/status", self.statuses),
            (BallState, "ball/state", self.states),
            (BallReference, "ball/reference", self.references),
            (StreamStatistics, "contact_statistics", self.statistics),
        ):
            self.node.create_subscription(kind, topic, into.append, STATE)
        self._clients: dict[str, Client] = {}

    def add(self, node: Node) -> None:
        """Spin another node too once it starts, and destroy it at the end, when nothing spins any more."""
        self._nodes.append(node)

    def start(self) -> None:
        """Begin to spin."""
        self._spinning = Spinning(self.context, *self._nodes)

    @property
    def phase(self) -> int:
        """The controller's state as last told; -1 before."""
        return int(self.statuses[-1].state) if self.statuses else -1

    def await_phase(self, phase: int, timeout_s: float = START_TIMEOUT_S) -> BalanceStatus:
        """Wait until the controller says so; the status in which it does."""

        def told() -> BalanceStatus | None:
            # Read once: the next one may come between two looks.
            last = self.statuses[-1] if self.statuses else None
            return last if last is not None and last.state == phase else None

        return wait_for(told, lambda: f"state {phase}, it is {self.phase}", timeout_s)

    def call(self, service: str) -> Trigger.Response:
        """Call a Trigger service of ball_control."""
        # Kept: the thread that spins may not meet one that is being destroyed.
        if service not in self._clients:
            self._clients[service] = self.node.create_client(Trigger, f"ball_control/{service}")
        client = self._clients[service]
        assert client.wait_for_service(timeout_sec=START_TIMEOUT_S)
        future = client.call_async(Trigger.Request())
        wait_for(future.done, f"an answer of {service}")
        return future.result()

    def publish_contact(
        self, sequence: int, stamp_ns: int, x_m: float, y_m: float, *, touched: bool = True, frame_id: str = "plate"
    ) -> None:
        """One contact message."""
        message = Contact(sequence=sequence, in_contact=touched)
        message.header.frame_id = frame_id
        set_stamp(message.header.stamp, stamp_ns)
        message.centre_of_pressure.x, message.centre_of_pressure.y = x_m, y_m
        self.contacts.publish(message)

    def now_ns(self) -> int:
        """The clock of the stamps."""
        return self.node.get_clock().now().nanoseconds

    def __enter__(self) -> Bench:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._spinning is not None:
            self._spinning.end()
        rclpy.try_shutdown(context=self.context)
        for node in reversed(self._nodes):
            node.destroy_node()


class RollingBall:
    """Publishes contacts of a ball that rolls on the tilt that ball_control publishes, about 500 times a second.

    The plate is taken to turn about the ball (lever_arm_m: 0). `touched`, `silent` and `position` are there to meddle.
    """

    PERIOD_S = 0.002

    def __init__(self, bench: Bench, x_m: float = 0.015, y_m: float = -0.010) -> None:
        self.x, self.y, self.vx, self.vy = x_m, y_m, 0.0, 0.0
        self.touched = True
        self.silent = False
        self.nan = False
        self.tilt = (0.0, 0.0)
        self._bench = bench
        self._ending = threading.Event()
        bench.node.create_subscription(Vector3Stamped, "ball/tilt", self._on_tilt, STREAM)
        self._thread = threading.Thread(target=self._roll, daemon=True)

    def _on_tilt(self, message: Vector3Stamped) -> None:
        self.tilt = (message.vector.x, message.vector.y)

    def _roll(self) -> None:
        sequence, last = 0, time.monotonic()
        while not self._ending.wait(self.PERIOD_S):
            now = time.monotonic()
            dt, last = min(now - last, 0.02), now
            if self._bench.phase == BalanceStatus.STATE_BALANCING:
                ax, ay = acceleration_of(*self.tilt)
                self.vx, self.vy = self.vx + dt * ax, self.vy + dt * ay
                self.x, self.y = self.x + dt * self.vx, self.y + dt * self.vy
            sequence += 1
            if not self.silent:
                x, y = (float("nan"), 0.0) if self.nan else (self.x, self.y)
                self._bench.publish_contact(sequence, self._bench.now_ns(), x, y, touched=self.touched)

    def __enter__(self) -> RollingBall:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._ending.set()
        self._thread.join(10.0)


def node_command(module: str, *arguments: str, **parameters: object) -> list[str]:
    """Command line of a node of this package in the namespace /plate; `parameters` are for every node in it."""
    words = [word for name, value in parameters.items() for word in ("-p", f"{name}:={value}")]
    program = [sys.executable, "-m", "acts_ros.executables.program", f"acts_control.ball.nodes.{module}"]
    return [*program, *arguments, "--ros-args", "-r", "__ns:=/plate", *words]
