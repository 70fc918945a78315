# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The real `dynamixel_sdk` on the simulated bus, which is a process of its own behind a pseudo-terminal."""

from __future__ import annotations

import json
import os
import select
import signal
import socket
import subprocess
import sys
import termios
import time
from collections.abc import Iterator
from contextlib import closing, suppress
from pathlib import Path
from types import SimpleNamespace

import pytest
from dynamixel_sdk import COMM_SUCCESS, GroupBulkRead, GroupSyncRead, GroupSyncWrite
from motor_bus import IDS, MotorBus
from serial import SerialException
from waiting import wait_for

from acts_core.errors import REFUSED_EXIT_CODE, ActsError, RobotError
from acts_sim.dynamixel import Bus, BusPort, ControlClient, ControlSocket

QUIET_S = 0.3
"""So long a bus that is to end waits for a client."""

MODE, TORQUE, ERROR, GOAL, CURRENT, VELOCITY, POSITION = 11, 64, 70, 116, 126, 128, 132


class Rig(MotorBus):
    """A bus without a hand, and single motors on it."""

    def __init__(self, folder: Path, *options: str) -> None:
        super().__init__(folder, "acts_sim.dynamixel.main", "--return-delay", "0", *options)

    def write(self, motor_id: int, address: int, size: int, value: int) -> tuple[int, int]:
        call = {1: self.packets.write1ByteTxRx, 2: self.packets.write2ByteTxRx, 4: self.packets.write4ByteTxRx}[size]
        result, error = call(self.port, motor_id, address, value)
        return int(result), int(error)

    def read(self, motor_id: int, address: int, size: int) -> tuple[int, int, int]:
        call = {1: self.packets.read1ByteTxRx, 2: self.packets.read2ByteTxRx, 4: self.packets.read4ByteTxRx}[size]
        value, result, error = call(self.port, motor_id, address)
        return int(value), int(result), int(error)

    def sync_read(self, address: int, size: int) -> GroupSyncRead:
        group = GroupSyncRead(self.port, self.packets, address, size)
        for motor_id in IDS:
            assert group.addParam(motor_id)
        return group


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    # A Unix socket's name may have 107 characters, which pytest's folders can exceed.
    rig = Rig(tmp_path_factory.mktemp("bus"))
    yield rig
    rig.close()


def test_every_motor_answers_a_ping(rig: Rig) -> None:
    for motor_id in IDS:
        model, result, error = rig.packets.ping(rig.port, motor_id)
        assert (model, result, error) == (1240, COMM_SUCCESS, 0)


def test_a_broadcast_ping_finds_all(rig: Rig) -> None:
    found, result = rig.packets.broadcastPing(rig.port)
    assert result == COMM_SUCCESS
    assert sorted(found) == IDS


def test_the_hand_is_set_up_moved_and_read_as_its_makers_do_it(rig: Rig) -> None:
    for address, size, value in (
        (TORQUE, 1, 0),
        (MODE, 1, 5),
        (84, 2, 600),
        (80, 2, 200),
        (102, 2, 350),
        (TORQUE, 1, 1),
    ):
        group = GroupSyncWrite(rig.port, rig.packets, address, size)
        for motor_id in IDS:
            group.addParam(motor_id, value.to_bytes(size, "little"))
        assert group.txPacket() == COMM_SUCCESS
    assert rig.write(0, MODE, 1, 3) == (COMM_SUCCESS, 7)  # access error: the torque is on
    goals = GroupSyncWrite(rig.port, rig.packets, GOAL, 4)
    for motor_id in IDS:
        goals.addParam(motor_id, (2048 + 10 * motor_id).to_bytes(4, "little"))
    assert goals.txPacket() == COMM_SUCCESS
    positions = rig.sync_read(CURRENT, 10)
    for _ in range(5000):
        assert positions.fastSyncRead() == COMM_SUCCESS
        off = [abs(positions.getData(motor_id, POSITION, 4) - 2048 - 10 * motor_id) for motor_id in IDS]
        still = all(positions.getData(motor_id, VELOCITY, 4) == 0 for motor_id in IDS)
        if still and max(off) <= 10:
            break
    assert still
    assert max(off) <= 10
    assert positions.txRxPacket() == COMM_SUCCESS  # the plain way gives the same
    assert all(abs(positions.getData(one, POSITION, 4) - 2048 - 10 * one) <= 12 for one in IDS)
    rows = GroupBulkRead(rig.port, rig.packets)
    others = IDS[5:]  # version 4.1.0 mixes up IDs with the other bytes of the request, here 0, 4 and 132
    for motor_id in others:
        rows.addParam(motor_id, POSITION, 4)
    assert rows.fastBulkRead() == COMM_SUCCESS
    assert all(abs(rows.getData(one, POSITION, 4) - 2048 - 10 * one) <= 12 for one in others)


def test_an_overload_is_told_and_gone_after_a_reboot(rig: Rig) -> None:
    assert rig.command("overload 4") == "ok"
    value, result, error = rig.read(4, ERROR, 1)
    assert (value, result, error) == (0x20, COMM_SUCCESS, 0x80)
    assert rig.read(4, TORQUE, 1)[0] == 0
    result, error = rig.write(4, TORQUE, 1, 1)
    assert (result, error) == (COMM_SUCCESS, 0x81)
    assert rig.packets.reboot(rig.port, 4)[0] == COMM_SUCCESS
    assert rig.read(4, ERROR, 1) == (0, COMM_SUCCESS, 0)


def test_a_lost_motor_is_silent_and_takes_those_behind_it_along(rig: Rig) -> None:
    assert rig.command("lose 7") == "ok"
    with rig.without_answers():
        assert rig.read(7, POSITION, 4)[1] != COMM_SUCCESS
        assert rig.sync_read(POSITION, 4).txRxPacket() != COMM_SUCCESS
        assert rig.sync_read(POSITION, 4).fastSyncRead() != COMM_SUCCESS
    assert rig.read(8, POSITION, 4)[1] == COMM_SUCCESS
    assert rig.command("find 7") == "ok"
    assert rig.sync_read(POSITION, 4).fastSyncRead() == COMM_SUCCESS


def test_a_command_that_makes_no_sense_is_answered_so(rig: Rig) -> None:
    assert rig.command("explode").startswith("error: unknown 'explode'")
    assert rig.command("lose 99").startswith("error: no motor '99'")


@pytest.mark.parametrize("module", ["acts_sim.dynamixel.main", "acts_sim.hand.process.main"])
def test_a_bus_leaves_the_link_of_another_alone(rig: Rig, tmp_path: Path, module: str) -> None:
    before = rig.link.readlink()
    command = [sys.executable, "-m", "acts_ros.executables.program", module, "--link", str(rig.link)]
    if "hand" in module:
        command += ["--field-ring", str(tmp_path / "field.ring"), "--truth-ring", str(tmp_path / "truth.ring")]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=50.0, check=False)
    assert ended.returncode == REFUSED_EXIT_CODE
    assert f"{rig.link} is in use by process {rig.process.pid}" in ended.stderr
    assert rig.link.readlink() == before
    assert rig.packets.ping(rig.port, 0)[1] == COMM_SUCCESS


def test_a_link_that_cannot_be_is_refused_in_words() -> None:
    link = Path("/tmp") / ("x" * 300)
    with pytest.raises(RobotError, match=r"the link to the port cannot be made \(File name too long\)"):
        BusPort(Bus([]), lambda _dt_s: None, 0.002, link, 0)


def test_a_control_socket_in_use_is_left_to_its_program_and_a_stale_one_is_replaced(tmp_path: Path) -> None:
    path = tmp_path / "control"
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as other:
        other.bind(str(path))
        other.listen()
        before = path.stat()
        with pytest.raises(RobotError, match="control: another program listens there; end it, or give another path"):
            ControlSocket(path, lambda line: line)
        assert os.path.samestat(path.stat(), before)
    ControlSocket(path, lambda line: line).close()
    assert not path.exists()


def test_a_control_socket_that_another_has_replaced_after_its_file_was_removed_stays(tmp_path: Path) -> None:
    path = tmp_path / "control"
    first = ControlSocket(path, lambda line: line)
    path.unlink()
    second = ControlSocket(path, lambda line: line)
    first.close()
    assert path.is_socket()
    second.close()
    assert not path.exists()


def test_a_burst_of_questions_is_answered_in_full_as_fast_as_the_client_reads(tmp_path: Path) -> None:
    control = ControlSocket(tmp_path / "control", lambda line: 3000 * line)
    with closing(control), socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as client:
        client.connect(str(tmp_path / "control"))
        client.sendall(b"x\n" * 1000)
        client.shutdown(socket.SHUT_WR)
        client.setblocking(False)
        replies = bytearray()

        def ended() -> bool:
            control.send_rest()
            for descriptor in select.select(control.descriptors(), [], [], 0.0)[0]:
                control.serve(descriptor)
            with suppress(BlockingIOError):
                data = client.recv(65536)
                replies.extend(data)
                return not data
            return False

        wait_for(ended, meanwhile=lambda: None)
    assert replies == (3000 * b"x" + b"\n") * 1000


def test_a_client_that_leaves_before_it_has_read_its_replies_is_forgotten(tmp_path: Path) -> None:
    control = ControlSocket(tmp_path / "control", lambda line: 30000 * line)
    with closing(control):
        (listening,) = control.descriptors()
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as client:
            client.connect(str(tmp_path / "control"))
            client.sendall(b"x\n" * 32)
            control.serve(listening)
            (other,) = set(control.descriptors()) - {listening}
            control.serve(other)
            assert control.descriptors() == [listening]  # not before it has read
        control.send_rest()
        with pytest.raises(OSError, match="Bad file descriptor"):
            os.fstat(other)


def test_a_late_reply_is_not_taken_for_that_to_the_next_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("acts_sim.dynamixel.control_client._TIMEOUT_S", 0.05)
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as simulation:
        simulation.bind(str(tmp_path / "control"))
        simulation.listen()
        with ControlClient(tmp_path / "control") as client:
            with pytest.raises(ActsError, match=r"control: the simulation does not answer \(timed out\)"):
                client.do("lose 3")
            connected, _ = simulation.accept()
            with connected:
                with suppress(BrokenPipeError):
                    connected.sendall(b"ok\n")
                with pytest.raises(ActsError, match="control: the simulation has not answered before; connect to it"):
                    client.do("find 3")


def test_a_link_to_something_else_is_kept(tmp_path: Path) -> None:
    link = tmp_path / "hand"
    link.symlink_to("notes.txt")
    with pytest.raises(RobotError, match=r"the link to the port cannot be made \(File exists\)"):
        BusPort(Bus([]), lambda _dt_s: None, 0.002, link, 0)
    assert link.readlink() == Path("notes.txt")
    link.unlink()
    link.symlink_to("/dev/pts/4000000")
    port = BusPort(Bus([]), lambda _dt_s: None, 0.002, link, 0)
    assert str(link.readlink()) == port.path
    port.close()


def test_steps_keep_their_time_for_hours_on_a_machine_that_runs_for_months(monkeypatch: pytest.MonkeyPatch) -> None:
    begin_ns, steps = 10_000_000 * 10**9, 20_000  # 116 days
    now_ns, stepped_ns = begin_ns, []

    def wait(_read: object, _write: object, _other: object, timeout_s: float) -> tuple[list[int], list[int], list[int]]:
        nonlocal now_ns
        now_ns += max(round(timeout_s * 1e9), 1)
        return [], [], []

    def step(_dt_s: float) -> None:
        stepped_ns.append(now_ns)
        if len(stepped_ns) == steps:
            port.stop()

    clock = SimpleNamespace(monotonic=lambda: now_ns / 1e9, monotonic_ns=lambda: now_ns)
    monkeypatch.setattr("acts_sim.dynamixel.port.time", clock)
    monkeypatch.setattr("acts_sim.dynamixel.port.select", SimpleNamespace(select=wait))
    port = BusPort(Bus([]), step, 0.002, None, 0)
    port.run()
    port.close()
    # The clock in seconds has steps of 2 ns by then.
    assert stepped_ns[-1] - begin_ns == pytest.approx(2_000_000 * (steps - 1), abs=100)


def test_a_cable_that_is_torn_off_comes_back_under_its_name(tmp_path: Path) -> None:
    rig = Rig(tmp_path, "--motors", "2")
    try:
        assert rig.command("unplug") == "ok"
        assert not rig.link.exists()
        with pytest.raises((OSError, termios.error), match=r"."):
            rig.packets.ping(rig.port, 0)
        assert rig.command("plug_in") == "ok"
        rig.port.closePort()
        rig.port = rig.open()
        assert rig.packets.ping(rig.port, 0)[1] == COMM_SUCCESS
        assert len(json.loads(rig.command("state"))["motors"]) == 2
    finally:
        rig.close()
    assert not rig.link.is_symlink()
    assert not rig.control.exists()


def test_a_cable_whose_place_is_taken_is_told_and_can_be_plugged_in_later(tmp_path: Path) -> None:
    rig = Rig(tmp_path, "--motors", "1")
    try:
        assert rig.command("unplug") == "ok"
        rig.link.write_text("of somebody else")
        assert rig.command("plug_in").startswith(
            f"error: {rig.link}: the link to the port cannot be made (File exists)"
        )
        rig.link.unlink()
        assert rig.command("plug_in") == "ok"
        rig.port.closePort()
        rig.port = rig.open()
        assert rig.packets.ping(rig.port, 0)[1] == COMM_SUCCESS
    finally:
        rig.close()


def answers_for(rig: Rig, duration_s: float, answered_s: float) -> bool:
    """Whether it answers for so long; False where this machine stood still: the bus took its client for gone.

    It has answered at `answered_s` for the last time.
    """
    begin_s = time.monotonic()
    while answered_s < begin_s + duration_s:
        try:
            result = rig.packets.ping(rig.port, 0)[1]
        except SerialException:
            result = None
        now_s = time.monotonic()
        if result != COMM_SUCCESS:
            # The bus counts from when it heard, not from when its answer came.
            assert now_s - answered_s >= 0.8 * QUIET_S, f"{result} after {now_s - answered_s:.3f} s"
            return False
        answered_s = now_s
    return True


@pytest.mark.parametrize(("number", "stays"), [(signal.SIGINT, True), (signal.SIGTERM, False)])
def test_ctrl_c_leaves_a_client_the_time_to_switch_the_torque_off(
    tmp_path: Path, number: signal.Signals, stays: bool
) -> None:
    for attempt in range(10):
        folder = tmp_path / str(attempt)
        folder.mkdir()
        rig = Rig(folder, "--motors", "2")
        begin_s = time.monotonic()
        rig.process.send_signal(number)
        # Longer than the motors wait for a client that is quiet.
        if not stays or answers_for(rig, 1.0, begin_s):
            break
        rig.process.wait(20.0)
    else:
        pytest.fail("the machine stood still in each attempt")
    assert rig.process.wait(20.0) == 0
    assert not rig.link.is_symlink()
