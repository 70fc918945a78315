# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`--help` of an executable, answered without ROS."""

from __future__ import annotations

from dataclasses import dataclass

from acts_core.settings import Changeable, setting
from acts_ros.executables.program_help import program_help


@dataclass(frozen=True)
class LeftSettings:
    rate_hz: float = setting(250.0, "how often [Hz]", minimum=1.0, maximum=9.0, changeable=Changeable.RUNNING)
    word: str = setting("", "a word")


def test_name_description_and_parameters_are_told() -> None:
    text = program_help("left", "The node `left`.\n", {"left": LeftSettings})
    assert text.startswith("usage: left [--ros-args -p NAME:=VALUE")
    assert "The node `left`.\n" in text
    assert "    rate_hz (default 250.0)\n        how often [Hz]; 1 to 9; may be set while the node runs\n" in text
    assert "    word (default empty)\n        a word\n" in text


def test_of_several_nodes_each_is_told() -> None:
    text = program_help("both", "Two.", {"left": LeftSettings, "right": LeftSettings})
    assert "--set left.rate_hz=VALUE" in text
    assert text.count("rate_hz (default") == 2
    assert "parameters of right:" in text
