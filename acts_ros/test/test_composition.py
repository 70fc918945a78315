# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Parameters of the nodes of one process, from its command line."""

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from rclpy.parameter import Parameter

from acts_core.errors import SettingsError
from acts_core.settings import setting
from acts_ros import composition
from acts_ros.composition import parameters_from, run_nodes


@dataclass(frozen=True)
class LeftSettings:
    word: str = setting("one", "a word")
    number: float = setting(1.0, "a number", minimum=0.0, maximum=9.0)
    is_on: bool = setting(False, "a switch")


@dataclass(frozen=True)
class RightSettings:
    count: int = setting(1, "a whole number", minimum=0, maximum=9)
    angles: tuple[float, ...] = setting((0.0,), "a list")


NODES = {"left": LeftSettings, "right": RightSettings}


def given(*words: str) -> dict[str, dict[str, object]]:
    parameters = parameters_from(["program", *words], NODES)
    return {node: {one.name: one.value for one in values} for node, values in parameters.items()}


def test_each_node_gets_its_own_in_the_types_of_its_settings() -> None:
    words = ["left.word=true", "left.number=3", "left.is_on=true", "right.count=4", "right.angles=[1, 2.5]"]
    assert given(*(part for word in words for part in ("--set", word)), "--ros-args", "-r", "__ns:=/x") == {
        "left": {"word": "true", "number": 3.0, "is_on": True},
        "right": {"count": 4, "angles": [1.0, 2.5]},
    }


def test_what_is_left_to_the_params_file_is_not_set() -> None:
    words = ["--set", "left.word=params_file", "--set", "left.number=params_file", "--set", "right.count=2"]
    assert given(*words) == {"left": {}, "right": {"count": 2}}
    with pytest.raises(SettingsError, match="did you mean 'word'"):
        given("--set", "left.wrod=params_file")


def test_nothing_given_and_given_twice() -> None:
    assert given() == {"left": {}, "right": {}}
    # A value may hold the signs that separate.
    assert given("--set", "left.word=a.b=c", "--set", "left.word=d.e=f g")["left"] == {"word": "d.e=f g"}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("left.wrod=x", "did you mean 'word'"),
        ("letf.word=x", "did you mean 'left'"),
        ("left.number=much", "number = 'much': allowed is a value of type number"),
        ("left.number=10", "allowed is 0 to 9"),
        ("left.number=nan", "allowed is"),
        ("left.number=[", "allowed is"),
        ("right.count=1.5", "allowed is"),
        ("left.word", "needed is NODE.PARAMETER=VALUE"),
        ("word=x", "needed is NODE.PARAMETER=VALUE"),
    ],
)
def test_what_does_not_fit_is_refused(text: str, words: str) -> None:
    with pytest.raises(SettingsError, match=words.replace("[", r"\[")):
        given("--set", text)


@pytest.mark.parametrize("text", ["/**:\n  ros__parameters:\n    rows: [32\n", "rows: 32\n", None])
def test_a_params_file_that_ros_cannot_read_is_refused(tmp_path: Path, text: str | None) -> None:
    path = tmp_path / "params.yaml"
    if text is not None:
        path.write_text(text)
    with pytest.raises(SettingsError, match=f"params file: '--params-file {path}'") as caught:
        given("--ros-args", "--params-file", str(path))
    assert ".c:" not in str(caught.value)
    assert not str(caught.value).endswith("; ")


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"# Gr\xf6\xdfe\n/**: {ros__parameters: {a: 1}}\n", r"params\.yaml: not text in UTF-8 \("),
        (
            b"/**:\n  ros__parameters:\n\ta: 1\n",
            r"found character '\\t' that cannot start .*line 3, column 1",
        ),
    ],
)
def test_what_is_wrong_with_a_params_file_is_told(tmp_path: Path, content: bytes, said: str) -> None:
    path = tmp_path / "params.yaml"
    path.write_bytes(content)
    with pytest.raises(SettingsError, match=rf"'--params-file {path}'.*; .*{said}") as caught:
        given("--ros-args", "-p", "word:=two", "--params-file", str(path))
    assert "\n" not in str(caught.value)


def test_a_params_file_that_is_nested_too_deeply_to_say_more_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "params.yaml"
    path.write_text(f"/**: {{ros__parameters: {{a: {'[' * 2000}\n")
    with pytest.raises(SettingsError, match=rf"'--params-file {path}'.*; .*recursion"):
        given("--ros-args", "--params-file", str(path))


def test_a_folder_is_no_params_file(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match=f"; {tmp_path}: not a regular file$"):
        given("--ros-args", "--params-file", str(tmp_path))


def test_how_an_empty_text_is_given_to_ros_is_told() -> None:
    with pytest.raises(SettingsError, match=r"""'-p word:='.*; an empty text is written word:="''"$"""):
        given("--ros-args", "-p", "right:word:=two", "-p", "word:=")


def test_only_of_an_empty_text_it_is_told_how_to_give_one() -> None:
    with pytest.raises(SettingsError, match=r"'-p number:=\[1, a\]'") as caught:
        given("--ros-args", "-p", "number:=[1, a]")
    assert "empty text" not in str(caught.value)


def test_a_namespace_that_cannot_be_is_refused() -> None:
    with pytest.raises(SettingsError, match="'/9a' is no namespace: allowed are letters"):
        given("--ros-args", "-r", "__ns:=/9a")


def test_a_word_that_is_no_text_is_refused_with_what_to_do() -> None:
    with pytest.raises(SettingsError, match=r"'left.word=/tmp/\\udcff': ROS takes text in UTF-8 only; rename"):
        given("--set", "left.word=/tmp/\udcff")


@pytest.mark.parametrize("option", ["-p", "--param"])
def test_what_not_all_nodes_have_is_not_given_to_all_but_as_is_said(option: str) -> None:
    with pytest.raises(
        SettingsError, match=r"^-p word:=two is for all .* right cannot .*: give --set left\.word=two b"
    ):
        given("--ros-args", option, "word:=two")
    # These are for one node, for ROS, or for whoever refuses them by their names.
    others = ["left:word:=two", "use_sim_time:=true", "wrod:=two"]
    assert given("--ros-args", *(part for other in others for part in (option, other))) == {"left": {}, "right": {}}


def test_ros_words_without_their_flag_are_refused_with_where_they_go(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        given("-p", "word:=two")
    assert "[--ros-args -p NAME:=VALUE --params-file FILE ...]" in capsys.readouterr().err


def test_what_all_nodes_have_may_be_given_to_all() -> None:
    assert parameters_from(["program", "--ros-args", "-p", "word:=two"], {"left": LeftSettings, "more": LeftSettings})


def test_nodes_are_made_in_their_order_each_with_its_own_parameters(monkeypatch: pytest.MonkeyPatch) -> None:
    ran: list[Any] = []

    def run(factories: list[Any], *arguments: Any) -> int:
        ran[:] = [[factory() for factory in factories], *arguments]
        return 7

    def make(name: str) -> Any:
        def made(parameter_overrides: list[Parameter]) -> Any:
            return name, {one.name: one.value for one in parameter_overrides}

        return made

    monkeypatch.setattr(composition, "run", run)
    signals: Any = object()
    words = ["program", "--set", "right.count=2", "--set", "left.word=two", "--ros-args", "-r", "__ns:=/x"]
    nodes = {name: make(name) for name in ("right", "left")}
    for given_words in (words, None):
        monkeypatch.setattr(sys, "argv", ["other"] if given_words else words)
        assert run_nodes(nodes, NODES, signals, given_words) == 7
        assert ran == [[("right", {"count": 2}), ("left", {"word": "two"})], words, signals]
