"""The node `driver`: board bytes in, TactileSamples out."""

from __future__ import annotations

import sys
import time

from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.timer import Timer

from acts_core.board_messages import BoardMessage
from acts_core.errors import ActsError
from acts_core.frames import SampleFrame
from acts_driver.baseline_services import BaselineServices
from acts_driver.board import BoardLink
from acts_driver.board_interface import BoardInterface
from acts_driver.board_parameters import BOARD_PARAMETERS
from acts_driver.board_results import BoardResult
from acts_driver.board_session import BoardSession
from acts_driver.board_topics import BoardTopics
from acts_driver.messages import SamplesMessage
from acts_driver.reader import Reader
from acts_driver.report import DriverReport
from acts_driver.settings import DriverSettings
from acts_driver.source import Source
from acts_driver.stream import FrameStream
from acts_msgs.msg import TactileSamples
from acts_ros.diagnostics import ERROR, OK, DiagnosticsReporter, Report
from acts_ros.executor import run
from acts_ros.parameters import declare, node_options
from acts_ros.qos import STREAM, overridable

SUCCESS = TransitionCallbackReturn.SUCCESS
FAILURE = TransitionCallbackReturn.FAILURE

VERDICT_S = 1.0
"""Longest time that configuring waits for a board to say who it is, or for it to turn out that it says nothing."""


class DriverNode(LifecycleNode):
    """Lifecycle node around `Reader` and `FrameStream`.

    Configured, it reads the board, so that nothing old is waiting when it is activated; active, it publishes. The
    frames are published from the reader's thread, without a hop through the executor.
    """

    def __init__(self, **node_arguments: object) -> None:
        super().__init__("driver", **node_options(), **node_arguments)
        self._settings = declare(
            self, DriverSettings, changeable=BOARD_PARAMETERS, on_change=self._on_changed_parameters
        )
        self._what = self._settings.replay if self._settings.is_replay else self._settings.port
        self._active = False
        self._source: Source | None = None
        self._reader: Reader | None = None
        self._session: BoardSession | None = None
        self._report: DriverReport | None = None
        self._problem = ""
        self._autostart_timers: list[Timer] = []
        self._is_waiting = False
        frame_id = self._settings.frame_id or self.get_namespace().strip("/").replace("/", "_") or "skin"
        self._message = SamplesMessage(frame_id)
        self._baseline = BaselineServices(self, self._settings, self._settings.rows, self._settings.cols, frame_id)
        self._board = BoardInterface(self, frame_id)
        # Not made in on_configure: subscribers then are matched before the first frame.
        self._topics = BoardTopics(self, frame_id)
        self._publisher = self.create_publisher(TactileSamples, "samples", **overridable(STREAM))
        self._diagnostics = DiagnosticsReporter(self, self._what, self._make_report)
        if self._settings.autostart:
            # At once and then again and again. Not in the constructor: a signal would meet a half-made node.
            self._autostart_timers = [
                self.create_timer(0.001, self._autostart_at_once),
                self.create_timer(self._settings.reconnect_s, self._autostart),
            ]

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Open the port and begin to read."""
        settings = self._settings
        source = settings.make_source()
        try:
            source.open()
        except ActsError as error:
            # With autostart this is tried again and again, and told once.
            if str(error) != self._problem:
                self.get_logger().error(str(error))
            self._problem = str(error)
            return FAILURE
        self._problem = ""
        self._source = source
        size = (settings.rows, settings.cols)
        link = BoardLink(source.write)
        results = self._topics.begin()

        def on_message(message: BoardMessage) -> None:
            link.take(message)
            results.take(message)

        decoder = settings.make_decoder(on_message)
        self._stream = FrameStream(*size, has_board_clock=decoder.has_board_clock)
        if settings.has_dialogue:
            self._session = BoardSession(link, settings, size=size, log=self._log, on_change=self._board.publish)
        self._board.session = self._session
        self._reader = Reader(
            source,
            decoder,
            self._on_frames,
            has_results=results.has_results,
            reconnect_s=settings.reconnect_s,
            log=self._log,
            on_reconnect=self._on_reconnect,
        )
        self._report = DriverReport(source, self._reader, decoder, self._stream, size, self._session)
        self._restarts_told = 0
        self._wrong_size_told = (0, 0)
        self._reader.start(is_open=True)
        if self._session is not None:
            self._session.start()
            self._session.wait_for_verdict(VERDICT_S)
        self.get_logger().info(f"reading {source.name}" + ("" if settings.is_replay else f" ({settings.protocol})"))
        return SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Begin to publish."""
        self._active = True
        if self._source is not None:
            self._source.begin()
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop publishing; the board is still read."""
        self._active = False
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Close the port."""
        self.close()
        return SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Close the port for good."""
        self.close()
        return SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Close the port after a transition failed unexpectedly; the node is unconfigured then."""
        self.get_logger().error("a transition failed; the port is closed")
        self.close()
        return SUCCESS

    def close(self) -> None:
        """Stop publishing, end the reader's thread and close the port."""
        self._active = False
        self._stop_autostart()
        session, self._session, self._board.session = self._session, None, None
        if session is not None:
            session.stop()
        reader, self._reader, self._report, self._source = self._reader, None, None, None
        if reader is not None:
            reader.stop()

    def _autostart_at_once(self) -> None:
        if self._autostart_timers:
            self._autostart_timers[0].cancel()
            self._autostart()

    def _autostart(self) -> None:
        """Configure and activate, unless that was done or stopped meanwhile."""
        if not self._autostart_timers:
            return
        if self.trigger_configure() == SUCCESS:
            self._stop_autostart()
            self.trigger_activate()
        elif not self._is_waiting:
            self._is_waiting = True
            self.get_logger().info(f"waiting for {self._what}")

    def _stop_autostart(self) -> None:
        timers, self._autostart_timers = self._autostart_timers, []
        for timer in timers:
            # Not destroyed: this may be called from one of them.
            timer.cancel()

    def _on_frames(self, frames: list[SampleFrame], arrival_ns: int) -> None:
        """Publish; on the reader's thread."""
        accepted = self._stream.accept(frames, arrival_ns)
        results = self._topics.results.stamped(accepted)
        if self._stream.wrong_size_last != self._wrong_size_told:
            self._tell_wrong_size()
        session = self._session
        if session is not None and self._stream.statistics.restarts != self._restarts_told:
            self._restarts_told = self._stream.statistics.restarts
            session.wake()
        if session is not None and not session.may_publish:
            return
        self._baseline.observe(accepted)
        if not self._active:
            return
        try:
            self._publish(accepted, results)
        except RuntimeError:
            # A signal may end the context between two frames; all of rclpy's own errors are RuntimeErrors.
            if self.context.ok():
                raise

    def _publish(self, frames: list[tuple[SampleFrame, int]], results: list[tuple[BoardResult, int]]) -> None:
        for frame, stamp_ns in frames:
            self._publisher.publish(self._message.fill(frame, stamp_ns))
        for result, stamp_ns in results:
            self._topics.publish(result, stamp_ns)

    def _on_reconnect(self) -> None:
        """The port is open again; on the reader's thread, before the first frame."""
        self._stream.statistics.reconnected()
        if self._session is not None:
            self._session.reconnected()

    def _on_changed_parameters(self, settings: DriverSettings) -> str:
        """Tell the board; why it cannot be, or nothing."""
        if not settings.has_dialogue and self._source is not None:
            return "only a board that speaks the binary protocol can be told settings while the driver runs"
        if self._session is not None:
            try:
                self._session.change(settings)
            except ActsError as error:
                return str(error)
        self._settings = settings
        return ""

    def _tell_wrong_size(self) -> None:
        self._wrong_size_told = self._stream.wrong_size_last
        rows, cols = self._wrong_size_told
        self.get_logger().error(
            f"the board sends frames of {rows} x {cols} taxels, expected are {self._settings.rows} x "
            f"{self._settings.cols}; they are dropped: set the parameters rows and cols"
        )

    def _make_report(self) -> Report:
        if self._report is not None:
            level, message, values = self._report.make("active" if self._active else "inactive", time.time_ns())
            return level, message, {**values, **self._baseline.values(), **self._topics.values()}
        values = {"port": self._what, "state": "unconfigured"}
        return (ERROR, self._problem, values) if self._problem else (OK, "unconfigured", values)

    def _log(self, level: str, message: str) -> None:
        # On the way out the port may go before the node does, and there is nobody left to tell.
        if not self.context.ok():
            return
        # A line each: rclpy refuses a line that changes its severity.
        if level == "error":
            self.get_logger().error(message)
        elif level == "warning":
            self.get_logger().warning(message)
        else:
            self.get_logger().info(message)


def main() -> None:
    """Run the driver until it is told to stop."""
    sys.exit(run([DriverNode]))
