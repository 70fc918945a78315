# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The nodes around all skins, over DDS; ROS_DOMAIN_IDs 163 to 167."""

from __future__ import annotations

import importlib.util
import itertools
import math
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import TransformStamped
from peers import Peers

from acts_core.errors import REFUSED_EXIT_CODE
from acts_msgs.msg import Contact, Contacts, SkinContacts, SkinState, TrackedContact
from acts_ros import qos
from acts_ros.messages.cdr import header_bytes

pytestmark = pytest.mark.slow

DEADLINE_S = 60.0

SKINS = """
base_frame: torso
frames:
  shoulder: {parent: torso, position_m: [0, 0, 0.5]}
skins:
  left: {pose: {parent: shoulder, position_m: [0, 0.2, 0]}}
  right: {pose: {parent: torso, position_m: [0, -0.2, 0], rpy_rad: [1.5707963267948966, 0, 0]}}
"""


class Robot(Peers):
    """Plays the skins, and hears what the program says."""

    timeout_s = DEADLINE_S
    turn_s = 0.005

    def __init__(self, domain_id: int) -> None:
        super().__init__(domain_id, "robot")
        self.merged = self.listen(SkinContacts, "skin_contacts", qos.STREAM)
        self._skins: dict[str, Any] = {}

    def skin(self, name: str, kind: type = Contacts) -> Any:
        topic = "contacts" if kind is Contacts else "contact"
        self._skins[name] = self.peer.create_publisher(kind, f"{name}/{topic}", qos.STREAM)
        return self._skins[name]

    def press(self, name: str, *forces_n: float, ahead_s: float = 0.0, frame_id: str = "") -> None:
        """Send the contacts of a skin as of now, each a centimetre further along x."""
        message = Contacts()
        self._head(message, name, ahead_s, frame_id)
        for number, force_n in enumerate(forces_n, 1):
            contact = TrackedContact(number=number, force=force_n, area=1e-4, active_taxels=4)
            contact.position.x, contact.position.y = 0.01 * number, 0.02
            contact.position_sigma.x, contact.position_sigma.y = 0.001, 0.002
            message.contacts.append(contact)
        self._skins[name].publish(message)

    def send(self, name: str, data: bytes) -> None:
        """Send bytes as the contacts of a skin."""
        self._skins[name].publish(data)

    def press_as_one(self, name: str, force_n: float) -> None:
        message = Contact(in_contact=True, force=force_n)
        self._head(message, name, 0.0, "")
        self._skins[name].publish(message)

    def _head(self, message: Any, name: str, ahead_s: float, frame_id: str) -> None:
        stamp_ns = self.peer.get_clock().now().nanoseconds + round(ahead_s * 1e9)
        message.header.frame_id = frame_id or name
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp_ns, 10**9)

    def situation(self) -> object:
        return self.merged[-1:]


@pytest.fixture
def robot(request: pytest.FixtureRequest) -> Iterator[Robot]:
    made = Robot(request.param)
    yield made
    made.close()


@contextmanager
def running(folder: Path, domain_id: int, *words: str, module: str = "contacts") -> Iterator[subprocess.Popen[str]]:
    path = folder / "skins.yaml"
    path.write_text(SKINS)
    nodes = ["skin_frames", "skin_diagnostics", *(["skin_contacts"] if module == "contacts" else [])]
    command = [sys.executable, "-m", "acts_ros.executables.program", f"acts_skins.{module}.main"]
    command += [word for node in nodes for word in ("--set", f"{node}.skins_file={path}")]
    environment = {**os.environ, "ROS_DOMAIN_ID": str(domain_id), "ROS_PYTHON_CHECK_FIELDS": "1"}
    with subprocess.Popen(
        [*command, *words], env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def ended_in_order(process: subprocess.Popen[str]) -> str:
    process.send_signal(signal.SIGINT)
    output, _ = process.communicate(timeout=DEADLINE_S)
    assert process.returncode == 0, output
    assert "Traceback" not in output
    return output


def states(message: SkinContacts) -> dict[str, int]:
    return {skin.name: skin.state for skin in message.skins}


FRESH, STALE, LOST = SkinState.STATE_FRESH, SkinState.STATE_STALE, SkinState.STATE_LOST


@pytest.mark.parametrize("robot", [163], indirect=True)
def test_contacts_of_two_skins_in_one_frame_and_a_skin_lost_and_found(robot: Robot, tmp_path: Path) -> None:
    robot.skin("left")
    robot.skin("right")
    reports = robot.listen(DiagnosticArray, "/diagnostics", 10)

    def both() -> None:
        robot.press("left", 2.0)
        robot.press("right", 3.0, 4.0)

    def told(words: str) -> bool:
        statuses = [status for array in reports for status in array.status if status.name == "skin_contacts"]
        return any(words in status.message and status.level == DiagnosticStatus.WARN for status in statuses)

    # Longer than this machine stands still.
    patient = ("stale_after_s=1.0", "lost_after_s=3.0")
    words = [word for setting in patient for word in ("--set", f"skin_contacts.{setting}")]
    with running(tmp_path, 163, *words) as process:
        robot.until(lambda: bool(robot.merged) and len(robot.merged[-1].contacts) == 3, both)
        message = robot.merged[-1]
        assert message.header.frame_id == "torso"
        assert states(message) == {"left": FRESH, "right": FRESH}
        assert [(contact.skin, contact.link, contact.number) for contact in message.contacts] == [
            ("left", "shoulder", 1),
            ("right", "torso", 1),
            ("right", "torso", 2),
        ]
        left, right, _ = message.contacts
        assert (left.position.x, left.position.y, left.position.z) == pytest.approx((0.01, 0.22, 0.5))
        assert (left.force.x, left.force.y, left.force.z) == pytest.approx((0.0, 0.0, -2.0))
        assert (right.position.x, right.position.y, right.position.z) == pytest.approx((0.01, -0.2, 0.02))
        assert (right.force.x, right.force.y, right.force.z) == pytest.approx((0.0, 3.0, 0.0), abs=1e-6)
        assert (right.normal.x, right.normal.y, right.normal.z) == pytest.approx((0.0, -1.0, 0.0), abs=1e-6)
        assert (right.position_sigma.x, right.position_sigma.z) == pytest.approx((0.001, 0.002))
        stamps = [(skin.stamp.sec, skin.stamp.nanosec) for skin in message.skins]
        assert max(stamps) <= (message.header.stamp.sec, message.header.stamp.nanosec)

        # The right one falls silent.
        robot.until(lambda: states(robot.merged[-1])["right"] == STALE, lambda: robot.press("left", 2.0))
        assert {contact.skin for contact in robot.merged[-1].contacts} == {"left", "right"}
        robot.until(lambda: states(robot.merged[-1])["right"] == LOST, lambda: robot.press("left", 2.0))
        assert states(robot.merged[-1])["left"] == FRESH
        assert {contact.skin for contact in robot.merged[-1].contacts} == {"left"}
        robot.until(lambda: told("right is lost: no contacts for"), lambda: robot.press("left", 2.0))
        # And comes again.
        robot.until(lambda: len(robot.merged[-1].contacts) == 3, both)
        output = ended_in_order(process)
    assert output.count("skin right: lost") == 1
    assert output.count("skin right: there") == 2


@pytest.mark.parametrize("robot", [164], indirect=True)
def test_what_cannot_be_is_dropped_and_told(robot: Robot, tmp_path: Path) -> None:
    robot.skin("left")
    robot.skin("right")
    reports = robot.listen(DiagnosticArray, "/diagnostics", 10)

    def send(rest: bytes) -> None:
        robot.send("left", header_bytes(robot.peer.get_clock().now().nanoseconds, "left") + rest)

    def told(words: str) -> bool:
        return any(words in status.message for array in reports for status in array.status)

    def reports_newest_only() -> None:
        del reports[:-1]

    with running(tmp_path, 164) as process:
        # One kind after the other: of several in a cycle only the newest is merged.
        robot.until(
            lambda: told("contacts of left with impossible values dropped"), lambda: robot.press("left", math.nan, 2.0)
        )
        robot.until(
            lambda: told("contacts of left in the frame 'elsewhere' dropped"),
            lambda: robot.press("left", 9.0, frame_id="elsewhere"),
        )
        robot.until(lambda: told("contacts of left that cannot be read dropped"), lambda: send(b"\xff" * 60))
        robot.until(
            lambda: told("contacts of left in messages of more than 65536 bytes dropped"),
            lambda: send(bytes(100_000)),
        )
        robot.until(
            lambda: told("right is lost: no contacts yet, stamps lie 100 s ahead of this clock"),
            lambda: robot.press("right", 3.0, ahead_s=100.0),
        )
        # What is told of a clock is of what comes now.
        reports.clear()
        robot.until(lambda: told("right is lost: no contacts yet") and not told("ahead of"), reports_newest_only)
        robot.until(
            lambda: told("right is lost: its contacts are 10 s old when they come: its clock lies behind this clock"),
            lambda: robot.press("right", 3.0, ahead_s=-10.0),
        )
        robot.until(
            lambda: bool(robot.merged) and bool(robot.merged[-1].contacts), lambda: robot.press("left", math.nan, 2.0)
        )
        assert [contact.number for contact in robot.merged[-1].contacts] == [2]
        assert robot.merged[-1].contacts[0].force.z == pytest.approx(-2.0)
        ended_in_order(process)


@pytest.mark.parametrize("is_readable", [False, True])
@pytest.mark.parametrize("robot", [164], indirect=True)
def test_a_skin_of_whose_contacts_none_can_be_used_is_lost_and_not_untouched(
    robot: Robot, tmp_path: Path, is_readable: bool
) -> None:
    """They cannot be read, as of another machine with messages of another release, or have impossible values."""
    robot.skin("left")
    reports = robot.listen(DiagnosticArray, "/diagnostics", 10)
    why = "with impossible values" if is_readable else "that cannot be read"
    wanted = ("left is lost: its newest contacts cannot be used", f"of left {why} dropped")

    def send() -> None:
        if is_readable:
            robot.press("left", math.nan, math.inf)
        else:
            robot.send("left", header_bytes(robot.peer.get_clock().now().nanoseconds, "left") + b"\xff" * 60)

    with running(tmp_path, 164) as process:
        robot.until(
            lambda: any(all(words in one.message for words in wanted) for array in reports for one in array.status),
            send,
        )
        assert {states(message)["left"] for message in robot.merged} == {LOST}
        robot.until(lambda: states(robot.merged[-1])["left"] == FRESH, lambda: robot.press("left", 2.0))
        assert [contact.skin for contact in robot.merged[-1].contacts] == ["left"]
        # Nobody touches it.
        robot.until(lambda: not robot.merged[-1].contacts, lambda: robot.press("left"))
        assert states(robot.merged[-1])["left"] == FRESH
        ended_in_order(process)


@pytest.mark.parametrize("robot", [164], indirect=True)
def test_a_skin_that_is_lost_and_there_by_turns_is_logged_a_few_times_a_second(robot: Robot, tmp_path: Path) -> None:
    robot.skin("left")
    forces_n = itertools.cycle(4 * [math.nan] + 4 * [2.0])  # longer than a cycle of the node each
    changes = 0

    def press() -> None:
        nonlocal changes
        seen = [states(message)["left"] for message in robot.merged]
        changes += sum(one != other for one, other in itertools.pairwise(seen))
        robot.merged[:-1] = []
        robot.press("left", next(forces_n))

    with running(tmp_path, 164) as process:
        begin_s = time.monotonic()
        robot.until(lambda: changes >= 50, press)
        lasted_s = time.monotonic() - begin_s
        lines = [line for line in ended_in_order(process).splitlines() if "skin left: " in line]
    assert 4 <= len(lines) <= 4 * (1 + lasted_s)


@pytest.mark.parametrize("robot", [165], indirect=True)
def test_another_base_all_that_presses_as_one_and_a_thousand_times_a_second(robot: Robot, tmp_path: Path) -> None:
    robot.skin("left", Contact)
    words = [f"skin_contacts.{name}" for name in ("base_frame=left", "topic=contact", "rate_hz=1000")]
    with running(tmp_path, 165, *(part for word in words for part in ("--set", word))) as process:
        robot.until(
            lambda: bool(robot.merged) and bool(robot.merged[-1].contacts), lambda: robot.press_as_one("left", 5.0)
        )
        message = robot.merged[-1]
        assert message.header.frame_id == "left"
        (contact,) = message.contacts
        assert (contact.number, contact.force.z) == (0, pytest.approx(-5.0))
        ended_in_order(process)


@pytest.mark.parametrize("robot", [166], indirect=True)
def test_poses_are_kept_for_late_joiners_and_the_aggregate_names_the_skin(robot: Robot, tmp_path: Path) -> None:
    publisher = robot.peer.create_publisher(DiagnosticArray, "/diagnostics", 10)

    def report() -> None:
        for skin, level, message in (
            ("left", DiagnosticStatus.OK, "1000 frames/s"),
            ("right", DiagnosticStatus.ERROR, "gone"),
        ):
            statuses = [
                DiagnosticStatus(name=f"{skin}/{node}", level=level, message=message)
                for node in ("driver", "reconstruction")
            ]
            publisher.publish(DiagnosticArray(status=statuses))

    with running(tmp_path, 166, module="overview") as process:
        arrays = robot.listen(DiagnosticArray, "/diagnostics_agg", 10)
        wholes = robot.listen(DiagnosticStatus, "/diagnostics_toplevel_state", 10)
        # At first one of the skins may have been heard of alone.
        words = "right: driver: gone; reconstruction: gone"
        robot.until(lambda: bool(wholes) and wholes[-1].message == words, report)
        robot.until(lambda: bool(arrays) and arrays[-1].status[0].message == words, report)
        assert wholes[-1].level == arrays[-1].status[0].level == DiagnosticStatus.ERROR
        by_name = {status.name: status for status in arrays[-1].status}
        assert by_name["/Skins/left"].level == DiagnosticStatus.OK
        assert by_name["/Skins/right/driver"].message == "gone"
        # They joined long after it was sent.
        poses = robot.listen(TransformStamped, "right/pose", qos.LATCHED)
        robot.until(lambda: bool(poses))
        assert (poses[0].header.frame_id, poses[0].child_frame_id) == ("torso", "right")
        assert poses[0].transform.translation.y == -0.2
        assert poses[0].transform.rotation.x == pytest.approx(math.sqrt(0.5))
        if importlib.util.find_spec("tf2_msgs") is not None:
            from tf2_msgs.msg import TFMessage

            trees = robot.listen(TFMessage, "/tf_static", qos.LATCHED)
            robot.until(lambda: bool(trees))
            assert {transform.child_frame_id for transform in trees[0].transforms} == {"shoulder", "left", "right"}
        output = ended_in_order(process)
    assert ("no /tf_static" in output) == (importlib.util.find_spec("tf2_msgs") is None)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--set", "skin_contacts.skins_file="], "error: skins_file is missing"),
        (["--set", "skin_contacts.base_frame=moon"], "skins.yaml:6: skin left: the frame left is fixed to torso"),
        (["--set", "skin_contacts.rate=5"], "unknown key 'rate'; did you mean 'rate_hz'?"),
    ],
)
def test_what_is_wrong_at_the_start_is_told_in_one_line(tmp_path: Path, words: list[str], message: str) -> None:
    with running(tmp_path, 167, *words) as process:
        output, _ = process.communicate(timeout=DEADLINE_S)
    assert process.returncode == REFUSED_EXIT_CODE
    assert message in output
    assert "Traceback" not in output
