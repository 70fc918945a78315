# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Two views at once, as of a launch file and of ``acts view --control``, in what nodes say; ROS_DOMAIN_ID 5."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.node import Node
from view_node_bench import Bench

pytestmark = pytest.mark.slow

OTHER = "http://127.0.0.1:1/"


@pytest.fixture
def bench() -> Iterator[Bench]:
    made = Bench(5)
    yield made
    made.close()


def test_each_of_two_views_has_a_line_of_its_own(bench: Bench) -> None:
    other = Node("other", context=bench.skin.context)
    publisher = other.create_publisher(DiagnosticArray, "/diagnostics", 10)
    said = DiagnosticArray(status=[DiagnosticStatus(name="view", hardware_id=OTHER, message="7 pages open")])
    told: set[tuple[str, str]] = set()

    def meanwhile() -> None:
        publisher.publish(said)
        told.update((one["name"], one["message"]) for one in bench.diagnostics if one["name"].startswith("view"))

    expected = {("view", "1 page open"), (f"view ({OTHER})", "7 pages open")}
    with bench.connect() as client:
        bench.until(lambda: expected <= told, client, meanwhile)
        assert told - {("view", "0 pages open")} == expected
    other.destroy_node()
