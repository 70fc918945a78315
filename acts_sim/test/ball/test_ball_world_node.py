# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node over real DDS, with a fake robot writing joints; ROS_DOMAIN_IDs 79, 100, 101 and 103."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped
from peers import Peers
from std_srvs.srv import Trigger

from acts_core.errors import REFUSED_EXIT_CODE, SettingsError
from acts_core.robots import ur5e
from acts_core.skin import ForceResponse
from acts_ros import qos
from acts_sim.ball.ball_world_node import BallWorldSettings, way_back
from acts_sim.shared import JOINT_RING_WIDTH, TimedRingReader, TimedRingWriter

pytestmark = pytest.mark.slow

DEADLINE_S = 40.0


class Observer(Peers):
    """What a demo sees of the node."""

    timeout_s = DEADLINE_S

    def __init__(self, domain_id: int) -> None:
        super().__init__(domain_id, "observer")
        self.truth = self.listen(PointStamped, "/plate/ball/truth", qos.STATE)
        self.reports: list[tuple[bytes, str, dict[str, str]]] = []
        self.peer.create_subscription(DiagnosticArray, "/diagnostics", self._on_diagnostics, 10)

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            assert status.name == "plate/ball_world"
            self.reports.append((status.level, status.message, {item.key: item.value for item in status.values}))

    def situation(self) -> str:
        return f"last reports {self.reports[-2:]}"

    def until_reported(self, level: bytes, words: str) -> dict[str, str]:
        seen = len(self.reports)
        found: list[dict[str, str]] = []

        def reported() -> bool:
            found[:] = [values for at, message, values in self.reports[seen:] if at == level and words in message]
            return bool(found)

        self.until(reported, what=f"a report of {words!r}")
        return found[-1]


@contextmanager
def world(domain_id: int, folder: Path, *parameters: str) -> Iterator[subprocess.Popen[str]]:
    arguments = [f"field_ring:={folder / 'run' / 'field.ring'}", f"joint_ring:={folder / 'joints.ring'}", *parameters]
    command = [
        sys.executable,
        "-m",
        "acts_ros.executables.program",
        "acts_sim.ball.ball_world_node",
        "--ros-args",
        "-r",
        "__ns:=/plate",
    ]
    for argument in arguments:
        command += ["-p", argument]
    environment = {**os.environ, "ROS_DOMAIN_ID": str(domain_id), "ROS_PYTHON_CHECK_FIELDS": "1"}
    process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


@pytest.fixture
def observer(request: pytest.FixtureRequest) -> Iterator[Observer]:
    observer = Observer(request.param)
    yield observer
    observer.close()


def tilted(tilt_y_rad: float) -> np.ndarray:
    q_rad = np.array(ur5e.LEVEL_Q_RAD)
    q_rad[3], q_rad[4] = ur5e.wrist_angles_for_tilt(ur5e.LEVEL_Q_RAD, 0.0, tilt_y_rad)
    return np.concatenate([q_rad, np.zeros(6)])


def newest_in(reader: TimedRingReader) -> tuple[int, np.ndarray]:
    newest = reader.newest()
    assert newest is not None
    return newest


@pytest.mark.parametrize("observer", [100], indirect=True)
def test_the_ball_follows_the_joints_and_presses_the_field(observer: Observer, tmp_path: Path) -> None:
    with world(100, tmp_path, "start_after_s:=0.5", "replace_after_s:=0.2") as process:
        # No robot yet: said, and the plate is level, so the ball stays where it was put.
        observer.until_reported(b"\x01", "there is no joint ring")
        observer.until(lambda: len(observer.truth) > 10)
        message = observer.truth[-1]
        assert message.header.frame_id == "plate"
        assert (message.point.x, message.point.y, message.point.z) == (0.020, -0.015, 0.0)
        stamp_s = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
        assert abs(stamp_s - time.time()) < DEADLINE_S

        # The field: in the near future, with the weight and the place of the ball.
        reader = TimedRingReader(tmp_path / "run" / "field.ring", 1024)
        observer.until(lambda: newest_in(reader)[0] > time.monotonic_ns())
        field_n = ForceResponse().force_n(newest_in(reader)[1]).reshape(32, 32)
        assert field_n.sum() == pytest.approx(5.0, abs=0.3)
        assert (field_n.sum(axis=0) * (np.arange(32) - 15.5)).sum() / field_n.sum() * 0.004375 == pytest.approx(
            0.020, abs=0.0003
        )

        # A robot that tilts the plate: the ball rolls the right way and off; level again, it is put back.
        with TimedRingWriter(tmp_path / "joints.ring", JOINT_RING_WIDTH) as joints:

            def robot(values: np.ndarray, condition: Callable[[], bool]) -> Callable[[], bool]:
                def done() -> bool:
                    joints.write(time.monotonic_ns(), values)
                    return condition()

                return done

            seen = len(observer.truth)
            observer.until(robot(tilted(0.06), lambda: observer.truth[-1].point.x > 0.06), what="a roll")
            x_m = [message.point.x for message in observer.truth[seen:]]
            assert x_m == sorted(x_m)
            observer.until(robot(tilted(0.06), lambda: observer.reports[-1][2]["falls"] == "1"), what="a fall")
            level = tilted(0.0)
            observer.until(robot(level, lambda: abs(observer.truth[-1].point.x - 0.020) < 1e-6), what="its return")
            observer.until(robot(level, lambda: observer.reports[-1][0] == b"\x00"), what="no complaint")
            assert observer.reports[-1][2]["joints"] == "following the robot"

            # Joints of NaN are refused.
            bad = np.full(JOINT_RING_WIDTH, np.nan)
            observer.until(robot(bad, lambda: "NaN" in observer.reports[-1][1]), what="a report of NaN")
            assert observer.reports[-1][0] == b"\x02"
            assert int(observer.reports[-1][2]["joints_refused"]) > 0
            assert np.isfinite(newest_in(reader)[1]).all()
            observer.until(robot(level, lambda: observer.reports[-1][0] == b"\x00"), what="no complaint")

        # The robot ends and removes its ring, then another one starts in its place.
        observer.until_reported(b"\x01", "the robot has stopped writing its joints")
        with TimedRingWriter(tmp_path / "joints.ring", JOINT_RING_WIDTH) as joints:
            observer.until(robot(level, lambda: observer.reports[-1][0] == b"\x00"), what="no complaint")

        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=20)
        assert process.returncode == 0
        assert "Traceback" not in errors
        assert not (tmp_path / "run" / "field.ring").exists()


def test_one_file_for_both_rings_is_refused() -> None:
    with pytest.raises(SettingsError, match=r"field_ring and joint_ring are both /tmp/a\.ring"):
        BallWorldSettings(field_ring="/tmp/a.ring", joint_ring="/tmp/a.ring")


@pytest.mark.parametrize(
    ("parameter", "message"),
    [
        ("diametre_m:=0.05", "unknown key 'diametre_m'; did you mean 'diameter_m'?"),
        ("rows:=0", "rows = 0: allowed is 1 to 64"),
        ("diameter_m:=.nan", "diameter_m = nan: allowed is a finite number"),
        ("truth_period_s:=0.003", "truth_period_s = 0.003: allowed are whole steps of 0.002 s"),
        ("field_ring:=/proc/nothing/field.ring", "the folder /proc/nothing cannot be made"),
    ],
)
def test_a_wrong_parameter_ends_it_with_one_clear_line(tmp_path: Path, parameter: str, message: str) -> None:
    with world(101, tmp_path, parameter) as process:
        _, errors = process.communicate(timeout=40)
        assert process.returncode == REFUSED_EXIT_CODE
        assert message in errors
        assert "Traceback" not in errors


FAILING = """
import sys
from acts_sim.ball import ball_world_node
from acts_sim.ball.world import World

def step(self, joints, dt_s):
    raise ZeroDivisionError("by mistake")

World.step = step
sys.argv[1:] = ["--ros-args", "-p", f"field_ring:={sys.argv[1]}/field.ring"]
sys.exit(ball_world_node.main())
"""


def test_a_world_that_fails_ends_the_node(tmp_path: Path) -> None:
    environment = {**os.environ, "ROS_DOMAIN_ID": "79", "ROS_PYTHON_CHECK_FIELDS": "1"}
    finished = subprocess.run(
        [sys.executable, "-c", FAILING, str(tmp_path)], env=environment, capture_output=True, text=True, timeout=60
    )
    assert finished.returncode == 1
    assert "error: the world has stopped: ZeroDivisionError('by mistake')" in finished.stderr
    assert not (tmp_path / "field.ring").exists()


INTERRUPTED = """
import signal, sys
from acts_core.stop_signals import StopSignals
from acts_sim.ball import ball_world_node

def interrupted(*arguments, **named):
    signal.raise_signal(signal.SIGINT)
    raise AssertionError("it was not interrupted")

folder, name = sys.argv[1:]
setattr(ball_world_node, name, interrupted)
words = ["--ros-args", "-p", f"field_ring:={folder}/field.ring"]
sys.exit(ball_world_node.main(StopSignals(), [sys.argv[0], *words]))
"""


# What is made last before the node begins, which compiles, and what is made before it.
@pytest.mark.parametrize("name", ["World", "DiagnosticsReporter"])
def test_a_world_that_is_interrupted_while_it_starts_leaves_nothing(tmp_path: Path, name: str) -> None:
    environment = {**os.environ, "ROS_DOMAIN_ID": "79", "ROS_PYTHON_CHECK_FIELDS": "1"}
    finished = subprocess.run(
        [sys.executable, "-c", INTERRUPTED, str(tmp_path), name],
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert finished.returncode == 0, finished.stderr
    assert not list(tmp_path.iterdir())


SLOW_TO_COMPILE = """
import sys
from acts_sim.ball import ball_world_node

class Slow(ball_world_node.World):
    def __init__(self, settings):
        sys.stdin.read()  # until the test has seen what it waits for
        super().__init__(settings)

ball_world_node.World = Slow
words = ["--ros-args", "-r", "__ns:=/plate", "-p", f"field_ring:={sys.argv[1]}/field.ring", "-p", "joint_ring:=none"]
sys.exit(ball_world_node.main(args=[sys.argv[0], *words]))
"""


@pytest.mark.parametrize("observer", [103], indirect=True)
def test_that_it_compiles_is_told_while_it_does(observer: Observer, tmp_path: Path) -> None:
    environment = {**os.environ, "ROS_DOMAIN_ID": "103", "ROS_PYTHON_CHECK_FIELDS": "1"}
    log = tmp_path / "log"
    with (
        log.open("w") as file,
        subprocess.Popen(
            [sys.executable, "-c", SLOW_TO_COMPILE, str(tmp_path)], env=environment, stdin=subprocess.PIPE, stderr=file
        ) as process,
    ):
        try:
            observer.until_reported(b"\x01", "compiling: this takes long")
            observer.until(lambda: "compiling: this takes long" in log.read_text(), what="a line in the log")
            assert process.stdin is not None
            process.stdin.close()
            observer.until_reported(b"\x00", "the ball is")
        finally:
            process.kill()


@pytest.mark.parametrize("observer", [103], indirect=True)
def test_without_a_robot_nothing_is_amiss(observer: Observer, tmp_path: Path) -> None:
    with world(103, tmp_path, "joint_ring:=none"):
        values = observer.until_reported(b"\x00", "the ball is")
        assert values["joints"] == "there is no robot"
        observer.until(lambda: len(observer.truth) > 10)


@pytest.mark.parametrize(
    ("replace_after_s", "words"),
    [("0.0", "start ball_world anew to put it back (replace_after_s is 0)"), ("9.0", "put back after 9 s")],
)
@pytest.mark.parametrize("observer", [103], indirect=True)
def test_a_ball_that_has_fallen_off_is_told_with_how_it_comes_back(
    observer: Observer, tmp_path: Path, replace_after_s: str, words: str
) -> None:
    pushed = ("push_speed_m_s:=2.0", "push_period_s:=0.05", f"replace_after_s:={replace_after_s}")
    with world(103, tmp_path, "joint_ring:=none", "start_after_s:=0.0", *pushed):
        observer.until_reported(b"\x01", f"the ball has fallen off the plate: {words}")
        put_back = observer.peer.create_client(Trigger, "/plate/ball_world/put_back")
        observer.until(put_back.service_is_ready)
        seen, answer = len(observer.truth), put_back.call_async(Trigger.Request())
        observer.until(lambda: answer.done() and len(observer.truth) > seen)
        assert answer.result().success, answer.result().message


@pytest.mark.parametrize(
    ("replace_after_s", "fallen_s", "words"),
    [(0.0, 100.0, "anew"), (2.0, 1.9, "after 2 s"), (2.0, 2.1, "once the plate is level and still")],
)
def test_a_ball_whose_time_is_over_waits_for_the_plate(replace_after_s: float, fallen_s: float, words: str) -> None:
    assert words in way_back(replace_after_s, fallen_s)
