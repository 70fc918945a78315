# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts call` as a user runs it, on a node that runs; ROS_DOMAIN_ID 138."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from rclpy.client import Client
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from spinning import spinning_node
from std_srvs.srv import SetBool, Trigger

from acts_tools.cli import main
from acts_tools.services import command


@pytest.fixture
def domain(monkeypatch: pytest.MonkeyPatch) -> None:
    """A network of which the commands of a test are alone."""
    monkeypatch.setenv("ROS_DOMAIN_ID", "138")


@pytest.fixture
def hand(domain: None) -> Iterator[list[str]]:
    """What a node `reflexes` in namespace /hand was asked: it grasps, refuses to release, and can be lit."""
    asked: list[str] = []

    def furnish(node: Node) -> None:
        def answer(name: str, succeeds: bool, words: str) -> None:
            def on_call(_request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
                asked.append(name)
                response.success, response.message = succeeds, words
                return response

            node.create_service(Trigger, f"~/{name}", on_call)

        answer("grasp", True, "the hand closes")
        answer("rest", True, "")
        answer("release", False, "no touch")
        node.create_service(SetBool, "~/light", lambda _request, response: response)

    with spinning_node("reflexes", "/hand", 138, furnish):
        yield asked


def test_a_service_is_called_and_its_answer_printed(hand: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["call", "/hand/reflexes/grasp"]) == 0
    assert capsys.readouterr().out == "the hand closes\n"
    assert main(["call", "hand/reflexes/rest"]) == 0
    assert capsys.readouterr().out == "done\n"
    assert hand == ["grasp", "rest"]


def test_a_refusal_is_an_error(hand: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["call", "/hand/reflexes/release"]) == 1
    assert capsys.readouterr() == ("", "error: no touch\n")
    assert hand == ["release"]


def test_a_question_that_the_middleware_does_not_take_is_an_error(
    hand: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse(_client: Client, _asked: object) -> None:
        raise rclpy_implementation.RCLError("failed to send request: cannot publish data, at x.cpp:68")

    monkeypatch.setattr(Client, "call_async", refuse)
    assert main(["call", "/hand/reflexes/grasp"]) == 1
    assert capsys.readouterr() == (
        "",
        "error: /hand/reflexes/grasp was not asked: failed to send request: cannot publish data; ask again\n",
    )
    assert not hand


def test_without_a_name_the_services_are_listed(hand: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["call"]) == 0
    services = [f"/hand/reflexes/{name}" for name in ("grasp", "release", "rest")]
    assert capsys.readouterr().out.splitlines() == services
    assert not hand


def test_a_service_that_takes_more_than_a_call_is_refused(hand: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["call", "/hand/reflexes/light"]) == 1
    assert "/hand/reflexes/light is of the type std_srvs/srv/SetBool; allowed is std_srvs/srv/Trigger" in (
        capsys.readouterr().err
    )
    assert not hand


def test_a_service_that_nobody_offers_is_told(
    domain: None, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(command, "FOUND_S", 0.2)
    assert main(["call", "/hand/reflexes/grab"]) == 1
    assert (
        "no node offers /hand/reflexes/grab: is it launched (a first start takes up to a minute)"
        in capsys.readouterr().err
    )
    assert main(["call", "left hand/grasp"]) == 1
    assert "error: 'left hand/grasp' is no name of a service" in capsys.readouterr().err
    assert main(["call", "/"]) == 1
    assert "error: '/' is no name of a service" in capsys.readouterr().err
    assert main(["call"]) == 1
    assert "nobody offers a std_srvs/srv/Trigger" in capsys.readouterr().err
