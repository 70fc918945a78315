# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A simulated hand with its skin and reflexes in all their processes, from their start to their end."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path

import rclpy

from acts_core.errors import ActsError, LaunchError
from acts_msgs.msg import HandStatus
from acts_ros.middleware import NotAskedError
from acts_sim.dynamixel import ControlClient
from acts_tools.hand_rigs.collector import HandCollector
from acts_tools.hand_rigs.recording import HandRecording
from acts_tools.process_load import LoadMeter
from acts_tools.running.launched import START_TIMEOUT_S, launched
from acts_tools.running.node import ros
from acts_tools.running.stopping import StopFlag
from acts_tools.running.watcher import Watcher

_SETTLED_S = 0.5
_ANSWER_TIMEOUT_S = 10.0
NAMESPACE = "/hand"


class HandRefusalError(LaunchError):
    """The hand does not do what it was asked for; the message has its reason."""


STATES = {
    HandStatus.STATE_STOPPED: "stopped",
    HandStatus.STATE_OPEN: "open",
    HandStatus.STATE_CLOSING: "closing",
    HandStatus.STATE_HOLDING: "holding",
    HandStatus.STATE_AVOIDING: "avoiding",
}


class LiveHand:
    """Commands a running hand; made by `live_hand`.

    Parameters
    ----------
    collector : HandCollector
    control : ControlClient
    watcher : Watcher
        Processes messages while waiting.

    Attributes
    ----------
    recording : HandRecording
    """

    def __init__(self, collector: HandCollector, control: ControlClient, watcher: Watcher) -> None:
        self.recording: HandRecording = collector.recording
        self._collector = collector
        self._control = control
        self._watcher = watcher

    def do(self, line: str, mark: str = "") -> float:
        """Send a command for the hand or its object; return the time [s]."""
        now_s = self._mark(mark)
        self._control.do(line)
        return now_s

    def ask(self, name: str, mark: str = "") -> float:
        """Call the hand's service grasp, release or stop; return the time [s].

        Raises
        ------
        HandRefusalError
            When it refuses, was not asked, or does not reply.
        """
        now_s = self._mark(mark)
        try:
            answer = self._collector.ask(name)
        except NotAskedError as error:
            raise HandRefusalError(str(error)) from error
        # The watcher polls topics, but replies of services need the executor.
        deadline_s = time.monotonic() + _ANSWER_TIMEOUT_S
        while not answer.done() and time.monotonic() < deadline_s:
            rclpy.spin_once(self._collector, timeout_sec=0.05)
        result = answer.result() if answer.done() else None
        if result is None or not result.success:
            raise HandRefusalError(f"the hand refuses to {name}: {result.message if result else 'it does not answer'}")
        return now_s

    def until(self, condition: Callable[[], bool], timeout_s: float) -> bool:
        """Wait until a condition is true; return whether it was in time."""
        return self._watcher.until(condition, timeout_s)

    def run(self, duration_s: float) -> None:
        """Wait for a time [s]."""
        end_s = time.monotonic() + duration_s
        self.until(lambda: time.monotonic() >= end_s, 2.0 * duration_s + 5.0)

    def _mark(self, mark: str) -> float:
        now_s = time.monotonic()
        if mark:
            self.recording.marks.append((now_s, mark))
        return now_s


@contextmanager
def live_hand(
    arguments: Mapping[str, str],
    recording: HandRecording,
    run_dir: Path,
    log_path: Path,
    stop: StopFlag,
    line: Callable[[HandCollector], str],
) -> Iterator[LiveHand]:
    """Launch a simulated hand and wait until it has touch and torque; stop it at the end of the block.

    Parameters
    ----------
    arguments : mapping of str to str
        Launch arguments besides run_dir and namespace.
    recording : HandRecording
        Recording to fill; the load of the processes is added at the end.
    run_dir : Path
        Folder for files that the processes share.
    log_path : Path
        File for the output of the launch.
    stop : StopFlag
        Set when the user wants to stop (KeyboardInterrupt).
    line : callable
        Returns the status line.

    Raises
    ------
    LaunchError
        When the launch has ended, or the hand is not ready in time.
    """
    words = [f"{name}:={value}" for name, value in {**arguments, "run_dir": str(run_dir)}.items()]
    # The previous hand may still be ending.
    with launched("hand_reflexes.launch.xml", words, log_path) as launch, ros():
        collector = HandCollector(NAMESPACE, run_dir, recording)
        watcher = Watcher(collector.take_in, launch, stop, lambda: line(collector))
        try:
            if not watcher.until(
                lambda: collector.fresh_s > _SETTLED_S and collector.has_torque and collector.is_served,
                START_TIMEOUT_S,
            ):
                raise LaunchError(f"the hand did not feel and move within {START_TIMEOUT_S:.0f} s")
            with closing(_control(run_dir / "hand.control")) as control:
                meter = LoadMeter(launch.pid)
                meter.start()
                yield LiveHand(collector, control, watcher)
                recording.cpu_percent = meter.percent()
            watcher.end()
        finally:
            collector.destroy_node()


def _control(path: Path) -> ControlClient:
    try:
        return ControlClient(path)
    except ActsError as error:
        raise LaunchError(str(error)) from error
