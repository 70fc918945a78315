# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node ``view``, a skin that a test plays, and what a page of it is sent."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import rclpy
from numpy.typing import NDArray
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from spinning import Spinning
from view_messages import decode
from waiting import text_of, wait_for
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

from acts_msgs.msg import Contact
from acts_ros import qos
from acts_ros.messages import ContactFields, write_contact
from acts_view.nodes.view_node import ViewNode

DEADLINE_S = 30.0
SHAPE = {"layout": "leap_right", "rows": 32, "cols": 32, "pitch_m": 0.0, "row_pitch_m": 0.0, "touch_counts": 50}
SHAPE |= {"force_full_scale_counts": 1000.0, "force_dead_n": 0.01, "force_half_n": 0.5, "force_response": ""}


def header_where(client: ClientConnection, condition: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
    """What the first message to a page that fulfils a condition says of itself."""

    def next_one() -> dict[str, Any] | None:
        header, _ = decode(client.recv(DEADLINE_S))  # type: ignore[arg-type]
        return header if condition(header) else None

    return wait_for(next_one, lambda: text_of(condition), DEADLINE_S, meanwhile=lambda: None)


class Bench:
    """The node, a skin that a test plays, and what pages were sent; all within `namespace`, as of a launch file."""

    def __init__(self, domain_id: int, namespace: str = "", **parameters: str) -> None:
        self._context = Context()
        rclpy.init(context=self._context, domain_id=domain_id)
        self.skin = Node("skin", namespace=f"{namespace}/hand", context=self._context)
        # The node asks this one what the skin is like.
        self._reconstruction = Node("reconstruction", namespace=f"{namespace}/hand", context=self._context)
        for name, value in SHAPE.items():
            self._reconstruction.declare_parameter(name, value)
        self.contact = self.skin.create_publisher(Contact, "contact", qos.STREAM)
        given = {"port": 0, "outlines": True, **parameters}
        options = [Parameter(name, value=value) for name, value in given.items()]
        self.view = ViewNode(context=self._context, namespace=namespace, parameter_overrides=options)
        self.spinning = Spinning(self._context, self.skin, self._reconstruction, self.view)
        self.headers: dict[str, dict[str, Any]] = {}
        self.arrays: dict[str, NDArray[Any]] = {}
        self.history: list[NDArray[np.float32]] = []
        self._sequence = 0

    def connect(self) -> ClientConnection:
        address = self.view.address
        origin = Origin(address.url.rstrip("/"))
        return connect(f"ws://127.0.0.1:{address.port}/stream", origin=origin, compression=None)

    def press(self, force_n: float) -> None:
        self._sequence += 1
        stamp_ns = self.skin.get_clock().now().nanoseconds
        fields = ContactFields(
            stamp_ns, "hand", self._sequence, True, 0.01, 0.02, force_n, 700.0, 1e-4, 5, 0.002, 0, 0, 0, 0, 0
        )
        self.contact.publish(write_contact(fields))

    @property
    def diagnostics(self) -> list[dict[str, Any]]:
        """Of the last status; none before the first has come."""
        return list(self.headers.get("status", {}).get("diagnostics", []))

    def is_pressed_with(self, force_n: float) -> bool:
        """Whether the last frame says so."""
        touch = self.headers["frame"]["touch"]
        return touch is not None and bool(touch[2] == force_n)

    def destroy(self, publishers: list[Publisher]) -> None:
        # The executor may not meet one that is being destroyed.
        self.spinning.do(lambda: [self.skin.destroy_publisher(one) for one in publishers])

    def until(self, condition: Callable[[], bool], client: ClientConnection, meanwhile: Callable[[], Any]) -> None:
        def turn() -> None:
            meanwhile()
            self.read(client)

        wait_for(condition, timeout_s=DEADLINE_S, meanwhile=turn, state=lambda: (self.headers, self.arrays))

    def read(self, client: ClientConnection) -> None:
        patience_s = 0.02
        while True:
            try:
                message = client.recv(timeout=patience_s)
            except TimeoutError:
                return
            patience_s = 0.001
            header, arrays = decode(message)  # type: ignore[arg-type]
            self.headers[header["type"]] = header
            if header["type"] == "frame":
                self.arrays = arrays
                self.history.append(arrays["history"])

    def close(self) -> None:
        self.spinning.end()
        self.view.close()
        for node in (self.view, self._reconstruction, self.skin):
            node.destroy_node()
        rclpy.try_shutdown(context=self._context)
