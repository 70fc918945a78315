# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts param` as a user runs it, on a node that runs; ROS_DOMAIN_ID 137."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rcl_interfaces.srv import ListParameters
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.task import Future
from spinning import spinning_node

from acts_tools.cli import main
from acts_tools.running import calls


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    """A node `gains` in namespace /plate, with parameters of four types; it refuses a `kp` of 13."""
    monkeypatch.setenv("ROS_DOMAIN_ID", "137")
    with spinning_node("gains", "/plate", 137, _with_parameters) as made:
        yield made


def _with_parameters(node: Node) -> None:
    limits = [FloatingPointRange(from_value=0.0, to_value=200.0)]
    node.declare_parameter("kp", 18.0, ParameterDescriptor(description="gain", floating_point_range=limits))
    for name, value in (("steps", 3), ("is_on", True), ("robot", "ur5e"), ("joints", [1.0, 2.0])):
        node.declare_parameter(name, value)
    node.add_on_set_parameters_callback(_refuse_13)


def _refuse_13(parameters: list[Parameter]) -> SetParametersResult:
    is_unlucky = any(one.value == 13.0 for one in parameters)
    return SetParametersResult(successful=not is_unlucky, reason="13 is unlucky" if is_unlucky else "")


def test_parameters_are_shown_and_set(node: Node, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["param", "/plate/gains"]) == 0
    shown = capsys.readouterr().out.splitlines()
    assert "kp: 18.0    # gain; 0 to 200" in shown
    assert {"steps: 3", "is_on: True", "robot: 'ur5e'", "joints: [1.0, 2.0]"} <= set(shown)
    assert main(["param", "plate/gains", "robot", "kp"]) == 0
    assert capsys.readouterr().out == "robot: 'ur5e'\nkp: 18.0    # gain; 0 to 200\n"
    assert main(["param", "/plate/gains", "kp=16", "steps=4", "is_on=false", "robot=a=b"]) == 0
    assert capsys.readouterr().out == "set: kp=16, steps=4, is_on=false, robot=a=b\n"
    values = [node.get_parameter(name).value for name in ("kp", "steps", "is_on", "robot")]
    assert values == [16.0, 4, False, "a=b"]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["kpp"], "/plate/gains has no parameter kpp; `acts param /plate/gains` lists those it has"),
        (["kp=high"], "kp = 'high': needed is a number"),
        (["steps=1.5"], "steps = '1.5': needed is a whole number"),
        (["steps=9223372036854775808"], "steps = '9223372036854775808': needed is a whole number of 64 bits"),
        (["robot=\udcff"], "robot = '\\udcff': needed is text in UTF-8"),
        (["is_on=1"], "is_on = '1': needed is true or false"),
        (["joints=1"], "joints is neither a number, text, nor true or false: set it in a params file"),
        (["=5"], "'=5': needed is NAME to show a parameter, or NAME=VALUE to set it"),
        (["kp=1", ""], "'': needed is NAME to show"),
        (["kp=1", "kp=2"], "a parameter is given twice"),
        (["kp=1", "steps"], "either names alone, to show them, or all with =VALUE"),
        (["steps=5", "kp=13"], "13 is unlucky"),
        (["steps=5", "kp=201"], "kp"),
    ],
)
def test_what_cannot_be_is_refused_and_changes_nothing(
    words: list[str], told: str, node: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["param", "/plate/gains", *words]) == 1
    assert capsys.readouterr().err.startswith(f"error: {told}" if told != "kp" else "error: ")
    assert [node.get_parameter(name).value for name in ("kp", "steps")] == [18.0, 3]


def test_a_node_that_is_not_there_is_named(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "137")
    monkeypatch.setattr("acts_tools.parameters.command.FOUND_S", 0.1)
    assert main(["param", "/plate/gain"]) == 1
    assert "no node offers /plate/gain/list_parameters" in capsys.readouterr().err
    assert main(["param", "left hand"]) == 1
    assert capsys.readouterr().err.startswith("error: 'left hand' is no name of a node: allowed are letters")
    assert main(["param", "/"]) == 1
    assert capsys.readouterr().err.startswith("error: '/' is no name of a node: allowed are letters")


def test_a_node_is_asked_again_whose_answer_is_lost(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "137")
    monkeypatch.setattr(calls, "_AGAIN_S", 0.1)
    asked: list[ListParameters.Request] = []

    def furnish(node: Node) -> None:
        async def lose_the_first(
            request: ListParameters.Request, response: ListParameters.Response
        ) -> ListParameters.Response:
            asked.append(request)
            if len(asked) == 1:
                await Future()
            return response

        # A real answer is lost where DDS finds the client too late, which cannot be had at will.
        group = ReentrantCallbackGroup()
        node.create_service(ListParameters, "/plate/lossy/list_parameters", lose_the_first, callback_group=group)

    with spinning_node("gains", "/plate", 137, furnish):
        assert main(["param", "/plate/lossy", "kp"]) == 1
    assert "/plate/lossy has no parameter kp" in capsys.readouterr().err
    assert len(asked) == 2
