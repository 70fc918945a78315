"""A simulated hand with its skin and reflexes, all its processes, from their start to their end."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path

import rclpy
from rclpy.signals import SignalHandlerOptions

from acts_core.errors import ActsError, LaunchError
from acts_msgs.msg import HandStatus
from acts_ros import middleware
from acts_sim.dynamixel import ControlClient
from acts_tools.bags.stopping import StopFlag
from acts_tools.demo.launched import launched
from acts_tools.demo.watcher import Watcher
from acts_tools.live_hand.collector import HandCollector
from acts_tools.live_hand.recording import HandRecording
from acts_tools.process_load import LoadMeter

# On a machine that compiles for the first time and has other work besides, a minute was not enough.
_START_TIMEOUT_S = 180.0
_SETTLED_S = 0.5
_ANSWER_TIMEOUT_S = 10.0
NAMESPACE = "/hand"

STATES = {
    HandStatus.STATE_STOPPED: "stopped",
    HandStatus.STATE_OPEN: "open",
    HandStatus.STATE_CLOSING: "closing",
    HandStatus.STATE_HOLDING: "holding",
    HandStatus.STATE_AVOIDING: "avoiding",
}


class LiveHand:
    """Made by `live_hand`.

    Parameters
    ----------
    collector : HandCollector
    control : ControlClient
    watcher : Watcher
        Takes in what comes while something is waited for.

    Attributes
    ----------
    recording : HandRecording
    """

    def __init__(self, collector: HandCollector, control: ControlClient, watcher: Watcher) -> None:
        self.recording: HandRecording = collector.recording
        self._collector = collector
        self._control = control
        self._watcher = watcher

    @property
    def state(self) -> int:
        """Of the hand, as in acts_msgs/HandStatus."""
        return self._collector.status.state if self._collector.status else HandStatus.STATE_STOPPED

    def do(self, line: str, mark: str = "") -> float:
        """Let something happen to the hand or its object; the time of it [s]."""
        now_s = self._mark(mark)
        self._control.do(line)
        return now_s

    def ask(self, name: str, mark: str = "") -> float:
        """Call the hand's service grasp, release or stop; the time of it [s].

        Raises
        ------
        LaunchError
            When it refuses or does not answer.
        """
        now_s = self._mark(mark)
        answer = self._collector.ask(name)
        # The watcher reads topics; answers of services come by the executor.
        deadline_s = time.monotonic() + _ANSWER_TIMEOUT_S
        while not answer.done() and time.monotonic() < deadline_s:
            rclpy.spin_once(self._collector, timeout_sec=0.05)
        result = answer.result() if answer.done() else None
        if result is None or not result.success:
            raise LaunchError(f"the hand refuses to {name}: {result.message if result else 'it does not answer'}")
        return now_s

    def until(self, condition: Callable[[], bool], timeout_s: float) -> bool:
        """Go on until something is the case; whether it was in time."""
        return self._watcher.until(condition, timeout_s)

    def until_state(self, *states: int, timeout_s: float = 15.0) -> bool:
        """Go on until the hand is in one of some states; whether it was in time."""
        return self.until(lambda: self.state in states, timeout_s)

    def run(self, duration_s: float) -> None:
        """Go on for a time [s]."""
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
    line: Callable[[HandCollector], str] = lambda _collector: "",
) -> Iterator[LiveHand]:
    """Launch a simulated hand and wait until it feels and its torque is on; at the end all of it is stopped.

    Parameters
    ----------
    arguments : mapping of str to str
        Of the launch file, besides run_dir and namespace.
    recording : HandRecording
        Filled meanwhile; the load of the processes at the end.
    run_dir : Path
        Folder for what the processes share.
    log_path : Path
        Takes what the launch prints.
    stop : StopFlag
        Set when a person wants it to end (KeyboardInterrupt).
    line : callable
        The status line.

    Raises
    ------
    LaunchError
        When the launch has ended, or the hand is not there in time.
    """
    words = [f"{name}:={value}" for name, value in {**arguments, "run_dir": str(run_dir)}.items()]
    # One hand comes after another.
    with launched("hand_reflexes.launch.xml", words, log_path, niceness=0) as launch:
        middleware.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
        collector = HandCollector(NAMESPACE, run_dir, recording)
        watcher = Watcher(collector.take_in, launch, stop, lambda: line(collector))
        try:
            if not watcher.until(lambda: collector.fresh_s > _SETTLED_S and collector.is_served, _START_TIMEOUT_S):
                raise LaunchError(f"the hand did not feel and move within {_START_TIMEOUT_S:.0f} s")
            with closing(_control(run_dir / "hand.control")) as control:
                meter = LoadMeter(launch.pid)
                meter.start()
                yield LiveHand(collector, control, watcher)
                recording.cpu_percent = meter.percent()
            watcher.end()
        finally:
            collector.destroy_node()
            rclpy.try_shutdown()


def _control(path: Path) -> ControlClient:
    try:
        return ControlClient(path)
    except ActsError as error:
        raise LaunchError(str(error)) from error
