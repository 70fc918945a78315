# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The program `skins` with its real processes: one skin's faults leave the other alone. ROS_DOMAIN_IDs 160 to 162."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest
from numpy.typing import NDArray
from peers import Peers
from waiting import pause, wait_for

from acts_core.errors import REFUSED_EXIT_CODE, SettingsError
from acts_msgs.msg import Contact
from acts_ros import qos
from acts_sim.shared import FileClaim
from acts_skins.skin_processes import SkinProcesses
from acts_skins.skins_file import read_skins

pytestmark = pytest.mark.slow

DEADLINE_S = 120.0
TWO = """
skins:
  left: {port: "serial:1", pose: {parent: base_link}}
  right: {port: "serial:2", m: 64, pose: {parent: base_link}}
"""


def skins_yaml(folder: Path, text: str = TWO) -> Path:
    path = folder / "skins.yaml"
    path.write_text(text)
    return path


def stamp_ns(contact: Contact) -> int:
    return int(contact.header.stamp.sec * 10**9 + contact.header.stamp.nanosec)


class Skins:
    """The running program."""

    def __init__(self, process: subprocess.Popen[bytes], output: Path) -> None:
        self.process = process
        self._output = output

    @property
    def output(self) -> str:
        return self._output.read_text(errors="replace")

    def child(self, label: str) -> psutil.Process:
        """A process such as left/tactile that runs now, by what the program has said of it."""
        pids = re.findall(rf"\[{label}\]: process started with pid \[(\d+)\]", self.output)
        return psutil.Process(int(pids[-1]))

    def until(self, condition: Callable[[], bool], step: Callable[[], Any] = pause) -> None:
        wait_for(condition, timeout_s=DEADLINE_S, meanwhile=step, state=lambda: self.output)


@contextmanager
def running(folder: Path, path: Path, domain_id: int, *words: str) -> Iterator[Skins]:
    environment = {**os.environ, "ROS_DOMAIN_ID": str(domain_id), "ROS_PYTHON_CHECK_FIELDS": "1"}
    command = [sys.executable, "-m", "acts_ros.executables.program", "acts_skins.skins", "--skins-file", str(path)]
    command += ["--run-dir", str(folder / "run"), *words]
    log = folder / "output.txt"
    with (
        log.open("wb") as output,
        subprocess.Popen(
            command, env=environment, stdout=output, stderr=subprocess.STDOUT, start_new_session=True
        ) as process,
    ):
        try:
            yield Skins(process, log)
        finally:
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
                try:
                    process.wait(20.0)
                except subprocess.TimeoutExpired:
                    process.kill()


class Listener(Peers):
    """Counts the contacts of skins."""

    def __init__(self, domain_id: int, *topics: str) -> None:
        super().__init__(domain_id)
        self.messages = {topic: self.listen(Contact, topic, qos.STREAM) for topic in topics}


@pytest.fixture
def listener(request: pytest.FixtureRequest) -> Iterator[Listener]:
    made = Listener(*request.param)
    yield made
    made.close()


@pytest.mark.parametrize("listener", [(160, "/robot/left/contact", "/robot/right/contact")], indirect=True)
def test_a_skin_that_is_killed_comes_again_and_the_other_notices_nothing(listener: Listener, tmp_path: Path) -> None:
    left, right = listener.messages.values()
    with running(tmp_path, skins_yaml(tmp_path), 160, "--ros-args", "-r", "__ns:=/robot") as skins:
        skins.until(lambda: len(left) > 100 and len(right) > 100, listener.turn)
        assert {left[-1].header.frame_id, right[-1].header.frame_id} == {"left", "right"}
        other = skins.child("right/tactile")
        skins.child("left/tactile").kill()
        skins.until(lambda: "[left/tactile]: process has died" in skins.output, listener.turn)
        # Contacts of before may still wait for this test.
        died_ns = time.time_ns()
        skins.until(lambda: len(left) > 0 and stamp_ns(left[-1]) > died_ns, listener.turn)
        assert sum(stamp_ns(contact) > died_ns for contact in right) > 100
        assert other.is_running()
        children = psutil.Process(skins.process.pid).children(recursive=True)
        assert len(children) >= 6
        skins.process.send_signal(signal.SIGINT)
        assert skins.process.wait(30.0) == 0, skins.output
        assert not any(child.is_running() for child in children)
        assert skins.output.count("sending signal 'SIGINT'") == 6
        assert "sending signal 'SIGTERM'" not in skins.output
        assert "Traceback" not in skins.output
        # A folder that stays would be in the way of a port of its name, as that of the hand.
        assert list((tmp_path / "run").rglob("*")) == []


@pytest.mark.parametrize("listener", [(161, "/left/contact")], indirect=True)
def test_nothing_is_left_when_the_program_is_killed(listener: Listener, tmp_path: Path) -> None:
    with running(tmp_path, skins_yaml(tmp_path), 161) as skins:
        skins.until(lambda: bool(listener.messages["/left/contact"]), listener.turn)
        children = psutil.Process(skins.process.pid).children(recursive=True)
        assert children
        skins.process.kill()
        skins.process.wait()
        skins.until(lambda: not any(is_alive(child) for child in children))


def is_alive(process: psutil.Process) -> bool:
    # It may end between any two questions.
    with contextlib.suppress(psutil.NoSuchProcess):
        return bool(process.is_running() and process.status() != psutil.STATUS_ZOMBIE)
    return False


def test_a_wrong_file_is_told_in_one_line_before_anything_starts(tmp_path: Path) -> None:
    path = skins_yaml(tmp_path, TWO.replace("m: 64", "scheme: rastr"))
    with running(tmp_path, path, 162) as skins:
        assert skins.process.wait(DEADLINE_S) == REFUSED_EXIT_CODE
        assert skins.output.startswith(f"error: {path}:4: skin right: scheme = 'rastr': allowed is")
        assert skins.output.count("\n") == 1


@pytest.mark.parametrize(
    ("change", "words", "fixed_to"),
    [
        (("{parent: base_link}", "{parent: torsoo}"), (), "torsoo, and base_link to base_link"),
        (("", ""), ("--base-frame=torso",), "base_link, and torso to torso"),
    ],
)
def test_where_contacts_are_merged_a_skin_that_cannot_be_placed_keeps_all_from_starting(
    tmp_path: Path, change: tuple[str, str], words: tuple[str, ...], fixed_to: str
) -> None:
    path = skins_yaml(tmp_path, TWO.replace(*change))
    with running(tmp_path, path, 162, "--merge", " True", *words) as skins:
        assert skins.process.wait(DEADLINE_S) == REFUSED_EXIT_CODE
        assert skins.output.startswith(f"error: {path}:3: skin left: the frame left is fixed to {fixed_to}: ")
        assert skins.output.count("\n") == 1
    assert not (tmp_path / "run").exists()


def test_a_folder_in_which_other_skins_are_simulated_is_refused_with_who_has_it(tmp_path: Path) -> None:
    with (
        contextlib.closing(FileClaim(tmp_path / "run" / "skins")),
        running(tmp_path, skins_yaml(tmp_path), 162) as skins,
    ):
        assert skins.process.wait(DEADLINE_S) == REFUSED_EXIT_CODE
        assert re.match(rf"error: \S+/run/skins is in use by process {os.getpid()} .*run_dir:=", skins.output)
        assert "process started" not in skins.output
    assert not (tmp_path / "run" / "skins.lock").exists()


def test_no_folder_is_made_that_is_named_as_the_home_is_by_a_shell(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As of `run_dir:=~/run`; `rm -r ~` would remove more than that."""
    path = skins_yaml(tmp_path)
    monkeypatch.chdir(tmp_path)
    with running(tmp_path, path, 162, "--run-dir", "~/run") as skins:
        skins.until(lambda: skins.process.poll() is not None or Path("~").exists())
        assert not Path("~").exists()
        assert skins.process.wait(DEADLINE_S) == REFUSED_EXIT_CODE
        assert skins.output.startswith(
            "error: the folder ~/run begins with ~, which no shell replaces there; write $HOME"
        )
        assert skins.output.count("\n") == 1


def plan(path: Path, *, simulated: bool) -> dict[str, str]:
    processes = SkinProcesses(
        read_skins(path), simulated=simulated, run_dir=Path("/run"), namespace="", environment=os.environ
    ).plan()
    return {process.label: " ".join(process.command) for process in processes}


def test_without_simulation_a_skin_is_one_process_at_its_port(tmp_path: Path) -> None:
    commands = plan(skins_yaml(tmp_path), simulated=False)
    assert list(commands) == ["left/tactile", "right/tactile"]
    assert "--set driver.port=serial:1" in commands["left/tactile"]
    assert "--set driver.m=64" in commands["right/tactile"]
    assert commands["right/tactile"].endswith("--ros-args -r __ns:=/right")


def test_the_ball_rolls_on_the_skins_own_layout(tmp_path: Path) -> None:
    text = """
skins:
  sole: {layout: insole, pitch_m: 0.007, row_pitch_m: 0.009, pose: {parent: base_link}}
  plate: {rows: 16, cols: 8, pose: {parent: base_link}}
"""
    commands = plan(skins_yaml(tmp_path, text), simulated=True)
    worlds = {name: _settings_of(commands[f"{name}/ball_world"], "ball_world") for name in ("sole", "plate")}
    assert {"layout": "insole", "pitch_m": "0.007", "row_pitch_m": "0.009"}.items() <= worlds["sole"].items()
    assert {"rows": "16", "cols": "8", "layout": "square", "pitch_m": "0.0"}.items() <= worlds["plate"].items()


def _settings_of(command: str, node: str) -> dict[str, str]:
    return dict(re.findall(rf"--set {node}\.(\w+)=(\S*)", command))


def test_a_recording_stands_in_for_the_ball_and_a_replay_for_the_board(tmp_path: Path) -> None:
    np.save(tmp_path / "press.npy", np.zeros((3, 32, 32), np.uint16))
    (tmp_path / "touch.npz").touch()
    text = TWO.replace('port: "serial:1"', "recording: press.npy").replace('port: "serial:2"', "replay: touch.npz")
    commands = plan(skins_yaml(tmp_path, text), simulated=True)
    assert list(commands) == ["left/virtual_board", "left/tactile", "right/tactile"]
    assert f"--recording {tmp_path}/press.npy" in commands["left/virtual_board"]
    assert f"driver.replay={tmp_path}/touch.npz" in commands["right/tactile"]


@pytest.mark.parametrize(
    ("frames", "words"),
    [
        (
            np.zeros((3, 16, 16), np.uint16),
            r"holds \(3, 16, 16\) of type uint16; needed .*\(n, rows = 32, cols",
        ),
        (np.zeros((32, 32), np.uint16), r"holds \(32, 32\) of type uint16"),
        (np.zeros((3, 32, 32)), "of type float64; needed .* of type uint16"),
        (np.zeros((3, 32, 32), ">u2"), "of type >u2; needed .* of type uint16"),
        (np.asfortranarray(np.zeros((3, 32, 32), np.uint16)), "in C order"),
        (np.zeros((0, 32, 32), np.uint16), r"holds \(0, 32, 32\) .*needed are one or more frames"),
        (None, "no .npy file of frames"),
    ],
)
def test_a_recording_that_its_board_would_refuse_is_refused_before_anything_starts(
    tmp_path: Path, frames: NDArray[Any] | None, words: str
) -> None:
    (tmp_path / "press.npy").write_bytes(b"PK no frames")
    if frames is not None:
        np.save(tmp_path / "press.npy", frames)
    with pytest.raises(SettingsError, match=rf"skins\.yaml:3: skin left: recording = .*press\.npy: .*{words}"):
        plan(skins_yaml(tmp_path, TWO.replace('port: "serial:1"', "recording: press.npy")), simulated=True)


def test_the_boards_of_simulated_skins_are_as_the_file_says(tmp_path: Path) -> None:
    commands = plan(skins_yaml(tmp_path, TWO.replace("m: 64", "m: 64, rows: 16, cols: 24")), simulated=True)
    assert "--link /run/right/board --rows 16 --cols 24" in commands["right/virtual_board"]
    assert "--seed 2" in commands["right/virtual_board"]
    assert "--set ball_world.rows=16" in commands["right/ball_world"]
    assert "driver.port=/run/right/board" in commands["right/tactile"]


@pytest.mark.parametrize(("rate_cap_hz", "rate_hz"), [("1.0e+6", "100000.0"), ("500", "500.0"), ("0", "1000.0")])
def test_a_simulated_board_takes_every_rate_cap_that_a_driver_takes(
    tmp_path: Path, rate_cap_hz: str, rate_hz: str
) -> None:
    """A board of hardware takes a period of a microsecond, too."""
    path = skins_yaml(tmp_path, TWO.replace("m: 64", f"driver: {{rate_cap_hz: {rate_cap_hz}}}"))
    commands = plan(path, simulated=True)
    assert f" --rate-hz {rate_hz} " in commands["right/virtual_board"]


@pytest.mark.parametrize(
    ("change", "simulated", "words"),
    [
        (("port: ", "recording: "), True, "skins.yaml:3: skin left: recording = "),
        (('port: "serial:1", ', ""), False, "skins.yaml:3: skin left: port or replay is missing"),
    ],
)
def test_a_skin_without_its_source_is_refused(
    tmp_path: Path, change: tuple[str, str], simulated: bool, words: str
) -> None:
    with pytest.raises(SettingsError) as caught:
        plan(skins_yaml(tmp_path, TWO.replace(*change)), simulated=simulated)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("replay: gone.npz", "replay = {folder}/gone.npz: there is nothing of this name"),
        ("replay: ~/gone", "replay = {folder}/home/gone: there is nothing of this name"),
        ("reconstruction: {object_library: gone.npz}", "reconstruction: object_library = {folder}/gone.npz: cannot be"),
        ("reconstruction: {force_response: .}", "reconstruction: force_response = {folder}: not a regular file"),
        (
            "reconstruction: {method: per_frame, dictionary: /gone}",
            "reconstruction: dictionary = /gone: cannot be read (No such file",
        ),
        ("driver: {model: a/gone.npz}", "driver: model = {folder}/a/gone.npz: cannot be read (No such file"),
    ],
)
def test_a_file_that_is_missing_is_refused_with_its_place_before_anything_starts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str, words: str
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    path = skins_yaml(tmp_path, TWO.replace('port: "serial:2"', text))
    with pytest.raises(SettingsError) as caught:
        plan(path, simulated=True)
    assert f"skins.yaml:4: skin right: {words.format(folder=tmp_path)}" in str(caught.value)


def test_taxels_too_large_for_a_simulated_ball_are_refused_with_their_place_before_anything_starts(
    tmp_path: Path,
) -> None:
    path = skins_yaml(tmp_path, TWO.replace("m: 64", "\n    row_pitch_m: 0.2"))
    with pytest.raises(SettingsError, match=r"skins\.yaml:5: skin right: row_pitch_m = 0\.2: allowed is .*recording"):
        plan(path, simulated=True)
    assert list(plan(path, simulated=False)) == ["left/tactile", "right/tactile"]


def test_a_calibration_and_what_is_no_file_may_be_missing(tmp_path: Path) -> None:
    further = "driver: {calibration_file: new.npz, model: none}, reconstruction: {object_library: ''}"
    commands = plan(
        skins_yaml(tmp_path, TWO.replace('port: "serial:2"', f'port: "serial:2", {further}')), simulated=True
    )
    assert f"driver.calibration_file={tmp_path}/new.npz" in commands["right/tactile"]
