"""Before anything is begun with a controller: does it answer? Addresses 127.0.17.20 to 127.0.17.29."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from contextlib import ExitStack, closing
from types import SimpleNamespace

import pytest

from acts_control.robots import RobotConfig, UrRobot
from acts_control.robots.ur_probe import DASHBOARD_PORT, RTDE_PORT, SCRIPT_PORT, probe
from acts_core.errors import RobotError

HOST = "127.0.17.20"
VERSION = b"\x00\x04V\x01"
GREETING = b"Connected: Universal Robots Dashboard Server\n"


def listen(stack: ExitStack, port: int) -> socket.socket:
    return stack.enter_context(closing(socket.create_server((HOST, port))))


def say(stack: ExitStack, port: int, pieces: list[bytes]) -> None:
    """Answer one client, piece by piece, and hang up."""
    server = listen(stack, port)

    def serve() -> None:
        connection, _ = server.accept()
        with connection:
            for piece in pieces:
                connection.sendall(piece)
            connection.shutdown(socket.SHUT_WR)
            connection.recv(100)

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    stack.callback(thread.join, 5.0)


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    with ExitStack() as stack:
        yield stack


def test_a_controller_that_answers_is_one(stack: ExitStack) -> None:
    say(stack, RTDE_PORT, [VERSION[:2], VERSION[2:]])
    say(stack, DASHBOARD_PORT, [GREETING[:5], GREETING[5:]])
    listen(stack, SCRIPT_PORT)
    probe(HOST)


def test_nobody_there() -> None:
    with pytest.raises(RobotError, match=r"no UR controller at 127.0.17.20 port 30004"):
        probe(HOST)


@pytest.mark.parametrize("silent", [RTDE_PORT, DASHBOARD_PORT])
def test_ports_that_accept_but_do_not_answer(stack: ExitStack, silent: int) -> None:
    # As the system does for a process that stands still.
    listen(stack, silent)
    if silent != RTDE_PORT:
        say(stack, RTDE_PORT, [VERSION])
    with pytest.raises(RobotError, match=f"at port {silent} but has not answered for 0.2 s; does it stand still"):
        probe(HOST, 0.2)


@pytest.mark.parametrize("pieces", [[], [b"\x00"], [b"HTTP/1.1 400 Bad Request\r\n" * 300]])
def test_something_else_at_the_port(stack: ExitStack, pieces: list[bytes]) -> None:
    say(stack, RTDE_PORT, pieces)
    with pytest.raises(RobotError, match=r"what answers at 127.0.17.20 port 30004 is no UR controller"):
        probe(HOST, 1.0)


def test_no_new_connection_before_the_former_has_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = UrRobot(RobotConfig(robot_ip=HOST))
    monkeypatch.setattr(robot, "_process", SimpleNamespace(pid=4711, poll=lambda: None))
    with pytest.raises(RobotError, match=r"waiting for the end of the former connection \(process 4711\)"):
        robot.connect(lambda: True)


def test_without_a_connection_nothing_is_commanded() -> None:
    robot = UrRobot(RobotConfig(robot_ip=HOST))
    robot.end_program()
    robot.disconnect()
    assert not robot.is_busy
    for call in (robot.read, robot.end_servo, lambda: robot.servo([0.0] * 6)):
        with pytest.raises(RobotError, match="not connected"):
            call()
    with pytest.raises(RobotError, match="six finite numbers"):
        robot.servo([0.0, 0.0, float("nan"), 0.0, 0.0, 0.0])
