# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""One skin, board and robot, launched for real: topics, faults, orderly end. ROS_DOMAIN_ID 35, 90 to 95 and 99."""

import os
import re
import select
import socket
from pathlib import Path

import numpy as np
import pytest
from ament_index_python.packages import get_package_share_directory
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped
from launch_support import LONG_S, PACKAGE, START_S
from pressed_frames import disc_recording
from sensor_msgs.msg import Image

from acts_core.array import ArrayGeometry
from acts_core.frames import SampleFrame, Scheme
from acts_core.wire import StreamDecoder
from acts_msgs.msg import Contact, TactileSamples
from acts_tools.testing.launch_runner import HAS_LAUNCH_PYTEST, Launched, LaunchFile, launch_fixture, launch_test

pytestmark = pytest.mark.slow


def test_every_launch_file_is_tested() -> None:
    folder = Path(get_package_share_directory(PACKAGE)) / "launch"
    names = {path.name for path in folder.glob("*.launch.xml")}
    assert names
    tests = "".join(path.read_text() for path in Path(__file__).parent.glob("test_launch_*.py"))
    used = set(re.findall(r'PACKAGE, "([a-z_]+\.launch\.xml)"', tests))
    assert used == names


@launch_fixture
def tactile(tmp_path: Path) -> LaunchFile:
    arguments = {
        "run_dir": str(tmp_path / "run"),
        "recording": str(disc_recording(tmp_path)),
        "recording_rate_hz": "30",
    }
    return LaunchFile(PACKAGE, "tactile.launch.xml", 90, arguments)


@launch_test(tactile)
def test_a_pressed_disc_becomes_a_contact_where_it_is(tactile: Launched, tmp_path: Path) -> None:
    contact = tactile.wait_for_messages("/plate/contact", Contact, 50, START_S)[-1]
    geometry = ArrayGeometry()
    assert contact.header.frame_id == "plate"
    assert contact.in_contact
    assert contact.centre_of_pressure.x == pytest.approx(float(geometry.x_m(24)), abs=geometry.pitch_m / 4)
    assert contact.centre_of_pressure.y == pytest.approx(float(geometry.y_m(8)), abs=geometry.pitch_m / 4)
    samples = tactile.wait_for_messages("/plate/samples", TactileSamples, 200)
    assert {len(message.indices) for message in samples} == {55}
    assert {message.scheme for message in samples} == {TactileSamples.SCHEME_TRACKING}
    image = tactile.wait_for_message("/plate/image_raw", Image)
    assert (image.height, image.width, image.encoding) == (32, 32, "mono16")
    assert tactile.wait_for_message("/plate/image", Image).height % 32 == 0
    assert tactile.wait_for_message("/plate/cop", PointStamped).header.frame_id == "plate"
    assert tactile.stop() == 0
    assert not os.path.lexists(tmp_path / "run" / "board")


@launch_fixture
def replayed(tmp_path: Path) -> LaunchFile:
    np.savez(tmp_path / "disc.npz", frames=np.load(disc_recording(tmp_path)), rate_hz=30.0)
    arguments = {"run_dir": str(tmp_path / "run"), "replay": str(tmp_path / "disc.npz")}
    return LaunchFile(PACKAGE, "tactile.launch.xml", 35, arguments)


@launch_test(replayed)
def test_a_replayed_recording_needs_no_board(replayed: Launched, tmp_path: Path) -> None:
    assert replayed.wait_for_messages("/plate/contact", Contact, 50, START_S)[-1].in_contact
    assert not os.path.lexists(tmp_path / "run" / "board")
    assert replayed.stop() == 0


@launch_fixture
def chest(tmp_path: Path) -> LaunchFile:
    arguments = {
        "run_dir": str(tmp_path / "run"),
        "recording": str(disc_recording(tmp_path)),
        "namespace": "chest/left",
        "ball": "false",
        "protocol": "raster_ascii",
    }
    return LaunchFile(PACKAGE, "tactile.launch.xml", 91, arguments)


@launch_test(chest)
def test_the_published_raster_sketch_on_another_skin(chest: Launched) -> None:
    samples = chest.wait_for_messages("/chest/left/samples", TactileSamples, 5, START_S)
    assert {message.scheme for message in samples} == {int(Scheme.RASTER)}
    assert {len(message.counts) for message in samples} == {1024}
    contact = chest.wait_for_message("/chest/left/contact", Contact)
    assert contact.in_contact
    # A frame of tf2 does not begin with a slash, and this one has none at all.
    assert {contact.header.frame_id, samples[0].header.frame_id} == {"chest_left"}
    assert chest.stop() == 0


@launch_fixture
def rolling(tmp_path: Path) -> LaunchFile:
    return LaunchFile(PACKAGE, "tactile.launch.xml", 99, {"run_dir": str(tmp_path / "run")})


@launch_test(rolling)
def test_without_arguments_a_ball_is_felt(rolling: Launched) -> None:
    rolling.wait_for_message("/plate/contact", Contact, START_S, lambda contact: contact.in_contact)
    assert rolling.stop() == 0


@launch_fixture
def no_board(tmp_path: Path) -> LaunchFile:
    return LaunchFile(PACKAGE, "tactile.launch.xml", 92, {"sim": "false", "port": str(tmp_path / "missing_port")})


@launch_test(no_board)
def test_a_missing_board_is_reported_and_waited_for(no_board: Launched) -> None:
    def complains(report: DiagnosticArray) -> bool:
        return any(status.name == "plate/driver" and status.level == b"\x02" for status in report.status)

    no_board.wait_for_message("/diagnostics", DiagnosticArray, START_S, complains)
    no_board.wait_for_output("missing_port", START_S)
    assert no_board.stop() == 0


@launch_fixture
def wrong_parameters(tmp_path: Path) -> LaunchFile:
    path = tmp_path / "params.yaml"
    path.write_text("/**/driver:\n  ros__parameters:\n    porrt: /dev/ttyACM0\n")
    return LaunchFile(PACKAGE, "tactile.launch.xml", 93, {"run_dir": str(tmp_path / "run"), "params_file": str(path)})


@launch_test(wrong_parameters)
def test_a_misspelt_parameter_is_named_and_ends_the_launch(wrong_parameters: Launched) -> None:
    wrong_parameters.wait_for_output("did you mean 'port'", START_S)
    # `ros2 launch` would start the process again and again: it stays.
    wrong_parameters.wait_for_output("refuses what it was given", LONG_S)
    assert ("does nothing" in wrong_parameters.output) == HAS_LAUNCH_PYTEST
    # The real launch numbers the processes of all tests in one row.
    assert len(re.findall(r"\[tactile-\d+\]: process started", wrong_parameters.output)) == 1
    assert wrong_parameters.stop() == 1


@launch_fixture
def board(tmp_path: Path) -> LaunchFile:
    return LaunchFile(PACKAGE, "simulated_board.launch.xml", 94, {"run_dir": str(tmp_path / "run"), "m": "64"})


@launch_test(board)
def test_the_simulated_board_speaks_on_its_port(board: Launched, tmp_path: Path) -> None:
    port = tmp_path / "run" / "board"
    board.wait_for(port.exists, START_S, "the board's port")
    decoder = StreamDecoder()
    frames: list[SampleFrame] = []

    def enough() -> bool:
        if select.select([descriptor], [], [], 0.1)[0]:
            frames.extend(decoder.feed(os.read(descriptor, 4096)))
        return len(frames) >= 20

    descriptor = os.open(port, os.O_RDONLY | os.O_NOCTTY)
    try:
        board.wait_for(enough, LONG_S, "20 frames")
    finally:
        os.close(descriptor)
    assert {len(frame.indices) for frame in frames} == {64}
    assert board.stop() == 0
    assert not os.path.lexists(port)


@launch_fixture
def robot(tmp_path: Path) -> LaunchFile:
    arguments = {"run_dir": str(tmp_path / "run"), "robot_ip": "127.0.6.1"}
    return LaunchFile(PACKAGE, "simulated_robot.launch.xml", 95, arguments)


@launch_test(robot)
def test_the_simulated_robot_listens_and_the_ball_lies_on_the_plate(robot: Launched) -> None:
    truth = robot.wait_for_message("/ball/truth", PointStamped, START_S)
    assert abs(truth.point.x) < 0.07
    for port in (29999, 30003, 30004):
        with socket.create_connection(("127.0.6.1", port), timeout=10):
            pass
    assert robot.stop() == 0


def test_the_back_end_is_the_one_for_this_machine() -> None:
    # One body of tests: where launch_pytest is installed it has to be the one that runs them.
    try:
        import launch_pytest  # noqa: F401
    except ImportError:
        assert not HAS_LAUNCH_PYTEST
    else:
        assert HAS_LAUNCH_PYTEST
