# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The look of a measurement into the ROS graph. ROS_DOMAIN_ID 133."""

from __future__ import annotations

from pathlib import Path

import pytest
from std_msgs.msg import UInt32

from acts_tools.bench.rigs.graph import Graph
from acts_tools.bench.workbench import Workbench
from acts_tools.running.stopping import StopFlag


def test_a_slice_ends_and_the_wish_to_stop_is_heard_where_messages_never_cease(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "133")
    stop = StopFlag()
    with Graph(Workbench(60.0, tmp_path, stop)) as graph:
        publisher = graph.node.create_publisher(UInt32, "flood", 1000)

        def answer(message: UInt32) -> None:
            # More than one, so that there is always a next one waiting.
            publisher.publish(message)
            publisher.publish(message)
            stop.is_set = True

        graph.node.create_subscription(UInt32, "flood", answer, 1000)
        graph.spin_until(lambda: publisher.get_subscription_count() > 0, 30.0, "the subscription")
        publisher.publish(UInt32())
        with pytest.raises(KeyboardInterrupt):
            graph.spin_for(3600.0)
