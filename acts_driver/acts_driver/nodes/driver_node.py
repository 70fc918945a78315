# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `driver`: board bytes in, TactileSamples out.

Topics: samples, baseline, board, and board_image, board_object with what the board recovers itself. Services:
~/query_board, ~/calibrate, ~/tare, and those of a life cycle.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn

from acts_core.errors import ActsError
from acts_core.frames import SampleFrame
from acts_core.kernels import skip_extras
from acts_core.stop_signals import StopSignals
from acts_driver.board import BoardResult, BoardStatus
from acts_driver.nodes.autostart import Autostart
from acts_driver.nodes.baseline_services import BaselineServices
from acts_driver.nodes.board_interface import BoardInterface
from acts_driver.nodes.board_topics import BoardTopics
from acts_driver.nodes.intake import Intake
from acts_driver.nodes.transitions import answer_any
from acts_driver.port import Source
from acts_driver.settings import DriverSettings
from acts_msgs.msg import TactileSamples
from acts_ros.clocks import keep_system_clock
from acts_ros.composition import run_nodes
from acts_ros.diagnostics import ERROR, OK, WARN, DiagnosticsReporter, Report
from acts_ros.log import log_of
from acts_ros.messages import SamplesMessage, skin_frame
from acts_ros.parameters import declare, node_options
from acts_ros.publishers import published
from acts_ros.qos import STREAM

FrameConsumer = Callable[[list[tuple[SampleFrame, int]], str], None]
"""See `DriverNode.consumers`."""

SUCCESS = TransitionCallbackReturn.SUCCESS
FAILURE = TransitionCallbackReturn.FAILURE

_SHUT_DOWN = "shut down: start the driver anew to read"


class DriverNode(LifecycleNode):
    """Lifecycle node around `Intake`.

    Configured, it reads the board, so that nothing old is waiting when it is activated; active, it publishes. The
    frames are published from the reader's thread, without a hop through the executor.

    Attributes
    ----------
    active : bool
        Whether it publishes.
    intake : Intake or None
        What it reads with; None while it is unconfigured.
    consumers : list of callable
        Each takes the frames that were read together, at least one, with their stamps [ns], and the frame of the skin,
        on the reader's thread: nodes of the same process, to which no message has to be sent. To be filled before the
        node is spun.
    """

    def __init__(self, **node_arguments: object) -> None:
        super().__init__("driver", **node_options(), **node_arguments)
        answer_any(self)
        self.active = False
        self.intake: Intake | None = None
        self._settings = declare(
            self, DriverSettings, self._on_changed_parameters, is_unconfigured=lambda: self.intake is None
        )
        if self._settings.unused:
            self.get_logger().warning(f"{', '.join(self._settings.unused)}: not used without replay")
        keep_system_clock(self, "the board does not wait for simulated time, and frames are stamped as they arrive")
        self.consumers: list[FrameConsumer] = []
        self._source: Source | None = None
        self._next_source: Source | None = None
        self._problem = ""
        self._is_finalized = False
        # Of the last report on frames: when [s], level and sentence; None before the first.
        self._reported: tuple[float, int, str] | None = None
        self._frame_id = frame_id = skin_frame(self, self._settings.frame_id)
        self._message = SamplesMessage(frame_id)
        self._baseline = BaselineServices(self, self._settings, frame_id)
        self._board = BoardInterface(self, frame_id, self._frames_in_words)
        # Not made in on_configure: subscribers then are matched before the first frame.
        self._topics = BoardTopics(self, frame_id)
        self._publisher = self.create_publisher(TactileSamples, "samples", **published(STREAM))
        self._diagnostics = DiagnosticsReporter(
            self, self._what, self._make_report, only_publishers=("samples", "baseline")
        )
        is_autostart = self._settings.autostart
        self._autostart = Autostart(self, self._settings.reconnect_s, self._what) if is_autostart else None

    @property
    def _what(self) -> str:
        """What frames come from, as it was named."""
        return self._settings.replay if self._settings.is_replay else self._settings.port

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Open the port and begin to read."""
        settings = self._settings
        # The same for every attempt: a recording that takes long to read is ready for the next one.
        source = self._next_source = self._next_source or settings.make_source()
        try:
            source.open()
        except ActsError as error:
            # With autostart this is tried again and again, and told once.
            if str(error) != self._problem:
                self.get_logger().error(str(error))
            self._problem = str(error)
            return FAILURE
        self._problem = ""
        self._source, self._next_source = source, None
        # The layout's file may be another than when it was read last; for the board it is read now.
        self._baseline.arrange(settings)
        self.intake = Intake(settings, source, self._publish, log=log_of(self), on_board=self._on_board)
        self._board.session = self.intake.session
        self.intake.start()
        if self._autostart is not None:
            # Over also where somebody else has configured the node, who activates it then.
            self._autostart.stop()
        # Of a recording whose recorder was killed; ports have none.
        note = getattr(source, "note", "")
        if note:
            self.get_logger().warning(note)
        self.get_logger().info(f"reading {source.name}" + ("" if settings.is_replay else f" ({settings.protocol})"))
        return SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Begin to publish."""
        self.active = True
        if self._source is not None:
            self._source.begin()
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop publishing; the board is still read."""
        self.active = False
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Close the port."""
        self.close()
        return SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Close the port for good."""
        self.close()
        self._is_finalized = True
        return SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Close the port after a transition failed unexpectedly; the node is unconfigured then."""
        self.get_logger().error("a transition failed; the port is closed")
        self.close()
        return SUCCESS

    def close(self) -> None:
        """Stop publishing, end the intake's threads and close the port."""
        self.active = False
        if self._autostart is not None:
            self._autostart.stop()
        intake, self.intake, self._source, self._board.session = self.intake, None, None, None
        self._reported = None
        if intake is not None:
            intake.stop()
            self._baseline.end()
            # That topic is kept for late joiners, and what it said of the board is not known any more.
            self._board.publish(BoardStatus(problem="the driver does not read a board now"))

    def failed(self) -> None:
        """Leave the baseline to the driver that takes over: an error ends the process."""
        self._baseline.leave()

    def destroy_node(self) -> None:
        """Take the node out of the graph at once."""
        # A start that a signal has broken off may not have come to these.
        baseline, machine = getattr(self, "_baseline", None), getattr(self, "_state_machine", None)
        if baseline is not None:
            baseline.close()
        super().destroy_node()
        # rclpy leaves this to the garbage collector, and until then the graph holds a node that answers nothing.
        if machine is not None:
            machine.destroy_when_not_in_use()

    def _publish(self, frames: list[tuple[SampleFrame, int]], results: list[tuple[BoardResult, int]]) -> None:
        """Publish what may be used; on the reader's thread."""
        is_active = self.active
        try:
            # There are none where the board has sent results only.
            if frames and is_active:
                for consume in self.consumers:
                    consume(frames, self._frame_id)
        finally:
            # What goes wrong in another node of the process is told by the reader, and keeps nothing back.
            if is_active:
                self._publish_messages(frames, results)
            # Last, because nothing of this frame waits for it.
            self._baseline.observe(frames)

    def _publish_messages(self, frames: list[tuple[SampleFrame, int]], results: list[tuple[BoardResult, int]]) -> None:
        if self._publisher.get_subscription_count():
            for frame, stamp_ns in frames:
                self._publisher.publish(self._message.fill(frame, stamp_ns))
        for result, stamp_ns in results:
            self._topics.publish(result, stamp_ns)

    def _on_board(self, status: BoardStatus) -> None:
        """Take what is known of the board; from any thread."""
        if status.state is not None:
            self._baseline.board_answers(status.state.board_id)
        self._board.publish(status)

    def _on_changed_parameters(self, settings: DriverSettings) -> str:
        """Tell the board, or take them for when there is one; why it cannot be, or nothing."""
        try:
            if self.intake is not None:
                self.intake.change(settings)
            elif _baseline_of(settings) != _baseline_of(self._settings):
                self._baseline.begin(settings)
        except ActsError as error:
            return str(error)
        # Though it be the same: its file may be another, and the board's is read again as well.
        self._baseline.arrange(settings)
        before, self._settings = self._what, settings
        self._next_source = None
        if self._what != before:
            # Why the other one could not be opened.
            self._problem = ""
        self._diagnostics.hardware_id = self._what
        return ""

    def _frames_in_words(self) -> tuple[bool, str]:
        """Whether the frames are good, and their report in words; at most a second old."""
        if self._is_finalized:
            return False, _SHUT_DOWN
        if self.intake is None:
            return False, f"not configured: {self._problem or 'nothing is read'}"
        if self._reported is None:
            return True, "frames: not judged yet, reading has just begun"
        reported_s, level, message = self._reported
        return level != ERROR, f"reported {time.monotonic() - reported_s:.1f} s ago: {message}"

    def _make_report(self) -> Report:
        if self.intake is not None:
            level, message, values = self.intake.report("active" if self.active else "inactive", time.time_ns())
            problem = self._baseline.problem
            if problem:
                level, message = max(level, WARN), f"{problem}; {message}"
            self._reported = (time.monotonic(), level, message)
            return level, message, {**values, **self._baseline.values()}
        if self._is_finalized:
            return OK, _SHUT_DOWN, {"port": self._what, "state": "finalized"}
        values = {"port": self._what, "state": "unconfigured"}
        return (ERROR, self._problem, values) if self._problem else (OK, "unconfigured", values)


def _baseline_of(settings: DriverSettings) -> tuple[object, ...]:
    """All that the baseline depends on."""
    return settings.rows, settings.cols, settings.calibration_file, settings.baseline_config()


SETTINGS: dict[str, type] = {"driver": DriverSettings}
"""The settings class of the node, by name."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the node; the exit code."""
    skip_extras()
    return run_nodes({"driver": DriverNode}, SETTINGS, signals, args)
