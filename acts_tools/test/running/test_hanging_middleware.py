# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A command whose middleware hangs ends with a word, and what it has recorded can be read. ROS_DOMAIN_ID 181."""

from __future__ import annotations

import os
import subprocess
import sys
from itertools import count
from pathlib import Path

import pytest
from held_timers import hold_timers
from rclpy.qos import QoSProfile
from std_msgs.msg import String

from acts_ros.bags.reading import open_bag
from acts_tools.testing.probe import Probe

pytestmark = pytest.mark.slow

DEADLINE_S = 60.0
RECORD = """
import sys
from acts_ros.executables import middleware_watch
from acts_tools.cli import main
middleware_watch.PERIOD_S = 0.2
sys.exit(main())
"""


def test_a_recording_whose_middleware_hangs_ends_and_can_be_read(tmp_path: Path) -> None:
    path = tmp_path / "touch"
    with (
        Probe(181) as probe,
        subprocess.Popen(
            [sys.executable, "-c", RECORD, "record", "-o", str(path), "/words"],
            env={**os.environ, "ROS_DOMAIN_ID": "181"},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        ) as process,
    ):
        try:
            words = probe.node.create_publisher(String, "/words", QoSProfile(depth=1))
            probe.wait_for(lambda: words.get_subscription_count() > 0, DEADLINE_S, "the recorder")
            hold_timers(process.pid)
            numbers = count()

            def ended() -> bool:
                words.publish(String(data=str(next(numbers))))
                return process.poll() is not None

            probe.wait_for(ended, DEADLINE_S, "the end of the recorder")
            _, errors = process.communicate(timeout=DEADLINE_S)
        finally:
            process.kill()
    assert process.returncode == 1
    assert "error: Fast DDS hangs: its timers have not run for 2 s" in errors
    with open_bag(path) as bag:
        received = [data for _, _, data in bag.messages(["/words"])]
    # It recorded until a quarter of a second before its end.
    assert len(received) > 10
