# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The process that feels is killed: touch is back soon, balancing goes on by itself, and a tare stays in force.

With ACTS_CRASHES=20 it is killed twenty times, while the ball is led along letters as well; with ACTS_STANDBY=false
without a spare process. ROS_DOMAIN_IDs 1 and 179.
"""

import os
import statistics
import time
from pathlib import Path

import pytest
from geometry_msgs.msg import PointStamped
from launch_support import LONG_S, PACKAGE, START_S, Feeling, patient_parameters
from pressed_frames import disc_recording
from std_srvs.srv import Trigger

from acts_msgs.msg import BalanceStatus, Baseline, Contact
from acts_ros.messages import ns_of
from acts_ros.qos import LATCHED, STATE, STREAM
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


@launch_fixture
def loaded(tmp_path: Path) -> LaunchFile:
    arguments = {"run_dir": str(tmp_path / "run"), "recording": str(disc_recording(tmp_path)), "standby": "true"}
    return LaunchFile(PACKAGE, "tactile.launch.xml", 1, arguments)


def tare(launched: Launched) -> None:
    client = launched.probe.node.create_client(Trigger, "/plate/driver/tare")
    launched.probe.wait_for(client.service_is_ready, LONG_S, "the service")
    response = Trigger.Response()
    # A driver that has just begun has too few frames for a tare.
    while not response.success:
        answer = client.call_async(Trigger.Request())
        launched.probe.wait_for(answer.done, LONG_S, "the answer")
        response = answer.result()


def await_stamps_after(late_ns: int, contacts: list[Contact], launched: Launched) -> None:
    def are_there() -> bool:
        return sum(ns_of(contact.header.stamp) > late_ns for contact in contacts) > 100

    launched.probe.wait_for(are_there, LONG_S, "contacts of a second later")


@launch_test(loaded)
def test_what_was_tared_is_not_felt_by_the_process_that_takes_over(loaded: Launched) -> None:
    feeling = Feeling(loaded)
    assert loaded.wait_for_message("/plate/contact", Contact, START_S).in_contact
    tare(loaded)
    loaded.wait_for_message("/plate/contact", Contact, LONG_S, lambda contact: not contact.in_contact)
    contacts: list[Contact] = []
    baselines: list[Baseline] = []
    node = loaded.probe.node
    node.create_subscription(Contact, "/plate/contact", contacts.append, STREAM)
    node.create_subscription(Baseline, "/plate/baseline", baselines.append, LATCHED)
    loaded.probe.wait_for(lambda: bool(contacts and baselines), LONG_S, "the first of both")
    feeling.until_a_spare_is_ready()
    # The spare takes over, then a process that is started in its place before there is another spare.
    for _ in range(2):
        contacts.clear()
        baselines.clear()
        late_ns = round(1e9 * feeling.kill()) + 10**9
        await_stamps_after(late_ns, contacts, loaded)
        assert not [contact for contact in contacts if contact.in_contact]
        assert {baseline.source for baseline in baselines} == {Baseline.SOURCE_TARE}
    assert loaded.stop() == 0
