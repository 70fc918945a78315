# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Several skins, launched for real: merged contacts, poses, the aggregate, losses. ROS_DOMAIN_ID 168 and 169."""

import os
import signal
import time
from collections import deque
from pathlib import Path

import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import TransformStamped
from launch_support import PACKAGE, START_S, pid_of
from pressed_frames import disc_recording

from acts_core.array import ArrayGeometry
from acts_msgs.msg import SkinContacts, SkinState
from acts_ros.messages import stamp_ns_of
from acts_ros.qos import STREAM
from acts_tools.testing.launch_runner import Launched, LaunchFile, launch_fixture, launch_test

pytestmark = pytest.mark.slow


def skins_file(folder: Path) -> Path:
    """Two skins that feel the same disc, the second a metre above the first and upside down."""
    disc = disc_recording(folder)
    # Slow, so that late frames on busy cores, which are told, keep nothing from being well.
    source = f"recording: {disc}, recording_rate_hz: 30, driver: {{rate_cap_hz: 200}}"
    path = folder / "skins.yaml"
    path.write_text(
        "base_frame: torso\nskins:\n"
        f"  low: {{{source}, pose: {{parent: torso}}}}\n"
        f"  high: {{{source}, pose: {{parent: torso, position_m: [0, 0, 1], quaternion_xyzw: [1, 0, 0, 0]}}}}\n"
    )
    return path


@launch_fixture
def two_skins(tmp_path: Path) -> LaunchFile:
    arguments = {"run_dir": str(tmp_path / "run"), "skins_file": str(skins_file(tmp_path))}
    return LaunchFile(PACKAGE, "skins.launch.xml", 168, arguments)


class Merged:
    """All merged contacts: a skin is lost for a shorter time than a new subscription may take."""

    def __init__(self, launched: Launched) -> None:
        self._launched = launched
        self._unread: deque[SkinContacts] = deque()
        self._since_ns = 0
        launched.probe.node.create_subscription(
            SkinContacts, "/skin_contacts", lambda message: self._unread.append(message), STREAM
        )

    def wait_for(self, low: int, high: int) -> SkinContacts:
        """The first message since the last call that has these states of the skins."""
        found: list[SkinContacts] = []

        def is_reached() -> bool:
            while self._unread and not found:
                message = self._unread.popleft()
                states = {skin.name: skin.state for skin in message.skins}
                skins = {contact.skin for contact in message.contacts}
                felt = {name for name, state in (("low", low), ("high", high)) if state == SkinState.STATE_FRESH}
                is_new = stamp_ns_of(message) >= self._since_ns
                if is_new and states == {"low": low, "high": high} and skins == felt:
                    found.append(message)
            return bool(found)

        self._launched.probe.wait_for(is_reached, START_S, f"merged contacts with the states {low} and {high}")
        return found[0]

    def forget(self) -> None:
        """Pass over all that was measured before now."""
        self._since_ns = time.time_ns()


@launch_test(two_skins)
def test_skins_are_merged_and_a_lost_one_leaves_the_other_alone(two_skins: Launched, tmp_path: Path) -> None:
    fresh, lost = SkinState.STATE_FRESH, SkinState.STATE_LOST
    merged = Merged(two_skins)
    message = merged.wait_for(fresh, fresh)
    geometry = ArrayGeometry()
    x_m, y_m, close_m = float(geometry.x_m(24)), float(geometry.y_m(8)), geometry.pitch_m / 4
    assert message.header.frame_id == "torso"
    for contact in message.contacts:
        sign, z_m = (1, 0.0) if contact.skin == "low" else (-1, 1.0)
        assert contact.position.x == pytest.approx(x_m, abs=close_m)
        assert contact.position.y == pytest.approx(sign * y_m, abs=close_m)
        assert contact.position.z == pytest.approx(z_m, abs=1e-9)
        assert contact.force.z * sign < -0.5
    pose = two_skins.wait_for_message("/high/pose", TransformStamped)
    assert (pose.header.frame_id, pose.child_frame_id, pose.transform.translation.z) == ("torso", "high", 1.0)

    # Its board stands still, and goes on; then it dies, and is there again.
    board = pid_of(two_skins, "high/virtual_board")
    os.kill(board, signal.SIGSTOP)
    assert merged.wait_for(fresh, lost).header.frame_id == "torso"
    os.kill(board, signal.SIGCONT)
    merged.wait_for(fresh, fresh)
    os.kill(board, signal.SIGKILL)
    two_skins.wait_for(lambda: pid_of(two_skins, "high/virtual_board") != board, START_S, "another board")
    merged.forget()
    merged.wait_for(fresh, fresh)
    # The whole skin does.
    os.kill(pid_of(two_skins, "low/tactile"), signal.SIGKILL)
    merged.wait_for(lost, fresh)
    merged.wait_for(fresh, fresh)
    # What runs them all does.
    os.kill(pid_of(two_skins, "skins-1"), signal.SIGKILL)
    merged.wait_for(lost, lost)
    merged.wait_for(fresh, fresh)

    def is_well(whole: DiagnosticStatus) -> bool:
        return bool(whole.level == DiagnosticStatus.OK and whole.message == "2 skins, all well")

    two_skins.wait_for_message("/diagnostics_toplevel_state", DiagnosticStatus, START_S, is_well)
    assert two_skins.stop() == 0
    assert not [path for path in (tmp_path / "run").rglob("*") if not path.is_dir()]


@launch_fixture
def missing_skins(tmp_path: Path) -> LaunchFile:
    text = skins_file(tmp_path).read_text().replace("{recording", f"{{port: {tmp_path}/PORT, recording")
    for name in ("low", "high"):
        text = text.replace("PORT", name, 1)
    (tmp_path / "skins.yaml").write_text(text)
    arguments = {"skins_file": str(tmp_path / "skins.yaml"), "sim": "false", "merge": "false"}
    return LaunchFile(PACKAGE, "skins.launch.xml", 169, arguments)


@launch_test(missing_skins)
def test_skins_whose_boards_are_missing_are_named_in_the_aggregate(missing_skins: Launched) -> None:
    def names_both(whole: DiagnosticStatus) -> bool:
        return "low: driver: " in whole.message and "high: driver: " in whole.message

    missing_skins.wait_for_message("/diagnostics_toplevel_state", DiagnosticStatus, START_S, names_both)
    assert missing_skins.stop() == 0
