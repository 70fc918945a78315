# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A driver and a listener on one executor, and driver processes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from lifecycle_msgs.srv import ChangeState, GetState
from peers import Peers
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger

from acts_driver.nodes.driver_node import DriverNode
from acts_driver.nodes.intake import Intake
from acts_msgs.msg import TactileSamples
from acts_ros.messages import ns_of
from acts_ros.qos import STREAM

DEADLINE_S = 20.0


def intake_of(driver: DriverNode) -> Intake:
    """What a configured driver reads frames with."""
    assert driver.intake is not None
    return driver.intake


class Rig(Peers):
    """Spins what a test adds to it, and keeps what arrives."""

    timeout_s = DEADLINE_S
    turn_s = 0.02

    def __init__(self, domain_id: int) -> None:
        super().__init__(domain_id, "listener", "/plate")
        self.domain_id = domain_id
        self.listener = self.peer
        self.samples: list[TactileSamples] = []
        self.statuses: list[dict[str, str]] = []
        self._since_ns = 0
        self.subscription = self.listener.create_subscription(TactileSamples, "samples", self.samples.append, STREAM)
        self.listener.create_subscription(DiagnosticArray, "/diagnostics", self._keep_status, 10)
        self.driver: DriverNode | None = None

    def _keep_status(self, message: DiagnosticArray) -> None:
        if ns_of(message.header.stamp) < self._since_ns:
            return
        for status in message.status:
            values = {value.key: value.value for value in status.values}
            self.statuses.append(
                {**values, "name": status.name, "level": str(status.level[0]), "message": status.message}
            )

    def start_driver(self, **parameters: object) -> DriverNode:
        """A driver in this process."""
        arguments = ["--ros-args"]
        for name, value in parameters.items():
            text = str(value).lower() if isinstance(value, bool) else str(value)
            arguments += ["-p", f"{name}:={text}"]
        self.driver = DriverNode(namespace="/plate", context=self.context, cli_args=arguments)
        self.executor.add_node(self.driver)
        return self.driver

    def spin_until(self, condition: Callable[[], object], what: str) -> None:
        """Run callbacks until a condition is true; fail by name when it does not come true."""
        self.until(condition, what=what)

    def situation(self) -> str:
        """What the driver has told last."""
        return f"last status {self.statuses[-1:]}"

    def wait_until_active(self) -> None:
        """Until the driver publishes and the listener hears it."""
        self.wait_for_match()
        self.spin_until(lambda: self.driver is not None and self.driver.active, "the active driver")
        self.wait_for_verdict()

    def wait_for_verdict(self) -> None:
        """Until it is known whether the board of the configured driver answers: frames from before are not used."""
        # The driver waits for that too, but no longer than a busy machine may take.
        session = None if self.driver is None else intake_of(self.driver).session
        if session is not None:
            self.spin_until(lambda: session.has_verdict, "word of the board, or that it says nothing")

    def wait_for_match(self) -> None:
        """Until the driver's samples reach the listener."""
        self.spin_until(lambda: self.listener.count_publishers("/plate/samples") == 1, "the publisher")
        driver = self.driver
        if driver is not None:
            self.spin_until(lambda: driver.count_subscribers("/plate/samples") == 1, "the subscription")

    def status_until(self, condition: Callable[[dict[str, str]], object], what: str) -> dict[str, str]:
        """The first status that was made from now on and fulfils a condition; one from before may yet be heard."""
        self._since_ns = time.time_ns()
        self.statuses.clear()
        self.spin_until(lambda: any(map(condition, self.statuses)), what)
        return next(filter(condition, self.statuses))

    def change_state(self, transition: int) -> bool:
        """Ask the driver for a transition over its service; whether it succeeded."""
        client = self.listener.create_client(ChangeState, "driver/change_state")
        self.spin_until(client.service_is_ready, "the driver's services")
        request = ChangeState.Request()
        request.transition.id = transition
        future = client.call_async(request)
        self.spin_until(future.done, f"transition {transition}")
        self.listener.destroy_client(client)
        return bool(future.result().success)

    def state(self) -> str:
        """Label of the driver's state, over its service."""
        client = self.listener.create_client(GetState, "driver/get_state")
        self.spin_until(client.service_is_ready, "the driver's services")
        future = client.call_async(GetState.Request())
        self.spin_until(future.done, "the state")
        self.listener.destroy_client(client)
        return str(future.result().current_state.label)

    def set_parameters(self, **values: object) -> tuple[bool, str]:
        """Set parameters of the driver as `ros2 param set` does; whether that succeeded, and the reason."""
        return self._once_heard(lambda: self._set_parameters(**values))

    def _set_parameters(self, **values: object) -> tuple[bool, str]:
        client = self.listener.create_client(SetParametersAtomically, "driver/set_parameters_atomically")
        self.spin_until(client.service_is_ready, "the parameter service")
        request = SetParametersAtomically.Request()
        request.parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
        future = client.call_async(request)
        self.spin_until(future.done, "the answer")
        self.listener.destroy_client(client)
        return bool(future.result().result.successful), str(future.result().result.reason)

    def query(self) -> tuple[bool, str]:
        """Ask for the board; success and message of the answer."""
        return self._once_heard(self._query)

    def _query(self) -> tuple[bool, str]:
        client = self.listener.create_client(Trigger, "driver/query_board")
        self.spin_until(client.service_is_ready, "the query service")
        future = client.call_async(Trigger.Request())
        self.spin_until(future.done, "the answer")
        self.listener.destroy_client(client)
        return bool(future.result().success), str(future.result().message)

    def _once_heard(self, ask: Callable[[], tuple[bool, str]]) -> tuple[bool, str]:
        """Ask again where a board that has answered before does not: a busy machine does not run it for a while."""
        answers: list[tuple[bool, str]] = []

        def is_heard() -> bool:
            answers.append(ask())
            return "the board does not answer commands any more" not in answers[-1][1]

        self.spin_until(is_heard, "an answer of the board")
        return answers[-1]

    def close(self) -> None:
        """Shut everything down."""
        self.executor.shutdown()
        if self.driver is not None:
            self.driver.close()
            self.driver.destroy_node()
        self.listener.destroy_node()
        rclpy.try_shutdown(context=self.context)


def start_process(domain_id: int, *arguments: str) -> subprocess.Popen[str]:
    """The executable `driver` as a process, in namespace /plate."""
    return subprocess.Popen(
        [
            sys.executable,
            "-m",
            "acts_ros.executables.program",
            "acts_driver.nodes.driver_node",
            "--ros-args",
            "-r",
            "__ns:=/plate",
            *arguments,
        ],
        env={**os.environ, "ROS_DOMAIN_ID": str(domain_id), "ROS_PYTHON_CHECK_FIELDS": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def read_until(process: subprocess.Popen[str], words: str) -> str:
    """What a process prints up to the line with these words; it is killed when that does not come."""
    assert process.stdout is not None
    read = ""
    watchdog = threading.Timer(DEADLINE_S, process.kill)
    watchdog.start()
    for line in process.stdout:
        read += line
        if words in line:
            break
    watchdog.cancel()
    assert words in read, read
    return read


def end_process(process: subprocess.Popen[str], deadline_s: float = 20.0) -> str:
    """Ask a process to end and return all it printed; kill it only when it does not."""
    process.send_signal(signal.SIGINT)
    try:
        return process.communicate(timeout=deadline_s)[0]
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        raise
