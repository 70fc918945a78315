# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What pages ask for: services of the nodes, of which none can hold the view up, and recording."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.client import Client
from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import Trigger

from acts_core.array import COUNT_MAX, MAX_SIDE
from acts_core.errors import ViewRequestError
from acts_core.sampling import SCHEME_NUMBERS
from acts_ros.executor import call_soon, call_when_done
from acts_ros.middleware import NotAskedError, ask
from acts_view.recording.recording import Recording
from acts_view.web.requests import STOPS, Answer, Request

TRIGGERS = {
    "tare": "driver/tare",
    "calibrate": "driver/calibrate",
    "balance": "ball_control/start",
    "stop_balancing": "ball_control/stop",
    "put_back": "ball_world/put_back",
    "grasp": "hand_reflexes/grasp",
    "release": "hand_reflexes/release",
    "stop_grasp": "hand_reflexes/stop",
}
"""Services that can be called, without their namespace, by what a page calls it."""

_TRIGGER_TYPE = "std_srvs/srv/Trigger"
_SET, _GET = "driver/set_parameters", "driver/get_parameters"
RANGES = {"m": (0, MAX_SIDE**2), "threshold_counts": (-1, COUNT_MAX)}
"""Lowest and highest value of each number that can be set."""

_PARAMETERS = ("scheme", *RANGES)
# How long an answer of a service is waited for.
_PATIENCE_S = 10.0
_WAITING_MAX = 32
# Anybody in the domain can make up more.
_OFFERS_MAX = 64


@dataclass
class _Call:
    client: Client
    future: Future[Any]
    answer: Answer
    what: str
    deadline_s: float


class Control:
    """Calls services for pages.

    Parameters
    ----------
    node : Node
        Spun by somebody else.
    recording : Recording
    """

    def __init__(self, node: Node, recording: Recording) -> None:
        self._node = node
        self._recording = recording
        self._patience_s = _PATIENCE_S
        self._requests: deque[tuple[Request, Answer]] = deque()
        self._services: dict[str, list[str]] = {}
        self._clients: dict[str, Client] = {}
        self._calls: list[_Call] = []
        self._settings: dict[str, dict[str, Any]] = {}
        self._asked: dict[str, Future[Any]] = {}

    def take(self, request: Request, answer: Answer) -> None:
        """Take what a page asks for; on the server's thread.

        A service is called from there: the executor's thread may wait for a disk, as while it records, and a stop with
        it. All services are, so that none overtakes another.

        Raises
        ------
        ViewRequestError
            Too much waits already, and it is none of `STOPS`; or the service is not there.
        """
        if request.do not in STOPS and len(self._requests) + len(self._calls) >= _WAITING_MAX:
            raise ViewRequestError(f"{_WAITING_MAX} requests wait for the nodes already; try again")
        if request.do in TRIGGERS:
            self._call(f"{request.skin}/{TRIGGERS[request.do]}", Trigger.Request(), answer, _of_trigger)
        elif request.do == "set":
            self._set(request, answer)
        else:
            self._requests.append((request, answer))
            call_soon(self._node, self.step)

    def step(self) -> None:
        """Begin and end recordings, and give up what nobody answers; now and then, on the executor's thread."""
        while self._requests:
            request, answer = self._requests.popleft()
            try:
                self._begin(request, answer)
            except ViewRequestError as error:
                answer(False, str(error))
        now_s = time.monotonic()
        for call in [call for call in self._calls if call.deadline_s < now_s]:
            self._calls.remove(call)
            call.client.remove_pending_request(call.future)
            call.answer(False, f"{call.what} did not answer within {self._patience_s:g} s; it may still be done")

    def look(self) -> dict[str, Any]:
        """What can be asked for at present, and the settings in force, as the page is told; now and then.

        Returns
        -------
        dict
            ``offers``: pairs of what and of which namespace; ``settings``: of drivers, by namespace; ``recording``.
        """
        self._services = dict(self._node.get_service_names_and_types())
        found: list[list[str]] = [
            [do, service.removesuffix(f"/{name}")]
            for do, name in TRIGGERS.items()
            for service, kinds in self._services.items()
            if service.endswith(f"/{name}") and _TRIGGER_TYPE in kinds
        ][:_OFFERS_MAX]
        offers = [[do, of] for do, of in found if self._is_there(f"{of}/{TRIGGERS[do]}", Trigger)]
        drivers = [name.removesuffix(f"/{_SET}") for name in self._services if name.endswith(f"/{_SET}")][:_OFFERS_MAX]
        drivers = [driver for driver in drivers if self._is_there(f"{driver}/{_SET}", SetParameters)]
        for driver in drivers:
            self._ask_settings(driver)
        self._settings = {driver: self._settings.get(driver, {}) for driver in drivers}
        return {
            "offers": [*offers, *(["set", driver] for driver in drivers)],
            # A copy: what is answered at once is read on the server's thread.
            "settings": {driver: values for driver, values in list(self._settings.items()) if values},
            "schemes": list(SCHEME_NUMBERS),
            "recording": self._recording.state(),
        }

    def _begin(self, request: Request, answer: Answer) -> None:
        if request.do == "record":
            answer(True, self._recording.start())
        elif request.do == "stop_recording":
            answer(True, self._recording.stop())
        else:
            known = ", ".join([*TRIGGERS, "set", "record", "stop_recording"])
            raise ViewRequestError(f"what is asked for is one of {known}; not '{request.do}'")

    def _set(self, request: Request, answer: Answer) -> None:
        asked = SetParameters.Request(parameters=[_parameter(request)])

        def read(response: SetParameters.Response) -> tuple[bool, str]:
            is_set, sentence = _of_set(response)
            if is_set:
                # What is known is of before, and so may be what is being answered.
                self._settings.pop(request.skin, None)
                self._ask_settings(request.skin)
            return is_set, sentence

        self._call(f"{request.skin}/{_SET}", asked, answer, read)

    def _call(self, service: str, asked: object, answer: Answer, read: Callable[[Any], tuple[bool, str]]) -> None:
        # Only what was found: a page names no service that the graph does not have.
        if service not in self._services:
            raise ViewRequestError(f"there is no service {service}: is the node running?")
        # Made by `look`, of all that is offered.
        client = self._clients.get(service)
        if client is None or not client.service_is_ready():
            raise ViewRequestError(f"{service} is not reached: has its node ended? If it has just begun, try again")
        try:
            future = ask(client, asked)
        except NotAskedError as error:
            raise ViewRequestError(str(error)) from error
        call = _Call(client, future, answer, service, time.monotonic() + self._patience_s)
        self._calls.append(call)

        def on_done(done: Future[Any]) -> None:
            if call not in self._calls:
                return
            self._calls.remove(call)
            response = done.result()
            answer(*((False, f"{service} gave no answer") if response is None else read(response)))

        call_when_done(self._node, future, on_done)

    def _ask_settings(self, driver: str) -> None:
        client = self._client(f"{driver}/{_GET}", GetParameters)
        asked = self._asked.get(driver)
        if asked is not None and not asked.done():
            # Kept, questions that are never answered would add up.
            client.remove_pending_request(asked)
        if not client.service_is_ready():
            return

        def on_done(done: Future[Any]) -> None:
            response = done.result()
            is_newest = self._asked.get(driver) is done
            if is_newest and response is not None and len(response.values) == len(_PARAMETERS):
                values = [
                    one.string_value if one.type == ParameterType.PARAMETER_STRING else one.integer_value
                    for one in response.values
                ]
                self._settings[driver] = dict(zip(_PARAMETERS, values, strict=True))

        try:
            self._asked[driver] = ask(client, GetParameters.Request(names=list(_PARAMETERS)))
        except NotAskedError:
            return  # the next look asks again
        call_when_done(self._node, self._asked[driver], on_done)

    def _is_there(self, service: str, kind: type) -> bool:
        """Whether somebody serves it: the graph names it also where there are only clients, such as ours."""
        return bool(self._client(service, kind).service_is_ready())

    def _client(self, service: str, kind: type) -> Client:
        if service not in self._clients:
            self._clients[service] = self._node.create_client(kind, service)
        return self._clients[service]


def _parameter(request: Request) -> Parameter:
    name, value = request.name, request.value
    if name == "scheme" and isinstance(value, str) and value in ("", *SCHEME_NUMBERS):
        return Parameter(name=name, value=ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=value))
    if name in RANGES and isinstance(value, int | float) and math.floor(value) == value:
        lowest, highest = RANGES[name]
        if lowest <= value <= highest:
            number = ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=int(value))
            return Parameter(name=name, value=number)
    raise ViewRequestError(
        f"{name or 'nothing'} = {value!r}: what can be set is scheme ({', '.join(SCHEME_NUMBERS)}, or empty for the "
        f"board's own), m (0 to {MAX_SIDE**2}) and threshold_counts (-1 to {COUNT_MAX})"
    )


def _of_trigger(response: Trigger.Response) -> tuple[bool, str]:
    return response.success, response.message or ("done" if response.success else "refused without a reason")


def _of_set(response: SetParameters.Response) -> tuple[bool, str]:
    if len(response.results) != 1:
        return False, "the node gave no answer"
    (result,) = response.results
    return result.successful, result.reason or ("set" if result.successful else "refused without a reason")
