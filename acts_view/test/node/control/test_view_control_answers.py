# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What pages are told of services that answer late, or oddly; without ROS."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.task import Future
from std_srvs.srv import Trigger

from acts_core.array import MAX_SIDE
from acts_core.errors import ViewRequestError
from acts_view.nodes import control
from acts_view.web.requests import Request


class Asking:
    """`Control` whose services are all there, and answer when a test says so; without ROS."""

    def __init__(self, patch: pytest.MonkeyPatch, services: dict[str, list[str]]) -> None:
        self.answers: list[Callable[[object], object]] = []
        patch.setattr(control, "ask", lambda *_: Future())
        patch.setattr(control, "call_when_done", self._note)
        self.is_ready = True
        client = SimpleNamespace(service_is_ready=lambda: self.is_ready, remove_pending_request=lambda _: None)
        node: Any = SimpleNamespace(
            create_client=lambda *_: client, get_service_names_and_types=lambda: list(services.items())
        )
        recording: Any = SimpleNamespace(state=dict)
        self.control = control.Control(node, recording)

    def _note(self, _: Node, future: Future[Any], on_done: Callable[[Future[Any]], object]) -> None:
        def answer(response: object) -> None:
            future.set_result(response)
            on_done(future)

        self.answers.append(answer)


def settings_of(m: int) -> GetParameters.Response:
    given = (Parameter("scheme", value=""), Parameter("m", value=m), Parameter("threshold_counts", value=-1))
    return GetParameters.Response(values=[parameter.get_parameter_value() for parameter in given])


def test_what_a_driver_has_said_before_a_setting_was_changed_is_told_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    service = "/plate/driver/set_parameters"
    asking = Asking(monkeypatch, {service: ["rcl_interfaces/srv/SetParameters"]})
    told: list[tuple[bool, str]] = []
    asking.control.look()
    asking.answers.pop()(settings_of(55))
    assert asking.control.look()["settings"]["/plate"]["m"] == 55
    before = asking.answers.pop()
    asking.control.take(Request(1, "set", "/plate", "m", 60), lambda done, text: told.append((done, text)))
    asking.answers.pop()(SetParameters.Response(results=[SetParametersResult(successful=True)]))
    assert told == [(True, "set")]
    after = asking.answers.pop()
    before(settings_of(55))
    assert asking.control.look()["settings"] == {}
    # The look has asked once more.
    after(settings_of(58))
    asking.answers.pop()(settings_of(60))
    assert asking.control.look()["settings"]["/plate"]["m"] == 60


def test_a_service_of_another_type_is_not_offered(monkeypatch: pytest.MonkeyPatch) -> None:
    services = {"/odd/driver/tare": ["std_srvs/srv/SetBool"], "/plate/driver/tare": ["std_srvs/srv/Trigger"]}
    assert Asking(monkeypatch, services).control.look()["offers"] == [["tare", "/plate"]]


@pytest.mark.parametrize(
    ("is_done", "reason", "words"),
    [(True, "", "done"), (False, "", "refused without a reason"), (False, "it moves", "it moves")],
)
def test_an_answer_without_a_reason_is_still_a_sentence(
    monkeypatch: pytest.MonkeyPatch, is_done: bool, reason: str, words: str
) -> None:
    services = {"/plate/driver/tare": ["std_srvs/srv/Trigger"], "/plate/driver/set_parameters": [""]}
    asking = Asking(monkeypatch, services)
    told: list[tuple[bool, str]] = []
    asking.control.look()
    for request in (Request(1, "tare", "/plate"), Request(2, "set", "/plate", "m", MAX_SIDE**2)):
        asking.control.take(request, lambda done, text: told.append((done, text)))
    _settings, tared, was_set = asking.answers
    tared(Trigger.Response(success=is_done, message=reason))
    was_set(SetParameters.Response(results=[SetParametersResult(successful=is_done, reason=reason)]))
    assert told == [(is_done, words), (is_done, words.replace("done", "set"))]


def test_an_answer_about_no_parameter_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    asking = Asking(monkeypatch, {"/plate/driver/set_parameters": [""]})
    told: list[tuple[bool, str]] = []
    asking.control.look()
    for results in ([], [SetParametersResult(successful=True)] * 2):
        asking.control.take(Request(1, "set", "/plate", "m", 60), lambda done, text: told.append((done, text)))
        asking.answers.pop()(SetParameters.Response(results=results))
    assert told == [(False, "the node gave no answer")] * 2


def test_a_service_that_is_not_there_or_not_reached_is_not_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    asking = Asking(monkeypatch, {"/plate/driver/tare": ["std_srvs/srv/Trigger"]})
    asking.control.look()
    with pytest.raises(ViewRequestError, match="there is no service /foot/driver/tare: is the node running"):
        asking.control.take(Request(1, "tare", "/foot"), lambda *_: None)
    asking.is_ready = False
    with pytest.raises(ViewRequestError, match="/plate/driver/tare is not reached: has its node ended"):
        asking.control.take(Request(1, "tare", "/plate"), lambda *_: None)
    assert not asking.answers
