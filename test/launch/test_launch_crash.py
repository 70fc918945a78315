# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The process that feels is killed while a ball is balanced: touch is back soon, and balancing goes on by itself.

With ACTS_CRASHES=20 it is killed twenty times, while the ball is led along letters as well; with ACTS_STANDBY=false
without a spare process. ROS_DOMAIN_ID 179.
"""

import os
import re
import signal
import statistics
import time
from pathlib import Path

import pytest
from geometry_msgs.msg import PointStamped
from launch_support import LONG_S, PACKAGE, START_S, patient_parameters, pid_of

from acts_msgs.msg import BalanceStatus
from acts_ros.qos import STATE
from acts_tools.testing.launch_runner import Launched, LaunchFile, launch_fixture, launch_test

pytestmark = pytest.mark.slow

CRASHES = int(os.environ.get("ACTS_CRASHES", "1"))
STANDBY = os.environ.get("ACTS_STANDBY", "true") == "true"
# Older touch levels the plate (touch_stale_after_s).
STALE_S = 0.2
# Frames of the killed process that the controller takes later.
UNDER_WAY_S = 0.05
# A process that dies within 2 s of its start is restarted later and later.
BALANCED_S = 0.5 if CRASHES == 1 else 2.5
# The edge of the skin is 70 mm from its centre.
ON_THE_PLATE_M = 0.065


@launch_fixture
def balancing(tmp_path: Path) -> LaunchFile:
    arguments = {"run_dir": str(tmp_path / "run"), "robot_ip": "127.0.6.8", "standby": str(STANDBY).lower()}
    arguments["trajectory"] = "hold" if CRASHES == 1 else ",".join(["N", "B", "I"] * CRASHES)
    arguments["params_file"] = patient_parameters(tmp_path, touch_stop_after_s=60.0)
    return LaunchFile(PACKAGE, "ball_balancing.launch.xml", 179, arguments)


class Watch:
    """What the controller tells, and how far from the centre the ball was."""

    def __init__(self, launched: Launched) -> None:
        self._probe = launched.probe
        self.status = BalanceStatus()
        self.states: set[int] = set()
        self.farthest_m = 0.0
        self._probe.node.create_subscription(BalanceStatus, "/plate/ball/status", self._on_status, STATE)
        self._probe.node.create_subscription(PointStamped, "/plate/ball/truth", self._on_truth, STATE)

    def _on_status(self, status: BalanceStatus) -> None:
        self.status = status
        self.states.add(status.state)

    def _on_truth(self, truth: PointStamped) -> None:
        self.farthest_m = max(self.farthest_m, abs(truth.point.x), abs(truth.point.y))

    def until_balanced_for(self, seconds: float) -> None:
        """Wait until the ball has been balanced, on fresh touch, for a while [s]."""
        since_s = time.monotonic()

        def balanced() -> bool:
            nonlocal since_s
            status = self.status
            if status.state != BalanceStatus.STATE_BALANCING or status.touch_age > STALE_S:
                since_s = time.monotonic()
            return time.monotonic() - since_s > seconds

        self._probe.wait_for(balanced, START_S, "a ball that is balanced")

    def until_touch_is_back(self, killed_s: float) -> float:
        """Wait until touch is newer than what was under way when its process was killed; how long that took [s]."""

        def back() -> bool:
            stamp = self.status.header.stamp
            return stamp.sec + 1e-9 * stamp.nanosec - self.status.touch_age > killed_s + UNDER_WAY_S

        self._probe.wait_for(back, LONG_S, "touch")
        return time.time() - killed_s


class Feeling:
    """The process that feels, and the spare one."""

    def __init__(self, launched: Launched) -> None:
        self._launched = launched
        self._ready = 0
        self._name = ""

    def until_a_spare_is_ready(self) -> None:
        """Wait until another process than before says so."""
        self._ready += 1
        self._launched.wait_for(lambda: len(self._spares()) == self._ready, LONG_S, "a spare process")

    def kill(self) -> float:
        """Kill the process that feels; the time of that, as of stamps [s]."""
        names = set(re.findall(r"\[(tactile-\d+)\]: process started", self._launched.output))
        # The first spare is the one that has not felt yet; from then on they take turns.
        name = self._name or names.difference(self._spares()[-1:]).pop()
        self._name = (names - {name} or {name}).pop()
        os.kill(pid_of(self._launched, name), signal.SIGKILL)
        return time.time()

    def _spares(self) -> list[str]:
        return re.findall(r"\[(tactile-\d+)\] ready to take over", self._launched.output)


@pytest.mark.usefixtures("ur_rtde")
@launch_test(balancing)
def test_after_a_crash_of_the_process_that_feels_balancing_goes_on_by_itself(balancing: Launched) -> None:
    watch, feeling = Watch(balancing), Feeling(balancing)
    watch.until_balanced_for(1.0)
    watch.states.clear()
    watch.farthest_m = 0.0
    gaps_s = []
    for _ in range(CRASHES):
        if STANDBY:
            feeling.until_a_spare_is_ready()
        gaps_s.append(watch.until_touch_is_back(feeling.kill()))
        watch.until_balanced_for(BALANCED_S)
    print(
        f"touch was back after {' '.join(f'{gap:.2f}' for gap in gaps_s)} s, median {statistics.median(gaps_s):.2f} s"
    )
    print(f"the ball was never farther than {1000 * watch.farthest_m:.0f} mm from the centre")
    if CRASHES == 1 and STANDBY:
        # Again, before there is another spare: the process that was started last takes over, and imports first.
        watch.until_touch_is_back(feeling.kill())
        watch.until_balanced_for(BALANCED_S)
    assert watch.states == {BalanceStatus.STATE_BALANCING}
    assert watch.farthest_m < ON_THE_PLATE_M
    assert balancing.stop() == 0
