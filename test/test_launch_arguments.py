"""What users write behind `name:=` reaches the processes as it stands, whatever it holds. Nothing is started."""

from __future__ import annotations

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

from acts_tools.launch.evaluate import Plan, evaluate

FILES = sorted((Path(get_package_share_directory(PACKAGE)) / "launch").glob("*.launch.xml"))

# Arguments that take any text, by launch file.
TEXTS = {
    "tactile": ("port", "frame_id", "recording", "replay", "run_dir", "cpu_affinity"),
    "ball_balancing": ("port", "robot_ip", "trajectory", "frame_id", "run_dir", "cpu_affinity"),
    "skins": ("skins_file", "base_frame", "run_dir"),
    "simulated_board": ("recording", "run_dir", "cpu_affinity"),
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
    def run(file: Path, **arguments: str) -> Printed:
        return printed(evaluate(file, arguments, os.environ, tmp_path))

    return run


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_no_launch_file_evaluates_code(file: Path) -> None:
    text = file.read_text()
    assert "$(eval" not in text
    assert "$(command" not in text


@pytest.mark.parametrize("composed", ["true", "false"])
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_any_text_of_an_argument_arrives_whole(launch: Callable[..., Printed], file: Path, composed: str) -> None:
    name = file.name.removesuffix(".launch.xml")
    more = {"composed": composed} if '"composed"' in file.read_text() else {}
    for argument in TEXTS[name]:
        expected = launch(file, **{argument: STANDS_FOR}, **more)
        assert STANDS_FOR in repr(expected), argument
        for text in MEAN:
            assert launch(file, **{argument: text}, **more) == replaced(expected, text), (argument, text)


TACTILE = next(file for file in FILES if file.name == "tactile.launch.xml")


@settings(max_examples=50, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(text=st.text(st.characters(blacklist_categories=("Cs",), blacklist_characters="\0"), min_size=1))
def test_a_board_is_simulated_unless_something_is_replayed(launch: Callable[..., Printed], text: str) -> None:
    board = "virtual_board" in repr([words[0] for words, _ in launch(TACTILE, replay=text)])
    assert board == (text == "none")


def test_only_with_sim_is_the_robot_held_to_be_a_simulated_one(launch: Callable[..., Printed]) -> None:
    file = TACTILE.with_name("ball_balancing.launch.xml")
    for sim, expected in (("true", "true"), ("1", "true"), ("false", "false"), ("0", "false")):
        words = repr(launch(file, sim=sim, robot_ip="192.168.1.10"))
        assert re.findall(r"loopback_only=(\w+)", words) == [expected]
        (separate,) = re.findall(r"'loopback_only': (\w+)", repr(launch(file, sim=sim, composed="false")))
        assert separate.lower() == expected
