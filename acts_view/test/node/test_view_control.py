# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a page asks for, done by real services, in a real browser and by messages; ROS_DOMAIN_ID 222."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import pytest
import rclpy
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import GetParameters
from rclpy.client import Client
from rclpy.context import Context
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.service import Service
from spinning import Spinning
from std_srvs.srv import Trigger
from view_browser import expect, needs_browser
from view_node_bench import header_where
from waiting import wait_for
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

from acts_msgs.msg import Contact
from acts_ros import qos
from acts_ros.polled import PolledService
from acts_view.nodes import control
from acts_view.nodes.view_node import ViewNode

if TYPE_CHECKING:
    from playwright.sync_api import Page

DOMAIN_ID = 222
DEADLINE_S = 30.0
PATIENCE_S = 3.0
BUTTONS = {
    "/plate": {"tare": "Tare", "calibrate": "Calibrate"},
    "": {"start": "Start balancing", "stop": "Stop balancing"},
    "/hand": {"grasp": "Grasp", "release": "Release", "stop": "Stop the hand"},
}
SERVERS = {"/plate": "driver", "": "ball_control", "/hand": "hand_reflexes"}


class Bench:
    """The node, services that answer, and one that does not; what was called."""

    def __init__(self, *, control: bool) -> None:
        self._context = Context()
        rclpy.init(context=self._context, domain_id=DOMAIN_ID)
        self.called: list[str] = []
        self.services: dict[str, Service] = {}
        nodes = []
        for namespace, name in SERVERS.items():
            node = Node(name, namespace=namespace, context=self._context)
            for what in BUTTONS[namespace]:
                callback = self.callback(name, what)
                self.services[f"{namespace}/{what}"] = node.create_service(Trigger, f"~/{what}", callback)
            nodes.append(node)
        self.driver = nodes[0]
        for parameter, value in (("scheme", ""), ("m", 55), ("threshold_counts", -1)):
            self.driver.declare_parameter(parameter, value)
        self.driver.add_on_set_parameters_callback(_refuse_thirteen)
        self.driver.create_publisher(Contact, "contact", qos.STREAM)
        # Nobody spins it: its service is there, and says nothing.
        self.stuck = Node("driver", namespace="/stuck", context=self._context)
        self.stuck.create_service(Trigger, "~/tare", self.callback("stuck", "tare"))
        options = [Parameter("port", value=0), Parameter("control", value=control)]
        self.view = ViewNode(context=self._context, parameter_overrides=options)
        if self.view._control is not None:
            self.view._control._patience_s = PATIENCE_S
        self.url = self.view.address.url
        self._nodes = [*nodes, self.view]
        self.spinning = Spinning(self._context, *self._nodes)

    def connect(self) -> ClientConnection:
        port = self.view.address.port
        origin = Origin(f"http://127.0.0.1:{port}")
        return connect(f"ws://127.0.0.1:{port}/stream", origin=origin, compression=None)

    def close(self) -> None:
        self.spinning.end()
        self.view.close()
        for node in (*self._nodes, self.stuck):
            node.destroy_node()
        rclpy.try_shutdown(context=self._context)

    def callback(self, name: str, what: str) -> Callable[[Any, Trigger.Response], Trigger.Response]:
        def answer(_: Any, response: Trigger.Response) -> Trigger.Response:
            self.called.append(f"{name}/{what}")
            response.success = what != "calibrate"
            response.message = f"{what} was heard"
            return response

        return answer


def _refuse_thirteen(parameters: list[Parameter]) -> SetParametersResult:
    wrong = any(one.name == "m" and one.value == 13 for one in parameters)
    return SetParametersResult(successful=not wrong, reason="not thirteen" if wrong else "")


@pytest.fixture
def begin() -> Iterator[Callable[..., Bench]]:
    made: list[Bench] = []

    def make(*, control: bool) -> Bench:
        made.append(Bench(control=control))
        return made[-1]

    yield make
    for one in made:
        one.close()


def test_a_page_that_only_shows_is_refused_by_the_server(begin: Callable[..., Bench]) -> None:
    bench = begin(control=False)
    with bench.connect() as client:
        status = header_where(client, lambda header: header["type"] == "status")
        assert "offers" not in status
        client.send('{"id":1,"do":"tare","skin":"/plate"}')
        answer = header_where(client, lambda header: header["type"] == "answer")
        assert (answer["done"], bench.called) == (False, [])
        assert "--control" in answer["text"]


def test_what_is_asked_is_bounded_and_a_service_that_is_silent_holds_nothing_up(begin: Callable[..., Bench]) -> None:
    bench = begin(control=True)
    both = ("/plate", "/stuck")
    with bench.connect() as client:
        # Of a service that is not reached yet it is said so at once.
        header_where(client, lambda header: all(["tare", skin] in header.get("offers", []) for skin in both))
        refused: list[dict[str, Any]] = [
            {"do": "tare", "skin": "/nowhere"},
            {"do": "shutdown", "skin": "/plate"},
            {"do": "set", "skin": "/plate", "name": "port", "value": "/dev/null"},
            {"do": "set", "skin": "/plate", "name": "m", "value": 1e9},
            {"do": "set", "skin": "/plate", "name": "m", "value": 5.5},
            {"do": "set", "skin": "/plate", "name": "scheme", "value": "none"},
        ]
        for number, request in enumerate(refused):
            client.send(json.dumps({"id": number, **request}))
            answer = header_where(client, lambda header, number=number: header.get("id") == number)  # type: ignore[misc]
            assert answer["done"] is False
            assert answer["text"]
        # As soon as its client is connected it is asked, and what comes after is answered before it.
        client.send('{"id":50,"do":"tare","skin":"/stuck"}')
        client.send('{"id":51,"do":"tare","skin":"/plate"}')
        order: list[dict[str, Any]] = []
        header_where(client, lambda header: header["type"] == "answer" and (order.append(header) or len(order) == 2))  # type: ignore[func-returns-value]
        assert [one["id"] for one in order] == [51, 50]
        assert [one["done"] for one in order] == [True, False]
        assert "did not answer" in order[1]["text"]
        assert bench.view._control is not None
        assert not bench.view._control._clients["/stuck/driver/tare"]._pending_requests
        for number in range(60, 66):
            client.send(json.dumps({"id": number, "do": "tare", "skin": "/stuck"}))
        first = header_where(client, lambda header: header["type"] == "answer")
        assert (first["id"], first["done"]) == (64, False)
        assert "wait for their answers" in first["text"]
    assert bench.called == ["driver/tare"]


def test_a_stop_is_done_where_the_node_refuses_all_else_for_what_waits(
    begin: Callable[..., Bench], monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = begin(control=True)
    monkeypatch.setattr(control, "_WAITING_MAX", 0)
    with bench.connect() as client:
        header_where(client, lambda header: ["stop_grasp", "/hand"] in header.get("offers", []))
        client.send('{"id":1,"do":"grasp","skin":"/hand"}')
        client.send('{"id":2,"do":"stop_grasp","skin":"/hand"}')
        assert "requests wait" in header_where(client, lambda header: header.get("id") == 1)["text"]
        assert header_where(client, lambda header: header.get("id") == 2)["done"]
    assert bench.called == ["hand_reflexes/stop"]


def test_a_stop_does_not_wait_for_the_disk_of_a_recording(
    begin: Callable[..., Bench], monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = begin(control=True)
    disk = threading.Event()
    monkeypatch.setattr(bench.view._recording, "start", lambda: str(disk.wait(DEADLINE_S)))
    # Not on the executor, which waits for the disk.
    stopped = PolledService(bench.stuck.create_service(Trigger, "/slow/hand_reflexes/stop", bench.callback("slow", "")))
    with bench.connect() as client:
        header_where(client, lambda header: ["stop_grasp", "/slow"] in header.get("offers", []))
        client.send('{"id":1,"do":"record"}')
        client.send('{"id":2,"do":"stop_grasp","skin":"/slow"}')
        try:
            _, asked = wait_for(stopped.take, "the stop", DEADLINE_S)
            assert not disk.is_set()
            stopped.answer(Trigger.Response(success=True, message="stopped"), asked)
        finally:
            disk.set()
        assert header_where(client, lambda header: header.get("id") == 2)["text"] == "stopped"


def test_what_nobody_serves_any_more_is_not_offered(begin: Callable[..., Bench]) -> None:
    bench = begin(control=True)
    with bench.connect() as client:
        header_where(client, lambda header: ["tare", "/plate"] in header.get("offers", []))
        # Once it has been called there is a client, which keeps the name in the graph.
        client.send('{"id":1,"do":"tare","skin":"/plate"}')
        assert header_where(client, lambda header: header.get("id") == 1)["done"]
        # The executor may not meet what is being destroyed.
        bench.spinning.do(lambda: bench.driver.destroy_service(bench.services["/plate/tare"]))
        status = header_where(
            client, lambda header: ["tare", "/plate"] not in header.get("offers", [["tare", "/plate"]])
        )
        assert ["calibrate", "/plate"] in status["offers"]
        # It may come back.
        bench.spinning.do(lambda: bench.driver.create_service(Trigger, "~/tare", bench.callback("driver", "tare")))
        header_where(client, lambda header: ["tare", "/plate"] in header.get("offers", []))
        client.send('{"id":2,"do":"tare","skin":"/plate"}')
        assert header_where(client, lambda header: header.get("id") == 2)["done"]


def test_what_was_set_is_what_is_told_from_then_on(begin: Callable[..., Bench]) -> None:
    bench = begin(control=True)
    with bench.connect() as client:
        header_where(client, lambda header: header.get("settings", {}).get("/plate", {}).get("m") == 55)
        for value in (60, 61, 62):
            client.send(json.dumps({"id": value, "do": "set", "skin": "/plate", "name": "m", "value": value}))
            assert header_where(client, lambda header, value=value: header.get("id") == value)["done"]  # type: ignore[misc]
            told = header_where(client, lambda header: "/plate" in header.get("settings", {}))
            assert told["settings"]["/plate"]["m"] == value


def test_a_page_is_told_that_a_service_was_not_asked_and_asks_again(
    begin: Callable[..., Bench], monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = begin(control=True)
    refused: list[object] = []
    call_async = Client.call_async

    def refuse_first_of_each(one: Client, asked: object) -> Any:
        if type(asked) not in refused:
            refused.append(type(asked))
            raise rclpy_implementation.RCLError("failed to send request: cannot publish data, at x.cpp:68")
        return call_async(one, asked)

    with bench.connect() as client:
        header_where(client, lambda header: header.get("settings", {}).get("/plate", {}).get("m") == 55)
        header_where(client, lambda header: ["stop_balancing", ""] in header.get("offers", []))
        monkeypatch.setattr(Client, "call_async", refuse_first_of_each)
        client.send('{"id":1,"do":"stop_balancing"}')
        answer = header_where(client, lambda header: header.get("id") == 1)
        assert (answer["done"], bench.called) == (False, [])
        assert answer["text"] == (
            "/ball_control/stop was not asked: failed to send request: cannot publish data; ask again"
        )
        client.send('{"id":2,"do":"stop_balancing"}')
        assert header_where(client, lambda header: header.get("id") == 2)["done"]
        assert bench.called == ["ball_control/stop"]
        # The look for the settings, too, comes again.
        bench.driver.set_parameters([Parameter("m", value=70)])
        header_where(client, lambda header: header.get("settings", {}).get("/plate", {}).get("m") == 70)
        assert set(refused) == {Trigger.Request, GetParameters.Request}


def test_questions_that_nobody_answers_do_not_add_up(
    begin: Callable[..., Bench], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of the settings of a driver, and of what a skin is like, the page's node asks every second."""
    bench = begin(control=True)
    asked: dict[str, list[Client]] = {"/stuck/driver/get_parameters": [], "/stuck/reconstruction/get_parameters": []}
    call_async = Client.call_async

    def noted(one: Client, question: object) -> Any:
        future = call_async(one, question)
        if one.srv_name in asked:
            asked[one.srv_name].append(one)
        return future

    monkeypatch.setattr(Client, "call_async", noted)
    # Nobody spins this one, either.
    silent = Node("reconstruction", namespace="/stuck", context=bench.view.context)
    silent.create_publisher(Contact, "contact", qos.STREAM)
    with bench.connect():
        for clients in asked.values():
            wait_for(lambda clients=clients: len(clients) >= 3, "three questions", DEADLINE_S)  # type: ignore[misc]
    assert [len(clients[-1]._pending_requests) for clients in asked.values()] == [1, 1]
    silent.destroy_node()


@needs_browser
def test_every_button_calls_its_service_and_shows_the_answer(
    begin: Callable[..., Bench], open_page: Callable[..., Page]
) -> None:
    bench = begin(control=True)
    page = open_page(bench, is_live=False)
    line = page.locator("#controls .answer")
    for namespace, buttons in BUTTONS.items():
        group = page.locator(f'#controls .group[data-of="{namespace}"]')
        for what, title in buttons.items():
            group.get_by_text(title, exact=True).click()
            expect(line).to_have_text(f"{title}, {namespace or '/'}: {what} was heard")
            expect(line).to_have_attribute("data-done", str(what != "calibrate").lower())
            assert bench.called[-1] == f"{SERVERS[namespace]}/{what}"
    group = page.locator('#controls .group[data-of="/plate"]')
    expect(group.locator("[data-name=m]")).to_have_value("55")
    group.locator("[data-name=m]").fill("64")
    group.locator("[data-name=m]").press("Enter")
    expect(line).to_have_text("Taxels a frame, /plate: set")
    group.locator("[data-name=scheme]").select_option("tracking")
    expect(line).to_have_text("Scheme, /plate: set")
    group.locator("[data-name=threshold_counts]").fill("30")
    group.locator("[data-name=threshold_counts]").press("Enter")
    expect(line).to_have_text("Threshold, /plate: set")
    values = [bench.driver.get_parameter(name).value for name in ("scheme", "m", "threshold_counts")]
    assert values == ["tracking", 64, 30]
    group.locator("[data-name=m]").fill("13")
    group.locator("[data-name=m]").press("Enter")
    expect(line).to_have_text("Taxels a frame, /plate: not thirteen")
