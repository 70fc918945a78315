# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The driver node's process while the virtual board plays faults: its messages, its /diagnostics. ROS_DOMAIN_ID 50."""

from __future__ import annotations

import signal
import subprocess
import time
from collections.abc import Iterator

import known_field
import pytest
from driver_rig import Rig, end_process, start_process
from faulty_board import EARLY_NS, FaultyBoard
from pty_board import wait_for

from acts_ros.messages import frame_of

pytestmark = pytest.mark.slow


class Skin:
    """Board, driver process and listener."""

    def __init__(self, board: FaultyBoard, rig: Rig) -> None:
        self.board = board
        self.rig = rig
        options = ("-p", f"port:={board.link}", "-p", "reconnect_s:=0.05")
        self.driver: subprocess.Popen[str] = start_process(rig.domain_id, *options)
        self.counted: dict[str, int] = {}

    def wait_for_messages(self, count: int = 50) -> None:
        """Until some more have come that were measured after now."""
        now_ns = time.time_ns()

        def fresh() -> bool:
            stamps = (message.header.stamp for message in self.rig.samples[-count:])
            return sum(stamp.sec * 10**9 + stamp.nanosec > now_ns for stamp in stamps) == count

        self.rig.spin_until(fresh, "messages")

    def added(self) -> dict[str, int]:
        """What was counted since the last call."""
        # The report after the next one: the next may have been on its way already.
        status = self.rig.status_until(lambda status: "lost" in status, "a report")
        frames = int(status["frames"])
        status = self.rig.status_until(lambda status: int(status.get("frames", "0")) > frames, "a new report")
        before = self.counted
        self.counted = {name: int(value) for name, value in status.items() if value.isdigit() and name != "level"}
        return {name: count - before.get(name, 0) for name, count in self.counted.items()}

    def check(self) -> None:
        """Every message has the right values, comes once, and has a stamp that is not early."""
        last_ns = 0
        seen = set()
        for message in self.rig.samples:
            frame = frame_of(message)
            stamp_ns = message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
            # Without pauses of the board, its frames begin on whole milliseconds.
            on_board = frame._replace(board_us=1000 * frame.sequence + frame.duration_us)
            measured_ns = known_field.measured_at_ns(on_board, self.board.field_epoch_ns, self.board.epochs_ns)
            assert measured_ns is not None, f"wrong samples: {message}"
            assert measured_ns not in seen
            seen.add(measured_ns)
            assert stamp_ns > last_ns
            last_ns = stamp_ns
            assert measured_ns + self.board.realtime_minus_monotonic_ns - stamp_ns < EARLY_NS


@pytest.fixture(scope="module")
def skin(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Skin]:
    rig = Rig(domain_id=50)
    with FaultyBoard(tmp_path_factory.mktemp("skin"), "--scheme", "adaptive") as board:
        skin = Skin(board, rig)
        try:
            skin.wait_for_messages()
            skin.added()
            yield skin
        finally:
            end_process(skin.driver)
            rig.close()


def test_damage_is_counted_and_never_published(skin: Skin) -> None:
    for lost_bytes in range(600, 610):
        skin.wait_for_messages()
        # Doubles first: what is lost may end with a packet's delimiter, and then the next packet is damaged too.
        skin.board.inject("double:4", "drop:2", "garbage:3000", "flip:9", "truncate:3", f"lose:{lost_bytes}")
        skin.board.event(f"lose:{lost_bytes}", over=True)
        skin.wait_for_messages()
        added = skin.added()
        skin.check()
        is_read = added["malformed"] + added["crc_errors"] > 0 and added["repeated"] == 4
        if is_read or not (added["discarded"] or added["overruns"]):
            break
        # This machine was too slow for the board, and what was damaged was dropped unread: once more.
    assert added["malformed"] + added["crc_errors"] > 0
    assert added["repeated"] == 4
    assert added["lost"] >= 2
    assert added["lost"] - added["discarded"] <= 15 + added["overruns"]
    assert added["reconnects"] == 0


def test_a_port_that_goes_and_comes_back(skin: Skin) -> None:
    skin.wait_for_messages()
    # The driver reports once a second: for so long that it does meanwhile, also where a busy machine notices it late.
    skin.board.inject("unplug:2.5")
    words = ("is not there", "was lost")
    skin.rig.status_until(lambda s: s["level"] == "2" and any(word in s["message"] for word in words), "the error")
    skin.board.event("unplug:2.5", over=True)
    skin.wait_for_messages()
    added = skin.added()
    skin.check()
    assert (added["reconnects"], added["restarts"]) == (1, 0)
    assert added["lost"] >= 1000


def test_a_board_that_restarts(skin: Skin) -> None:
    skin.wait_for_messages()
    skin.board.inject("reset:0.3")
    skin.board.event("reset:0.3", over=True)
    skin.wait_for_messages()
    added = skin.added()
    skin.check()
    assert (added["restarts"], added["clock_resets"]) == (1, 1)


def test_firmware_of_another_version_is_told(skin: Skin) -> None:
    skin.wait_for_messages()
    skin.board.inject("version:7")
    skin.board.event("version:7", over=False)
    status = skin.rig.status_until(
        lambda status: status["message"].startswith("no frames") and "version 7" in status["message"], "the error"
    )
    assert status["level"] == "2"
    assert "install firmware and driver of the same release" in status["last_error"]
    skin.board.inject("version:1")
    skin.wait_for_messages()
    added = skin.added()
    skin.check()
    assert added["malformed"] > 0
    assert added["crc_errors"] == 0


def test_a_driver_that_stands_still(skin: Skin) -> None:
    skin.wait_for_messages()
    skin.driver.send_signal(signal.SIGSTOP)
    until_ns = time.monotonic_ns() + 1_500_000_000
    wait_for(lambda: time.monotonic_ns() > until_ns, "a second and a half")
    skin.driver.send_signal(signal.SIGCONT)
    skin.wait_for_messages()
    added = skin.added()
    skin.check()
    assert added["overruns"] > 0
    assert added["lost"] - added["discarded"] <= added["overruns"] <= added["lost"]
    names = ("crc_errors", "malformed", "reconnects", "restarts", "clock_resets")
    assert {name: added[name] for name in names} == dict.fromkeys(names, 0)
