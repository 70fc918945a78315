# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The process `hand_world`: the real `dynamixel_sdk` moves fingers, the ring tells what they feel. No ROS."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import waiting
from dynamixel_sdk import COMM_SUCCESS, GroupSyncRead, GroupSyncWrite
from hand_motors import AROUND_SPHERE
from motor_bus import IDS, MotorBus

from acts_core.errors import REFUSED_EXIT_CODE
from acts_core.skin import layout
from acts_sim.hand import HandTruth, TruthFollower
from acts_sim.hand.process.main import parse
from acts_sim.shared import TimedRingReader

pytestmark = pytest.mark.slow

wait_for = partial(waiting.wait_for, timeout_s=15.0)
PATCHES = [patch.name for patch in layout("leap_right").patches]


class Rig(MotorBus):
    """The process, its port as a user opens it, its rings."""

    def __init__(self, folder: Path, *options: str) -> None:
        rings = ("--field-ring", str(folder / "field.ring"), "--truth-ring", str(folder / "truth.ring"))
        times = ("--return-delay-time", "0", "--lead-ms", "4")
        super().__init__(folder, "acts_sim.hand.process.main", *rings, *times, *options)
        self.field = TimedRingReader(folder / "field.ring", 1024)
        self.truth = TruthFollower(folder / "truth.ring")

    def state(self) -> dict[str, Any]:
        return dict(json.loads(self.command("state")))

    def write_all(self, address: int, size: int, values: list[int]) -> None:
        group = GroupSyncWrite(self.port, self.packets, address, size)
        for motor_id, value in zip(IDS, values, strict=True):
            group.addParam(motor_id, value.to_bytes(size, "little", signed=True))
        assert group.txPacket() == COMM_SUCCESS

    def positions(self) -> list[int]:
        group = GroupSyncRead(self.port, self.packets, 126, 10)
        for motor_id in IDS:
            assert group.addParam(motor_id)
        assert group.fastSyncRead() == COMM_SUCCESS
        return [int(group.getData(motor_id, 132, 4)) for motor_id in IDS]

    def felt(self) -> np.ndarray:
        newest = self.field.newest()
        assert newest is not None
        return newest[1]


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    # A Unix socket's name may have 107 characters, which pytest's folders can exceed.
    rig = Rig(tmp_path_factory.mktemp("hand"))
    yield rig
    rig.close()


def test_fingers_close_and_feel(rig: Rig) -> None:
    assert all(abs(one - 2048) < 300 for one in rig.positions())
    palm = layout("leap_right").patch_of_taxel.ravel() == 0
    wait_for(lambda: rig.felt()[palm].sum() > 100.0)
    assert not rig.felt()[~palm].any()
    for address, size, value in ((64, 1, 0), (11, 1, 5), (84, 2, 600), (80, 2, 200), (102, 2, 300), (64, 1, 1)):
        rig.write_all(address, size, [value] * 16)
    rig.write_all(116, 4, [2048 + round(angle * 4096 / (2 * np.pi)) for angle in AROUND_SPHERE])
    wait_for(lambda: bool(rig.felt()[~palm].any()))
    middle = layout("leap_right").patch_of_taxel.ravel() == PATCHES.index("middle_distal")
    wait_for(lambda: rig.felt()[middle].sum() > 100.0)
    assert rig.positions()[5] > 2048 + 600
    truth = rig.state()["truth"]
    assert truth["patches"]["middle_distal"]["force_n"] > 0.1
    assert truth["object_lost"] is False


def newest_ns(rig: Rig) -> int:
    newest = rig.field.newest()
    return 0 if newest is None else newest[0]


def test_the_field_is_ahead_of_the_clock_by_what_was_said(rig: Rig) -> None:
    newest = rig.field.newest()
    assert newest is not None
    # Later than told only where the machine let the process wait.
    assert newest[0] - time.monotonic_ns() <= 4_000_000
    wait_for(lambda: newest_ns(rig) - time.monotonic_ns() > 2_000_000)


def test_the_truth_comes_as_rows_with_their_times(rig: Rig) -> None:
    rig.truth.new()
    wait_for(lambda: rig.state()["loop"]["steps"] > 200)
    assert rig.command("shake x 3 5 0.4") == "ok"
    seen: list[tuple[int, HandTruth]] = []

    def shaken() -> bool:
        times_ns, rows = rig.truth.new()
        seen.extend(zip(times_ns.tolist(), (HandTruth.from_row(row, PATCHES) for row in rows), strict=True))
        return max((abs(truth.gravity_m_s2[0]) for _, truth in seen), default=0.0) > 1.0

    wait_for(shaken)
    steps_ns = np.diff([time_ns for time_ns, _ in seen])
    assert (steps_ns >= 2_000_000).all()
    worlds = np.diff([truth.time_s for _, truth in seen])
    assert worlds == pytest.approx(0.002)


def test_a_poke_is_felt_where_it_was_asked_for(rig: Rig) -> None:
    assert rig.command("poke thumb_medial sharp 100 2") == "ok"
    wait_for(lambda: rig.state()["truth"]["patches"]["thumb_medial"]["tip_force_n"] > 0.02)
    assert rig.command("withdraw") == "ok"
    wait_for(lambda: rig.state()["truth"]["patches"]["thumb_medial"]["tip_force_n"] == 0.0)


def test_faults_of_motors_and_cable(rig: Rig) -> None:
    assert rig.command("overload 3") == "ok"
    value, result, error = rig.packets.read1ByteTxRx(rig.port, 3, 70)
    assert (value, result, error) == (0x20, COMM_SUCCESS, 0x80)
    assert rig.packets.reboot(rig.port, 3)[0] == COMM_SUCCESS
    assert rig.command("block 1") == "ok"
    before = rig.positions()[1]
    goals = rig.positions()
    goals[1] -= 300
    for address, size, value in ((64, 1, 0), (11, 1, 5), (64, 1, 1)):
        rig.write_all(address, size, [value] * 16)
    rig.write_all(116, 4, goals)
    wait_for(lambda: abs(rig.state()["motors"][1]["torque_nm"]) > 0.05)
    assert abs(rig.positions()[1] - before) <= 1
    assert rig.command("release 1") == "ok"
    wait_for(lambda: rig.positions()[1] < before - 100)
    assert rig.command("unplug") == "ok"
    assert rig.state()["connected"] is False
    assert rig.command("plug_in") == "ok"


@pytest.mark.parametrize(
    ("line", "word"),
    [
        ("dance", "known are let_go"),
        ("unplugged", ", release ID, unplug, plug_in, state"),
        ("load much", "a number from -100 to 100"),
        ("load nan", "a number from -100 to 100"),
        ("poke nose sharp", "palm, index_proximal"),
        ("pull 1 2", "pull FX_N"),
        ("block 99", "no motor"),
        ("move 1 2 3", "hold first"),
    ],
)
def test_what_is_not_allowed_is_said(rig: Rig, line: str, word: str) -> None:
    answer = rig.command(line)
    assert answer.startswith("error: ")
    assert word in answer


INTERRUPTED = """
import os, signal, sys, time
import acts_sim.hand.process.main as process
from acts_ros.executables.program import Program

def make_world(config):
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(60.0)

process.HandWorld = make_world
sys.exit(Program("acts_sim.hand.process.main")())
"""


def test_a_cable_whose_place_is_taken_does_not_end_the_world(rig: Rig) -> None:
    assert rig.command("unplug") == "ok"
    rig.link.mkdir()
    assert rig.command("plug_in").startswith(f"error: {rig.link}: the link to the port cannot be made")
    rig.link.rmdir()
    assert rig.command("plug_in") == "ok"


@pytest.mark.parametrize(("one", "other"), [("--field-ring", "--truth-ring"), ("--link", "--control")])
def test_one_path_for_two_files_is_refused(capsys: pytest.CaptureFixture[str], one: str, other: str) -> None:
    with pytest.raises(SystemExit) as ended:
        parse([one, "/tmp/same", other, "/tmp/same"])
    assert ended.value.code == 2
    assert f"{one} and {other} are both /tmp/same" in capsys.readouterr().err


def test_the_truth_of_another_world_is_left_alone(rig: Rig, tmp_path: Path) -> None:
    ring = rig.link.with_name("truth.ring")
    before = ring.stat()
    command = [sys.executable, "-m", "acts_ros.executables.program", "acts_sim.hand.process.main"]
    command += ["--link", str(tmp_path / "hand"), "--field-ring", str(tmp_path / "field.ring")]
    command += ["--control", str(rig.control), "--truth-ring", str(ring)]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=50, check=False)
    assert ended.returncode == REFUSED_EXIT_CODE
    assert f"{ring} is in use by process {rig.process.pid}" in ended.stderr
    assert os.path.samestat(ring.stat(), before)


def test_a_signal_while_the_world_is_made_ends_the_process_in_order_and_at_once(tmp_path: Path) -> None:
    command = [sys.executable, "-c", INTERRUPTED, "--link", str(tmp_path / "hand")]
    command += ["--field-ring", str(tmp_path / "field.ring"), "--truth-ring", str(tmp_path / "truth.ring")]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=50, check=False)
    assert (ended.returncode, ended.stderr) == (0, "")


SLOW_TO_COMPILE = """
import sys
from acts_core.stop_signals import StopSignals
from acts_sim.hand.process import main

class Slow(main.HandWorld):
    def __init__(self, config):
        sys.stdin.read()  # until the test has seen what it waits for
        super().__init__(config)

main.HandWorld = Slow
sys.exit(main.main(StopSignals()))
"""


def test_that_it_compiles_is_told_while_it_does(tmp_path: Path) -> None:
    command = [sys.executable, "-c", SLOW_TO_COMPILE, "--link", str(tmp_path / "hand")]
    command += ["--field-ring", str(tmp_path / "field.ring"), "--truth-ring", str(tmp_path / "truth.ring")]
    command += ["--control", str(tmp_path / "control")]
    log = tmp_path / "log"
    with (
        log.open("w") as file,
        subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=file, text=True) as process,
    ):
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            told = "compiling: this takes long the first time on a machine\n"
            wait_for(lambda: log.read_text() == told, what="a line on standard error")
            process.stdin.close()
            assert json.loads(process.stdout.readline())["link"] == str(tmp_path / "hand")
        finally:
            process.kill()
    assert log.read_text() == told
