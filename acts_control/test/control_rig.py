# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the tests over DDS share: a simulated UR5e, node processes, and a ball that rolls on published tilts."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import Any, TypeVar

import rclpy
from geometry_msgs.msg import Vector3Stamped
from rclpy.client import Client
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import Trigger

from acts_control.ball.plate import acceleration_of
from acts_control.robots.ur.ur_probe import DASHBOARD_PORT
from acts_core.robots import ur5e
from acts_msgs.msg import BalanceStatus, BallReference, BallState, Contact, StreamStatistics
from acts_ros.messages import set_stamp
from acts_ros.qos import STATE, STREAM

HOOK_PORT = 30100
START_TIMEOUT_S = 30.0


def wait_for(condition: Callable[[], bool], what: str | Callable[[], str], timeout_s: float = 30.0) -> None:
    """Poll until a condition holds. `what` tells of it at the end, where it does not."""
    deadline = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError(f"waited {timeout_s} s in vain for: {what if isinstance(what, str) else what()}")
        time.sleep(0.005)


P = TypeVar("P", bound="Process")


class Process:
    """A child whose output is kept; stopped with one SIGINT."""

    def __init__(self, *command: str, domain: int | None = None) -> None:
        environment = {**os.environ, "ROS_PYTHON_CHECK_FIELDS": "1"}
        if domain is not None:
            environment["ROS_DOMAIN_ID"] = str(domain)
        # A file, not a pipe: nobody reads it while the process runs. Closed in `stop`.
        self.output = tempfile.TemporaryFile()  # noqa: SIM115
        self.process = subprocess.Popen(
            command, env=environment, stdout=self.output, stderr=subprocess.STDOUT, text=True, start_new_session=True
        )

    def text(self) -> str:
        """Everything it has written."""
        # Without a seek: that would move the place where the process goes on to write.
        file = self.output.fileno()
        return os.pread(file, os.fstat(file).st_size, 0).decode()

    def stop(self, number: signal.Signals = signal.SIGINT, timeout_s: float = 20.0) -> int:
        """Signal it once and wait; the exit code."""
        if self.process.poll() is None:
            self.process.send_signal(number)
            # One that a test has made stand still would not get it.
            self.process.send_signal(signal.SIGCONT)
        try:
            return self.process.wait(timeout_s)
        finally:
            if self.process.poll() is None:
                self.process.kill()
                self.process.wait()

    def __enter__(self: P) -> P:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop(signal.SIGTERM)
        if error is not None:
            print(self.text())
        self.output.close()


class SimulatedRobot(Process):
    """A simulated UR5e, to begin with in the level pose."""

    def __init__(self, host: str, q_rad: Sequence[float] = ur5e.LEVEL_Q_RAD) -> None:
        self.host = host
        start = ", ".join(str(angle) for angle in q_rad)
        hooks = ["--hook-port", str(HOOK_PORT), "--unlock-after-s", "0"]
        super().__init__(
            sys.executable,
            "-m",
            "acts_ros.executables.program",
            "acts_sim.ur.main",
            "--host",
            host,
            "--q0",
            start,
            *hooks,
        )
        try:
            wait_for(lambda: "ready" in self.text() or self.process.poll() is not None, "the simulated robot")
            assert self.process.poll() is None
        except AssertionError as error:
            self.stop(signal.SIGKILL)
            raise AssertionError(f"{error}: {self.text()!r}") from error

    def hook(self, line: str) -> str:
        """Do what a person at the robot could do."""
        with socket.create_connection((self.host, HOOK_PORT), timeout=10.0) as connection:
            connection.sendall(line.encode() + b"\n")
            return connection.makefile("r").readline().strip()

    def ask_dashboard(self, line: str) -> str:
        """Do what a person does at the robot's panel; what it answers."""
        with socket.create_connection((self.host, DASHBOARD_PORT), timeout=10.0) as connection:
            lines = connection.makefile("rw")
            lines.readline()
            lines.write(line + "\n")
            lines.flush()
            return lines.readline().strip()

    def state(self) -> dict[str, Any]:
        """Joint angles, program, safety."""
        return dict(json.loads(self.hook("state")))

    def orders(self) -> list[tuple[float, str, str]]:
        """What clients have told it to do: the robot's time [s], the port, and what."""
        return [tuple(order) for order in json.loads(self.hook("orders"))]


class Bench:
    """A ROS context of its own with a node that spins in a thread, in the namespace /plate."""

    def __init__(self, domain: int) -> None:
        self.context = Context()
        rclpy.init(context=self.context, domain_id=domain)
        self.node = Node("bench", namespace="/plate", context=self.context)
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)
        self._added: list[Node] = []
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
        self._ended: Future[None] = Future()
        self._thread = threading.Thread(target=self._spin, daemon=True)

    def add(self, node: Node) -> None:
        """Spin another node too, and destroy it at the end, when nothing spins any more."""
        self._executor.add_node(node)
        self._added.append(node)

    def start(self) -> None:
        """Begin to spin."""
        self._thread.start()

    def _spin(self) -> None:
        try:
            self._executor.spin_until_future_complete(self._ended)
        except ExternalShutdownException:
            return

    @property
    def phase(self) -> int:
        """The controller's state as last told; -1 before."""
        return int(self.statuses[-1].state) if self.statuses else -1

    def await_phase(self, phase: int, timeout_s: float = START_TIMEOUT_S) -> BalanceStatus:
        """Wait until the controller says so; the status."""
        wait_for(lambda: self.phase == phase, lambda: f"state {phase}, it is {self.phase}", timeout_s)
        return self.statuses[-1]

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
        self._ended.set_result(None)
        if self._thread.is_alive():
            self._thread.join(10.0)
        self._executor.shutdown()
        rclpy.try_shutdown(context=self.context)
        for node in (*self._added, self.node):
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
