# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The simulated UR5e as the real ur_rtde client sees it; clients run in processes of their own (`ur_clients`)."""

from __future__ import annotations

import json
import math
import signal
import socket
import threading
from collections.abc import Iterator

import pytest

pytest.importorskip("rtde_control", reason="ur_rtde is not installed")

from ur_simulator import Simulator, wait_for

pytestmark = pytest.mark.slow

HOST = "127.0.1.10"
OTHER_HOST = "127.0.1.11"


@pytest.fixture(scope="module")
def running() -> Iterator[Simulator]:
    with Simulator(HOST, "--unlock-after-s", "0.5", "--ros-args", "-r", "__node:=ur_controller") as simulator:
        yield simulator


@pytest.fixture
def simulator(running: Simulator) -> Simulator:
    running.make_idle()
    return running


def test_basics(simulator: Simulator) -> None:
    found = simulator.client("basics")
    kinematics = found.pop("kinematics")
    assert kinematics[0] == pytest.approx(kinematics[1], abs=1e-9)
    # 0.2 rad at 8 rad/s2 is a triangle of 2 * sqrt(0.2 / 8) s; the client needs some more to notice.
    assert found.pop("duration_s") >= 2 * math.sqrt(0.2 / 8) - 0.01
    assert found == {
        "connected": True,
        "move": True,
        "steady": True,
        "modes": [7, 1, 2],
        "bits": [3, 1, 3],
        "short_of_target": True,
        "speed_stop": True,
        "running": False,
        "servo_after_stop": False,
        "move_again": True,
    }


def test_streaming(simulator: Simulator) -> None:
    found = simulator.client("streaming")
    assert found["accepted"]
    # The lookahead time is 0.1 s; what a busy computer adds is not bounded.
    assert found["lag_s"] > 0.05
    assert 1.0 < found["fastest"] <= math.pi + 1e-9
    assert found["stopped"]
    assert found["move"]
    assert not found["stops"]


def test_protective_stop_and_recovery(simulator: Simulator) -> None:
    found = simulator.client("protective_stop")
    assert "Cannot unlock protective stop until 0.5s" in found.pop("early")
    assert found == {
        "streamed": True,
        "servo": False,
        "move": False,
        "recovered": True,
        "triggered": False,
    }


@pytest.mark.parametrize("which", ["nan", "far", "short"])
def test_bad_targets_are_refused_by_a_protective_stop(simulator: Simulator, which: str) -> None:
    found = simulator.client("bad_target", which)
    assert found == {"move": False, "moved": False}
    assert all(math.isfinite(angle) for angle in simulator.state()["q_rad"])


def test_emergency_stop_and_clear(simulator: Simulator) -> None:
    assert simulator.client("emergency_stop") == {"move": False, "mode": 3, "recovered": True}


def test_second_control_is_refused_and_many_receivers_are_not(simulator: Simulator) -> None:
    found = simulator.client("second_control")
    assert "already in use" in found["second"]
    assert "nonsense" in found["unknown"]
    assert found["move"]


def test_upper_range_of_registers(simulator: Simulator) -> None:
    assert simulator.client("upper_registers") == {"move": True, "streamed": True}


def test_two_robots_at_once(simulator: Simulator) -> None:
    with Simulator(OTHER_HOST):
        assert simulator.client("two_robots", OTHER_HOST) == {"moves": [True, True]}


def test_a_robot_at_the_ipv6_address_of_this_machine() -> None:
    try:
        with socket.socket(socket.AF_INET6) as probe:
            probe.bind(("::1", 0))
    except OSError as error:
        pytest.skip(f"this machine has no ::1: {error}")
    with Simulator("::1") as simulator:
        assert simulator.client("connecting") == {"move": True}


def test_a_stream_outlives_its_client_unless_it_is_watched(simulator: Simulator) -> None:
    simulator.client("watched", "0")
    wait_for(lambda: abs(simulator.state()["q_rad"][0] - 1.0) < 1e-6, "the last target to be reached")
    assert simulator.state()["runtime"] == "PLAYING"
    simulator.client("connecting")
    simulator.client("watched", "10")
    wait_for(lambda: simulator.state()["runtime"] == "STOPPED", "the watchdog")
    wait_for(lambda: max(abs(speed) for speed in simulator.state()["qd_rad_s"]) == 0.0, "the arm to rest")


def test_controller_killed_and_restarted(simulator: Simulator) -> None:
    client = simulator.start_client("reconnecting")
    assert client.stdin is not None
    assert client.stdout is not None
    guard = threading.Timer(40.0, client.kill)
    guard.start()
    try:
        # `in` reads up to the line, past what the client library itself has to say.
        assert "moved\n" in client.stdout
        simulator.stop(signal.SIGKILL)
        # Only now: a client that finds the robot again while it is still looking for it may crash.
        assert "lost\n" in client.stdout
        simulator.start_again()
        output, errors = client.communicate("back\n")
    finally:
        guard.cancel()
        client.kill()
        client.wait()
    assert client.returncode == 0, errors
    found = json.loads(output.splitlines()[-1])
    assert found["move"]
    assert simulator.state()["q_rad"][0] == pytest.approx(-0.1)
