"""Every launch file, started for real: processes, topics, faults, orderly end. ROS_DOMAIN_ID 90 to 99, 168 and 169."""

import os
import re
import select
import signal
import socket
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from ament_index_python.packages import get_package_share_directory
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PointStamped, TransformStamped
from sensor_msgs.msg import Image

from acts_core.array import ArrayGeometry
from acts_core.frames import SampleFrame, Scheme
from acts_core.wire import StreamDecoder
from acts_msgs.msg import BalanceStatus, Contact, SkinContacts, SkinState, TactileSamples
from acts_tools.testing.launch_runner import HAS_LAUNCH_PYTEST, Launched, LaunchFile, launch_fixture, launch_test

PACKAGE = "acts_bringup"
# Numba compiles in the first process that needs a kernel; on a busy machine that takes its time.
START_S = 90.0
LONG_S = 60.0


def pid_of(launched: Launched, executable: str) -> int:
    """Process id of a node, from the launch's own words."""
    found = re.findall(rf"\[{executable}-\d+\]: process started with pid \[(\d+)\]", launched.output)
    assert found, f"{executable} was not started"
    return int(found[-1])


def disc_recording(folder: Path) -> Path:
    """A recording of a disc of 21 taxels pressed at rest, off the centre, where 55 samples see all of it."""
    rows, cols = np.mgrid[:32, :32]
    disc = np.where(np.hypot(rows - 8, cols - 24) < 2.6, 700, 0).astype(np.uint16)
    path = folder / "disc.npy"
    np.save(path, np.repeat(disc[np.newaxis], 4, axis=0))
    return path


def test_every_launch_file_is_tested_here() -> None:
    folder = Path(get_package_share_directory(PACKAGE)) / "launch"
    names = {path.name for path in folder.glob("*.launch.xml")}
    assert names
    used = set(re.findall(r'PACKAGE, "([a-z_]+\.launch\.xml)"', Path(__file__).read_text()))
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
        "namespace": "chest_left",
        "ball": "false",
        "protocol": "raster_ascii",
    }
    return LaunchFile(PACKAGE, "tactile.launch.xml", 91, arguments)


@launch_test(chest)
def test_the_published_raster_sketch_on_another_skin(chest: Launched) -> None:
    samples = chest.wait_for_messages("/chest_left/samples", TactileSamples, 5, START_S)
    assert {message.scheme for message in samples} == {int(Scheme.RASTER)}
    assert {len(message.counts) for message in samples} == {1024}
    assert chest.wait_for_message("/chest_left/contact", Contact).in_contact
    assert chest.stop() == 0


@launch_fixture
def rolling(tmp_path: Path) -> LaunchFile:
    return LaunchFile(PACKAGE, "tactile.launch.xml", 99, {"run_dir": str(tmp_path / "run")})


@launch_test(rolling)
def test_without_arguments_a_ball_is_felt(rolling: Launched) -> None:
    def felt() -> bool:
        return bool(rolling.wait_for_message("/plate/contact", Contact, START_S).in_contact)

    rolling.wait_for(felt, START_S, "contact with the ball")
    assert rolling.stop() == 0


@launch_fixture
def no_board(tmp_path: Path) -> LaunchFile:
    return LaunchFile(PACKAGE, "tactile.launch.xml", 92, {"sim": "false", "port": str(tmp_path / "missing_port")})


@launch_test(no_board)
def test_a_missing_board_is_reported_and_waited_for(no_board: Launched) -> None:
    def complaint() -> str:
        for status in no_board.wait_for_message("/diagnostics", DiagnosticArray, START_S).status:
            if status.name == "plate/driver" and status.level == b"\x02":
                return str(status.message)
        return ""

    no_board.wait_for(lambda: bool(complaint()), START_S, "an error in the driver's diagnostics")
    no_board.wait_for_output("missing_port", START_S)
    assert no_board.stop() == 0


@launch_fixture
def wrong_parameters(tmp_path: Path) -> LaunchFile:
    path = tmp_path / "params.yaml"
    path.write_text("/**/driver:\n  ros__parameters:\n    porrt: /dev/ttyACM0\n")
    return LaunchFile(PACKAGE, "tactile.launch.xml", 93, {"run_dir": str(tmp_path / "run"), "params_file": str(path)})


@launch_test(wrong_parameters)
def test_a_misspelt_parameter_is_named_and_nothing_else_suffers(wrong_parameters: Launched) -> None:
    wrong_parameters.wait_for_output("porrt", START_S)
    assert "did you mean 'port'" in wrong_parameters.output
    # The driver is started again and again; what does not need it goes on.
    wrong_parameters.wait_for_publisher("/plate/contact", START_S)
    wrong_parameters.stop()


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


def patient_parameters(folder: Path) -> str:
    """The shipped parameters, for a busy machine: late touch or a late robot level the plate but do not end the run."""
    path = folder / "patient.yaml"
    shipped = Path(get_package_share_directory("acts_config")) / "params" / "ball_balancing.yaml"
    limits = "{touch_stop_after_s: 10.0, robot_stale_after_s: 2.0}"
    path.write_text(f"{shipped.read_text()}\n/**/ball_control:\n  ros__parameters: {limits}\n")
    return str(path)


@launch_fixture
def balancing(tmp_path: Path) -> LaunchFile:
    arguments = {"run_dir": str(tmp_path / "run"), "robot_ip": "127.0.6.2", "trajectory": "hold"}
    arguments["params_file"] = patient_parameters(tmp_path)
    return LaunchFile(PACKAGE, "ball_balancing.launch.xml", 96, arguments)


def test_without_sim_false_no_robot_of_another_address_is_moved(tmp_path: Path) -> None:
    def started(*words: str) -> str:
        command = [sys.executable, "-m", "acts_tools", "launch", "--own", "--print", PACKAGE]
        return subprocess.run(
            [*command, "ball_balancing.launch.xml", f"run_dir:={tmp_path}", *words],
            capture_output=True,
            text=True,
            timeout=60,
            check=True,
        ).stdout

    for composed in ("true", "false"):
        assert "acts_control" not in started("robot_ip:=192.168.1.10", f"composed:={composed}")
        assert "acts_control" in started("robot_ip:=127.0.6.5", f"composed:={composed}")
        assert "acts_control" in started("robot_ip:=192.168.1.10", f"composed:={composed}", "sim:=false")


def wait_for_state(launched: Launched, state: int, timeout_s: float) -> BalanceStatus:
    """Wait until the controller reports a state."""
    statuses: list[BalanceStatus] = []

    def reached() -> bool:
        statuses.append(launched.wait_for_message("/plate/ball/status", BalanceStatus, START_S))
        return statuses[-1].state == state

    launched.wait_for(reached, timeout_s, f"state {state} of the controller")
    return statuses[-1]


@launch_test(balancing)
def test_the_ball_is_brought_to_the_centre_and_the_end_is_orderly(balancing: Launched) -> None:
    wait_for_state(balancing, BalanceStatus.STATE_BALANCING, START_S)

    def centred() -> bool:
        truth = balancing.wait_for_message("/plate/ball/truth", PointStamped).point
        return float(np.hypot(truth.x, truth.y)) < 0.005

    balancing.wait_for(centred, LONG_S, "the ball within 5 mm of the centre")
    assert balancing.stop() == 0


@launch_fixture
def separate(tmp_path: Path) -> LaunchFile:
    arguments = {
        "run_dir": str(tmp_path / "run"),
        "robot_ip": "127.0.6.3",
        "trajectory": "hold",
        "composed": "false",
        "params_file": patient_parameters(tmp_path),
    }
    return LaunchFile(PACKAGE, "ball_balancing.launch.xml", 97, arguments)


@launch_test(separate)
def test_in_separate_processes_a_lost_board_ends_motion_level(separate: Launched) -> None:
    wait_for_state(separate, BalanceStatus.STATE_BALANCING, START_S)
    os.kill(pid_of(separate, "virtual_board"), signal.SIGKILL)

    def level() -> bool:
        status = separate.wait_for_message("/plate/ball/status", BalanceStatus)
        tilted = max(abs(status.tilt_measured.x), abs(status.tilt_measured.y))
        return status.state != BalanceStatus.STATE_BALANCING and tilted < 0.002

    separate.wait_for(level, LONG_S, "a level plate")
    assert separate.stop() == 1  # the board died


@launch_fixture
def robot_lost(tmp_path: Path) -> LaunchFile:
    arguments = {"run_dir": str(tmp_path / "run"), "robot_ip": "127.0.6.4", "trajectory": "hold"}
    arguments["params_file"] = patient_parameters(tmp_path)
    return LaunchFile(PACKAGE, "ball_balancing.launch.xml", 98, arguments)


@launch_test(robot_lost)
def test_a_lost_robot_stops_the_controller_with_a_reason(robot_lost: Launched) -> None:
    wait_for_state(robot_lost, BalanceStatus.STATE_BALANCING, START_S)
    os.kill(pid_of(robot_lost, "ur_controller"), signal.SIGKILL)
    status = wait_for_state(robot_lost, BalanceStatus.STATE_STOPPED, LONG_S)
    assert "127.0.6.4" in status.reason or "robot" in status.reason
    assert robot_lost.stop() == 1  # the robot died


def skins_file(folder: Path) -> Path:
    """Two skins that feel the same disc, the second a metre above the first and upside down."""
    disc = disc_recording(folder)
    source = f"recording: {disc}, recording_rate_hz: 30"
    path = folder / "skins.yaml"
    path.write_text(
        "base_frame: torso\nskins:\n"
        f"  low: {{{source}, pose: {{parent: torso}}}}\n"
        f"  high: {{{source}, pose: {{parent: torso, position_m: [0, 0, 1], quaternion_xyzw: [1, 0, 0, 0]}}}}\n"
    )
    return path


@launch_fixture
def two_skins(tmp_path: Path) -> LaunchFile:
    arguments = {"run_dir": str(tmp_path / "run"), "skins_file": str(skins_file(tmp_path))}
    return LaunchFile(PACKAGE, "skins.launch.xml", 168, arguments)


def merged(launched: Launched, low: int, high: int) -> SkinContacts:
    """Wait for merged contacts with these states of the skins."""
    messages: list[SkinContacts] = []

    def reached() -> bool:
        messages.append(launched.wait_for_message("/skin_contacts", SkinContacts, START_S))
        states = {skin.name: skin.state for skin in messages[-1].skins}
        skins = {contact.skin for contact in messages[-1].contacts}
        felt = {name for name, state in (("low", low), ("high", high)) if state == SkinState.STATE_FRESH}
        return states == {"low": low, "high": high} and skins == felt

    launched.wait_for(reached, START_S, f"skins in the states {low} and {high}")
    return messages[-1]


def skin_pid(launched: Launched, label: str) -> int:
    return int(re.findall(rf"\[{label}\]: process started with pid \[(\d+)\]", launched.output)[-1])


@launch_test(two_skins)
def test_skins_are_merged_and_a_lost_one_leaves_the_other_alone(two_skins: Launched, tmp_path: Path) -> None:
    fresh, lost = SkinState.STATE_FRESH, SkinState.STATE_LOST
    message = merged(two_skins, fresh, fresh)
    geometry = ArrayGeometry()
    x_m, y_m, close_m = float(geometry.x_m(24)), float(geometry.y_m(8)), geometry.pitch_m / 4
    assert message.header.frame_id == "torso"
    for contact in message.contacts:
        sign, z_m = (1, 0.0) if contact.skin == "low" else (-1, 1.0)
        assert contact.position.x == pytest.approx(x_m, abs=close_m)
        assert contact.position.y == pytest.approx(sign * y_m, abs=close_m)
        assert contact.position.z == pytest.approx(z_m, abs=1e-9)
        assert contact.force.z * sign < -0.5
    pose = two_skins.wait_for_message("/high/pose", TransformStamped)
    assert (pose.header.frame_id, pose.child_frame_id, pose.transform.translation.z) == ("torso", "high", 1.0)

    # Its board vanishes, and is there again.
    os.kill(skin_pid(two_skins, "high/virtual_board"), signal.SIGKILL)
    assert merged(two_skins, fresh, lost).header.frame_id == "torso"
    merged(two_skins, fresh, fresh)
    # The whole skin does.
    os.kill(skin_pid(two_skins, "low/tactile"), signal.SIGKILL)
    merged(two_skins, lost, fresh)
    merged(two_skins, fresh, fresh)

    def all_well() -> bool:
        whole = two_skins.wait_for_message("/diagnostics_toplevel_state", DiagnosticStatus, START_S)
        return bool(whole.level == DiagnosticStatus.OK and whole.message == "2 skins, all well")

    two_skins.wait_for(all_well, START_S, "an aggregate that is well again")
    assert two_skins.stop() == 0
    assert not [path for path in (tmp_path / "run").rglob("*") if not path.is_dir()]


@launch_fixture
def missing_skins(tmp_path: Path) -> LaunchFile:
    text = skins_file(tmp_path).read_text().replace("{recording", f"{{port: {tmp_path}/PORT, recording")
    for name in ("low", "high"):
        text = text.replace("PORT", name, 1)
    (tmp_path / "skins.yaml").write_text(text)
    arguments = {"skins_file": str(tmp_path / "skins.yaml"), "sim": "false", "merge": "false"}
    return LaunchFile(PACKAGE, "skins.launch.xml", 169, arguments)


@launch_test(missing_skins)
def test_skins_whose_boards_are_missing_are_named_in_the_aggregate(missing_skins: Launched) -> None:
    def complaint() -> str:
        return str(missing_skins.wait_for_message("/diagnostics_toplevel_state", DiagnosticStatus, START_S).message)

    missing_skins.wait_for(
        lambda: "low: driver: " in complaint() and "high: driver: " in complaint(), START_S, "both skins in trouble"
    )
    assert missing_skins.stop() == 0


def test_the_back_end_is_the_one_for_this_machine() -> None:
    # One body of tests: where launch_pytest is installed it has to be the one that runs them.
    try:
        import launch_pytest  # noqa: F401
    except ImportError:
        assert not HAS_LAUNCH_PYTEST
    else:
        assert HAS_LAUNCH_PYTEST
