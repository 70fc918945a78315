# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The process around the simulated UR5e: start, end, the joint ring, and clients that send anything at all."""

from __future__ import annotations

import contextlib
import itertools
import json
import random
import signal
import socket
import struct
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from ur_process import HOOK_PORT
from ur_simulator import Simulator, wait_for

from acts_core.robots import ur5e
from acts_sim.shared import JOINT_RING_WIDTH, TimedRingReader
from acts_sim.ur.main import parse
from acts_sim.ur.rtde import PacketType, encode

pytestmark = pytest.mark.slow

HOST = "127.0.1.20"
RTDE_PORT, SCRIPT_PORT, DASHBOARD_PORT = 30004, 30003, 29999
PORTS = (RTDE_PORT, SCRIPT_PORT, DASHBOARD_PORT, HOOK_PORT)


@pytest.fixture(scope="module")
def ring_path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("ring") / "not" / "yet" / "joints.ring"


@pytest.fixture(scope="module")
def simulator(ring_path: Path) -> Iterator[Simulator]:
    with Simulator(HOST, "--joint-ring", str(ring_path)) as running:
        yield running


def connect(port: int, host: str = HOST) -> socket.socket:
    return socket.create_connection((host, port), timeout=10.0)


def alive(simulator: Simulator) -> None:
    """The robot's time goes on."""
    before = float(simulator.state()["time_s"])
    wait_for(lambda: simulator.state()["time_s"] > before + 0.02, "the robot's time to go on")
    assert simulator.process.poll() is None, simulator.text()


def read_until_closed(connection: socket.socket) -> bytes:
    received = b""
    with contextlib.suppress(ConnectionError):
        while data := connection.recv(65536):
            received += data
    return received


def test_joint_ring_is_written_every_cycle(simulator: Simulator, ring_path: Path) -> None:
    reader = TimedRingReader(ring_path, JOINT_RING_WIDTH)
    wait_for(lambda: reader.written > 0, "the first cycle to be written")
    first = reader.newest()
    assert first is not None
    wait_for(lambda: reader.written > 400, "cycles to be written")
    newest = reader.newest()
    assert newest is not None
    time_ns, values = newest
    assert values[:6] == pytest.approx(ur5e.LEVEL_Q_RAD)
    assert values[6:] == pytest.approx([0.0] * 6)
    assert time_ns > first[0]
    assert reader.age_s() < 5.0


@pytest.mark.parametrize("port", PORTS)
def test_garbage_on_any_port(simulator: Simulator, port: int) -> None:
    generator = random.Random(port)
    for _ in range(30):
        with connect(port) as connection, contextlib.suppress(ConnectionError):
            connection.sendall(generator.randbytes(generator.randrange(1, 20_000)))
    for text in (b"GET / HTTP/1.1\r\n\r\n", b"\n" * 5000, b"\x00" * 10_000, b"\xff" * 10_000, b"def x(", b"end\n"):
        with connect(port) as connection, contextlib.suppress(ConnectionError):
            connection.sendall(text)
    alive(simulator)
    assert simulator.state()["safety"] == "NORMAL"


def test_rtde_garbage_is_answered_by_closing(simulator: Simulator) -> None:
    with connect(RTDE_PORT) as connection:
        connection.sendall(b"\x00\x05X\x00\x00")
        assert read_until_closed(connection) == b""
    with connect(RTDE_PORT) as connection:
        connection.sendall(b"\x00\x00V")
        assert read_until_closed(connection) == b""


def test_half_packets_wait_for_their_other_half(simulator: Simulator) -> None:
    request = encode(PacketType.REQUEST_PROTOCOL_VERSION, b"\x00\x02")
    with connect(RTDE_PORT) as connection:
        connection.sendall(request[:2])
        alive(simulator)
        connection.sendall(request[2:])
        assert connection.recv(100) == b"\x00\x04V\x01"


def test_largest_packet(simulator: Simulator) -> None:
    with connect(RTDE_PORT) as connection:
        connection.sendall(encode(PacketType.SETUP_INPUTS, b"x," * 32_766))
        header = connection.recv(3, socket.MSG_WAITALL)
        # The answer would not fit a packet; the connection ends instead.
        assert header == b"" or struct.unpack(">HB", header)[1] == PacketType.SETUP_INPUTS
    alive(simulator)


def start_stream(connection: socket.socket) -> None:
    connection.sendall(
        encode(PacketType.SETUP_OUTPUTS, struct.pack(">d", 500.0) + b"timestamp," + b"actual_q," * 100)
        + encode(PacketType.START)
    )


def test_a_client_that_does_not_read_gets_whole_packets_later(simulator: Simulator) -> None:
    with connect(RTDE_PORT) as slow:
        start_stream(slow)
        alive(simulator)
        before = float(simulator.state()["time_s"])
        wait_for(lambda: simulator.state()["time_s"] > before + 1.5, "its buffers to fill")
        slow.settimeout(10.0)
        stamps: list[float] = []
        stream = slow.makefile("rb")
        while not stamps or stamps[-1] < before + 1.6:
            size, kind = struct.unpack(">HB", stream.read(3))
            payload = stream.read(size - 3)
            if kind == PacketType.DATA_PACKAGE:
                assert len(payload) == 1 + 8 + 100 * 48
                stamps += struct.unpack_from(">d", payload, 1)
        assert stamps == sorted(stamps)
        assert max(after - before for before, after in itertools.pairwise(stamps)) > 0.1, "nothing was skipped"


def test_clients_that_vanish(simulator: Simulator) -> None:
    for _ in range(20):
        connection = connect(RTDE_PORT)
        start_stream(connection)
        # A reset instead of an orderly end.
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        connection.close()
    alive(simulator)


def test_many_connections(simulator: Simulator) -> None:
    with contextlib.ExitStack() as stack:
        held = [stack.enter_context(connect(DASHBOARD_PORT)) for _ in range(220)]
        greeted = sum(connection.recv(100).startswith(b"Connected") for connection in held)
        assert greeted == 200, "more than that are refused"
        alive(simulator)

    def greeted_again() -> bool:
        with connect(DASHBOARD_PORT) as connection:
            return connection.recv(100).startswith(b"Connected")

    wait_for(greeted_again, "a greeting after the crowd has gone")


def test_a_flood_of_commands_does_not_stop_the_clock(simulator: Simulator) -> None:
    with connect(RTDE_PORT) as connection:
        names = b"input_int_register_0," + b",".join(b"input_double_register_%d" % index for index in range(11))
        connection.sendall(encode(PacketType.SETUP_INPUTS, names))
        connection.recv(1000)
        flood = encode(PacketType.DATA_PACKAGE, struct.pack(">Bi11d", 1, 11, *[0.0] * 11)) * 500
        rest = flood
        connection.setblocking(False)
        before = float(simulator.state()["time_s"])
        sent = 0
        while float(simulator.state()["time_s"]) < before + 0.3:
            for _ in range(20):
                with contextlib.suppress(BlockingIOError):
                    count = connection.send(rest)
                    sent += count
                    rest = rest[count:] or flood
        assert sent > len(flood)

    def are_free() -> bool:
        with connect(RTDE_PORT) as connection:
            connection.sendall(encode(PacketType.SETUP_INPUTS, names))
            return b"IN_USE" not in connection.recv(1000)

    # What was sent before the end of that connection is read first, and until then its registers are taken.
    wait_for(are_free, "the registers to be given back")
    alive(simulator)


def test_a_burst_of_questions_is_answered_in_full(simulator: Simulator) -> None:
    with connect(HOOK_PORT) as connection:
        connection.sendall(b"state\n" * 5000)
        connection.shutdown(socket.SHUT_WR)
        replies = read_until_closed(connection).splitlines()
    assert [set(json.loads(reply)) for reply in replies] == [set(simulator.state())] * 5000


def test_the_real_client_still_connects_after_all_that(simulator: Simulator) -> None:
    pytest.importorskip("rtde_control", reason="ur_rtde is not installed")
    assert simulator.client("connecting") == {"move": True}


def refusal(*arguments: str, code: int = 2) -> str:
    """What the program says when it cannot start."""
    finished = subprocess.run(
        [sys.executable, "-m", "acts_ros.executables.program", "acts_sim.ur.main", *arguments],
        capture_output=True,
        text=True,
        timeout=60.0,
    )
    assert finished.returncode == code
    return finished.stderr


def test_busy_port_is_named(simulator: Simulator) -> None:
    errors = refusal("--host", HOST)
    assert HOST in errors
    assert str(RTDE_PORT) in errors


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["--host", "127.0.1.21", "--q0", "0 0 0"], "q0_rad"),
        (["--host", "127.0.1.21", "--q0", "0 0 0 0 0 nan"], "q0_rad"),
        (["--host", "127.0.1.21", "--speed-limit-rad-s", "-1"], "speed_limit_rad_s"),
        (
            ["--host", "192.0.2.1"],
            "This robot is simulated, and nothing is controlled at 192.0.2.1: for the real robot",
        ),
        (["--host", "127.0.1.21", "--joint-ring", "/proc/nowhere/ring"], "/proc/nowhere"),
        (["--host", ""], "--host is empty: needed is an address"),
        (["--host", "127.0.1.21", "--hook-port", "65536"], "--hook-port 65536: allowed is 0 (none) to 65535"),
        (["--host", "127.0.1.21", "--hook-port", "-1"], "--hook-port -1: allowed is 0 (none) to 65535"),
    ],
)
def test_bad_arguments_are_refused(arguments: list[str], named: str) -> None:
    assert named in refusal(*arguments)


def test_a_name_that_is_not_known_may_be_later() -> None:
    assert "256.0.0.1" in refusal("--host", "256.0.0.1", code=1)


def test_arguments_of_ros_are_left_out() -> None:
    options = parse(["--host", "127.0.0.9", "--ros-args", "-r", "__node:=robot", "--", "--host", "x"])
    assert options.host == "127.0.0.9"


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_signals_end_it_and_the_ring_goes(number: signal.Signals, tmp_path: Path) -> None:
    ring = tmp_path / "joints.ring"
    with Simulator("127.0.1.22", "--joint-ring", str(ring), "--q0", "0.1, 0.2, 0.3, 0.4, 0.5, 0.6") as running:
        assert running.state()["q_rad"] == [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
        assert ring.exists()
        assert running.stop(number, timeout_s=10.0) == 0
        assert not ring.exists()


def test_ctrl_c_leaves_a_client_the_time_to_end_its_motion() -> None:
    with Simulator("127.0.1.22") as running:
        with connect(DASHBOARD_PORT, running.host) as client, client.makefile("r") as answers:
            assert answers.readline().startswith("Connected")
            before_s = running.state()["time_s"]
            running.process.send_signal(signal.SIGINT)
            running.process.send_signal(signal.SIGINT)
            wait_for(lambda: running.state()["time_s"] > before_s + 0.2, "the robot's time to go on")
            client.sendall(b"stop\n")
            assert answers.readline() == "Stopped\n"
        assert running.stop(signal.SIGINT, timeout_s=10.0) == 0


def test_sigterm_ends_it_whoever_is_connected() -> None:
    with Simulator("127.0.1.22") as running, connect(DASHBOARD_PORT, running.host) as client:
        assert client.recv(100).startswith(b"Connected")
        assert running.stop(signal.SIGTERM, timeout_s=10.0) == 0
        assert client.recv(100) == b""


def test_help_names_every_setting() -> None:
    text = subprocess.run(
        [sys.executable, "-m", "acts_ros.executables.program", "acts_sim.ur.main", "--help"],
        capture_output=True,
        text=True,
        timeout=30.0,
        check=True,
    ).stdout
    for option in ("--host", "--q0", "--joint-ring", "--hook-port", "--speed-limit-rad-s", "--unlock-after-s"):
        assert option in text
