# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What users write behind `name:=` reaches the processes as it stands, whatever it holds. Nothing is started."""

from __future__ import annotations

import itertools
import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from ament_index_python.packages import get_package_share_directory
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from launch_support import PACKAGE

from acts_control.robots import ROBOTS
from acts_core.errors import LaunchError
from acts_core.settings import describe
from acts_driver.protocols import PROTOCOLS
from acts_driver.settings import DriverSettings
from acts_recon.methods import METHODS
from acts_ros.composition import IN_PARAMS_FILE
from acts_ros.executables.standby import STANDBY_WORD
from acts_sim.hand import HandWorldConfig
from acts_tools.launch.evaluate import Plan, declarations, evaluate
from acts_tools.launch.parser import parse_file

pytestmark = pytest.mark.slow

FILES = sorted((Path(get_package_share_directory(PACKAGE)) / "launch").glob("*.launch.xml"))
TACTILE = next(file for file in FILES if file.name == "tactile.launch.xml")
PARAMS_ARGUMENT = '<arg name="params_file"'

# Arguments that take any text, by launch file.
TEXTS = {
    "tactile": ("port", "frame_id", "layout", "dictionary", "pitch", "recording", "replay", "run_dir", "cpu_affinity"),
    "ball_balancing": ("port", "robot_ip", "trajectory", "frame_id", "dictionary", "pitch", "run_dir", "cpu_affinity"),
    "hand_reflexes": ("port", "hand_port", "hand", "reflexes", "layout", "seed", "run_dir", "cpu_affinity"),
    "skins": ("skins_file", "base_frame", "run_dir"),
    "simulated_board": ("recording", "run_dir", "cpu_affinity"),
    "simulated_hand": (
        "object_size",
        "object_mass",
        "object_x",
        "object_y",
        "layout",
        "seed",
        "run_dir",
        "cpu_affinity",
    ),
    "simulated_robot": ("robot_ip", "frame_id", "run_dir", "cpu_affinity"),
}
MEAN = (
    "it's",
    'a "quoted" name',
    "two  words ",
    "Prüfung ボール.npz",
    "back\\slash",
    "$(var sim)",
    "$(eval __import__('os').abort())",
    "' + str(__import__('os').abort()) + '",
    '" == "none" or __import__("os").abort() or "',
    "127.evil.example.com",
    "--help",
    "key: [value] # remark",
    "*",
)
STANDS_FOR = "any.text"

Printed = list[tuple[list[str], list[Any]]]


def printed(plan: Plan) -> Printed:
    """Command line of every process, and what its temporary params files hold instead of where they are."""
    return [
        (
            ["params" if Path(word) in process.parameter_files else word for word in process.command],
            [yaml.safe_load(path.read_text()) for path in process.parameter_files],
        )
        for process in plan.processes
    ]


def replaced(content: Any, text: str) -> Any:
    """The same with `STANDS_FOR` replaced in every text."""
    if isinstance(content, str):
        return content.replace(STANDS_FOR, text)
    if isinstance(content, dict):
        return {key: replaced(value, text) for key, value in content.items()}
    return type(content)(replaced(item, text) for item in content) if isinstance(content, (list, tuple)) else content


@pytest.fixture
def launch(tmp_path: Path) -> Callable[..., Printed]:
    numbers = itertools.count()

    def run(file: Path, **arguments: str) -> Printed:
        folder = tmp_path / str(next(numbers))
        folder.mkdir()
        return printed(evaluate(file, arguments, os.environ, folder))

    return run


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_no_launch_file_evaluates_code(file: Path) -> None:
    text = file.read_text()
    assert "$(eval" not in text
    assert "$(command" not in text


@pytest.mark.parametrize("composed", ["true", "false"])
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_any_text_of_an_argument_arrives_whole(launch: Callable[..., Printed], file: Path, composed: str) -> None:
    names = TEXTS[file.name.removesuffix(".launch.xml")]
    given = {"composed": composed} if '"composed"' in file.read_text() else {}
    # A port matters without a simulation, a recording where nothing is replayed.
    for sim, left_out in (("true", "replay"), ("false", "recording")):
        more = {**given, "sim": sim}
        arguments = [name for name in names if name != left_out]
        expected = launch(file, **dict.fromkeys(arguments, STANDS_FOR), **more)
        for text in MEAN:
            assert launch(file, **dict.fromkeys(arguments, text), **more) == replaced(expected, text), text
    for name in names:
        assert any(
            STANDS_FOR in repr(launch(file, **{name: STANDS_FOR}, **given, sim=sim)) for sim in ("true", "false")
        )


@pytest.mark.parametrize(
    ("name", "given", "without"),
    [
        ("tactile", {"port": "/dev/x", "view_port": "9000"}, {"port": "with sim:=true", "view_port": "view:=true"}),
        ("tactile", {"port": "/dev/x", "sim": "false", "view": "true", "view_port": "9000"}, {}),
        ("tactile", {"port": "/dev/x", "sim": "0", "replay": "a.npz"}, {"port": "with replay:=a.npz"}),
        ("tactile", {"run_dir": "/tmp/x", "sim": "false"}, {"run_dir": "with sim:=false"}),
        (
            "tactile",
            {"replay": "a.npz", "protocol": "binary", "run_dir": "/tmp/x"},
            {"protocol": "with replay:=a.npz", "run_dir": "with replay:=a.npz"},
        ),
        ("tactile", {"replay": "none", "protocol": "binary", "run_dir": "/tmp/x"}, {}),
        ("tactile", {"recording": "a.npy", "recording_rate_hz": "500", "run_dir": "/tmp/x"}, {}),
        ("tactile", {"recording_rate_hz": "500"}, {"recording_rate_hz": "without a recording"}),
        (
            "tactile",
            {"recording": "a.npy", "recording_rate_hz": "500", "replay": "a.npz"},
            {"recording": "no board is simulated", "recording_rate_hz": "no board is simulated"},
        ),
        ("tactile", {"replay": "none", "replay_speed": "2"}, {"replay_speed": "with replay:=none"}),
        ("tactile", {"replay": "a.npz", "replay_speed": "2", "replay_loop": "false"}, {}),
        ("tactile", {"scheme": "raster", "m": "5"}, {"m": "scheme:=raster, which measures all"}),
        ("tactile", {"scheme": "random", "m": "5", "threshold": "7"}, {"threshold": "scheme:=random"}),
        ("tactile", {"scheme": "tracking", "m": "5", "threshold": "7"}, {}),
        ("tactile", {"protocol": "raster_ascii", "m": "5"}, {"m": "with protocol:=raster_ascii"}),
        ("ball_balancing", {"port": "/dev/x", "view_port": "1"}, {"port": "sim:=true", "view_port": "view:=true"}),
        ("hand_reflexes", {"hand_port": "/dev/x", "object": "box", "seed": "2"}, {"hand_port": "with sim:=true"}),
        (
            "hand_reflexes",
            {"sim": "false", "object": "box", "seed": "2"},
            {"object": "sim:=false", "seed": "sim:=false"},
        ),
        ("skins", {"merge": "false", "base_frame": "a", "rate_hz": "7"}, {"base_frame": "merge", "rate_hz": "merge"}),
        ("skins", {"left_sole": "a", "right_sole": "b"}, {"left_sole": "gait:=true", "right_sole": "gait:=true"}),
        ("skins", {"sim": "false", "run_dir": "/tmp/x"}, {"run_dir": "with sim:=false"}),
        ("skins", {"gait": "true", "left_sole": "a", "base_frame": "a", "rate_hz": "7", "run_dir": "/tmp/x"}, {}),
    ],
)
def test_an_argument_that_has_no_effect_is_said(
    tmp_path: Path, name: str, given: dict[str, str], without: dict[str, str]
) -> None:
    messages = evaluate(TACTILE.with_name(f"{name}.launch.xml"), given, os.environ, tmp_path).messages
    assert [message.partition(":=")[0] for message in messages] == list(without)
    for message, (argument, why) in zip(messages, without.items(), strict=True):
        assert message.startswith(f"{argument}:={given[argument]} has no effect ")
        assert why in message


@pytest.mark.parametrize("sim", ["true", "false"])
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_of_what_was_not_given_nothing_is_said(tmp_path: Path, file: Path, sim: str) -> None:
    given = {"sim": sim} if '<arg name="sim"' in file.read_text() else {}
    assert evaluate(file, given, os.environ, tmp_path).messages == []


@settings(max_examples=50, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(text=st.text(st.characters(blacklist_categories=["Cs"], blacklist_characters="\0"), min_size=1))
def test_a_board_is_simulated_unless_something_is_replayed(launch: Callable[..., Printed], text: str) -> None:
    board = "virtual_board" in repr([words[0] for words, _ in launch(TACTILE, replay=text)])
    assert board == (text == "none")


def test_only_with_sim_is_the_robot_held_to_be_a_simulated_one(launch: Callable[..., Printed]) -> None:
    file = TACTILE.with_name("ball_balancing.launch.xml")
    for sim, expected in (("true", "true"), ("1", "true"), ("false", "false"), ("0", "false")):
        for composed in ("true", "false"):
            words = repr(launch(file, sim=sim, composed=composed, robot_ip="192.168.1.10"))
            assert re.findall(r"loopback_only=(\w+)", words) == [expected]


def test_what_runs_the_skins_knows_where_they_are_merged(launch: Callable[..., Printed]) -> None:
    file = TACTILE.with_name("skins.launch.xml")
    for merge in ("true", "false"):
        (words, _), *_ = launch(file, merge=merge, base_frame="chest")
        assert words[0].endswith("/skins")
        assert f"--merge {merge} --base-frame=chest" in " ".join(words)


# What is simulated reads no params file.
OF_SIMULATED_ALONE = ("object",)
# Of every file that takes a params file; the simulated board takes none.
CHOICES = {
    "scheme": tuple(word for word in describe(DriverSettings)["scheme"].choices if word),
    "method": tuple(METHODS),
    "protocol": tuple(PROTOCOLS),
    "robot": tuple(ROBOTS),
    "autostart": ("true", "false"),
    "replay_loop": ("true", "false"),
    "object": describe(HandWorldConfig)["object"].choices,
    "object_held": ("true", "false"),
    "pose": describe(HandWorldConfig)["pose"].choices,
}


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_choices_are_those_of_the_nodes(file: Path, launch: Callable[..., Printed]) -> None:
    for argument, _ in declarations(parse_file(file)):
        in_params_file = PARAMS_ARGUMENT in file.read_text() and argument.name not in OF_SIMULATED_ALONE
        more = {IN_PARAMS_FILE} if argument.choices and in_params_file else set()
        assert set(argument.choices) == {*CHOICES.get(argument.name, ()), *more}, argument.name
        for choice in argument.choices:
            launch(file, **{argument.name: choice})
        if argument.choices:
            with pytest.raises(LaunchError, match=f'Argument "{argument.name}" provided value "trackin" is not valid'):
                launch(file, **{argument.name: "trackin"})


def settings_of(printed: Printed, node: str) -> dict[str, str]:
    """What `--set` gives to a node."""
    words = [word for command, _ in printed for word in command]
    return dict(word.removeprefix(f"{node}.").split("=", 1) for word in words if word.startswith(f"{node}."))


@pytest.mark.parametrize("composed", ["true", "false"])
def test_the_array_and_the_method_reach_every_process_that_needs_them(
    launch: Callable[..., Printed], composed: str
) -> None:
    array = {"rows": "16", "cols": "8", "pitch": "0.002"}
    chosen = {"method": "per_frame", "dictionary": "mine.npz", "autostart": "false"}
    for name in ("tactile", "ball_balancing"):
        file = TACTILE.with_name(f"{name}.launch.xml")
        started = launch(file, composed=composed, **array, **chosen)
        (board,) = [" ".join(words) for words, _ in started if words[0].endswith("/virtual_board")]
        assert "--rows 16 --cols 8" in board
        size = {"rows": "16", "cols": "8"}
        assert settings_of(started, "ball_world").items() >= {**size, "pitch_m": "0.002"}.items()
        assert settings_of(started, "driver").items() >= size.items()
        assert settings_of(started, "reconstruction").items() >= {**size, "pitch_m": "0.002"}.items()
        assert settings_of(started, "reconstruction")["method"] == "per_frame"
        assert settings_of(started, "reconstruction")["dictionary"] == "mine.npz"
        # Of the ball balancing it is the robot that waits.
        waits, goes_on = ("driver", "") if name == "tactile" else ("ball_control", "driver")
        assert settings_of(started, waits)["autostart"] == "false"
        assert not goes_on or settings_of(started, goes_on)["autostart"] == IN_PARAMS_FILE


def test_what_is_not_given_is_left_to_the_params_file(launch: Callable[..., Printed]) -> None:
    started = launch(TACTILE)
    (board,) = [" ".join(words) for words, _ in started if words[0].endswith("/virtual_board")]
    assert "--rows 32 --cols 32 --scheme tracking --m 55 " in board
    assert "--threshold 60 --protocol binary " in board
    assert board.endswith("--realtime-priority 0 --cpu-affinity none")
    reconstruction = settings_of(started, "reconstruction")
    names = ("rows", "cols", "pitch_m", "method", "dictionary")
    assert {reconstruction[name] for name in names} == {IN_PARAMS_FILE}


# What a simulation is made of, and what keeps it from a robot's own address.
OF_THE_SIMULATION = {
    *("ball_world.field_ring", "ball_world.joint_ring", "driver.port", "ball_control.robot_ip"),
    *("hand_reflexes.port", "hand_reflexes.interface"),
}
ALWAYS_SET = {"ball_control.loopback_only"}


@pytest.mark.parametrize("composed", ["true", "false"])
@pytest.mark.parametrize("sim", ["true", "false"])
@pytest.mark.parametrize(
    "file", [file for file in FILES if PARAMS_ARGUMENT in file.read_text()], ids=lambda file: file.name
)
def test_an_argument_that_is_not_given_overrides_no_params_file(
    launch: Callable[..., Printed], file: Path, sim: str, composed: str
) -> None:
    declared = {argument.name for argument, _ in declarations(parse_file(file))}
    switches = {name: value for name, value in (("sim", sim), ("composed", composed)) if name in declared}
    set_here: set[str] = set()
    for command, contents in launch(file, **switches):
        words = [word.partition("=") for word in command if re.match(r"\w+\.\w+=", word)]
        set_here.update(name for name, _, value in words if value != IN_PARAMS_FILE)
        # Parameters of the launch file's own, which go before those of a params file whatever they say.
        assert contents == []
    is_simulated = switches.get("sim") != "false"
    assert set_here <= ALWAYS_SET | (OF_THE_SIMULATION if is_simulated else set())


def test_a_simulated_robot_is_where_nothing_else_is_said_whatever_a_params_file_says(
    launch: Callable[..., Printed],
) -> None:
    file = TACTILE.with_name("ball_balancing.launch.xml")
    for arguments, expected in (({}, "127.0.0.1"), ({"robot_ip": "127.0.0.9"}, "127.0.0.9")):
        started = launch(file, **arguments)
        (robot,) = [" ".join(words) for words, _ in started if words[0].endswith("/ur_controller")]
        assert f"--host {expected} " in robot
        assert settings_of(started, "ball_control")["robot_ip"] == expected
    assert settings_of(launch(file, sim="false"), "ball_control")["robot_ip"] == IN_PARAMS_FILE


def test_the_simulation_of_another_robot_is_left_to_whoever_has_it(
    launch: Callable[..., Printed], tmp_path: Path
) -> None:
    file = tmp_path / "simulated_robot.launch.xml"
    text = TACTILE.with_name(file.name).read_text()
    file.write_text(text.replace('<choice value="ur5e"/>', '<choice value="ur5e"/><choice value="table"/>'))
    for robot, expected in (("table", ["ball_world"]), ("ur5e", ["ur_controller", "ball_world"])):
        assert [Path(words[0]).name for words, _ in launch(file, robot=robot)] == expected


@pytest.mark.parametrize("sim", ["true", "1"])
def test_what_a_simulated_skin_feels_moves_no_real_hand(launch: Callable[..., Printed], sim: str) -> None:
    file = TACTILE.with_name("hand_reflexes.launch.xml")
    real = {"port": "/dev/ttyACM0", "hand_port": "/dev/ttyUSB0"}
    started = launch(file, sim=sim, run_dir="/tmp/run", **real)
    assert "/dev/tty" not in repr(started)
    hand = settings_of(started, "hand_reflexes")
    assert (hand["port"], hand["interface"]) == ("/tmp/run/hand", "dynamixel")
    (world,) = [" ".join(words) for words, _ in started if words[0].endswith("/hand_world")]
    assert "--link /tmp/run/hand " in world
    started = launch(file, sim="false", **real)
    assert not any(words[0].endswith(("/hand_world", "/virtual_board")) for words, _ in started)
    assert settings_of(started, "hand_reflexes")["port"] == "/dev/ttyUSB0"
    assert settings_of(started, "driver")["port"] == "/dev/ttyACM0"


@pytest.mark.parametrize("name", ["tactile", "ball_balancing", "hand_reflexes"])
def test_the_spare_process_is_the_same_again(launch: Callable[..., Printed], name: str) -> None:
    file = TACTILE.with_name(f"{name}.launch.xml")
    for standby, expected in (("true", 2), ("false", 1)):
        started = launch(file, standby=standby, namespace="belly")
        feeling = [process for process in started if process[0][0].endswith("/tactile")]
        assert len(feeling) == expected
        assert all(process == feeling[0] for process in feeling)
        assert STANDBY_WORD in feeling[0][0]
    assert not any(words[0].endswith("/tactile") for words, _ in launch(file, standby="true", composed="false"))


@pytest.mark.parametrize("composed", ["true", "false"])
def test_the_arguments_of_the_hand_reach_what_they_are_for(launch: Callable[..., Printed], composed: str) -> None:
    file = TACTILE.with_name("hand_reflexes.launch.xml")
    of_the_node = {"reflexes": "sharp, slip", "rate_hz": "60.0", "autostart": "false", "hand": "mine.yaml"}
    started = launch(file, composed=composed, object="box", seed="7", layout="mine_layout.yaml", **of_the_node)
    assert settings_of(started, "hand_reflexes").items() >= of_the_node.items()
    assert settings_of(started, "reconstruction")["layout"] == "mine_layout.yaml"
    assert settings_of(started, "driver")["autostart"] == IN_PARAMS_FILE
    (world,) = [" ".join(words) for words, _ in started if words[0].endswith("/hand_world")]
    assert "--object box " in world
    assert " --seed 7 --layout mine_layout.yaml " in world
    (board,) = [" ".join(words) for words, _ in started if words[0].endswith("/virtual_board")]
    assert "--rate-hz 1000 " in board
    assert "--seed 7 " in board
