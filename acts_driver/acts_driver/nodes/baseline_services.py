# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The driver's services `calibrate` and `tare`, and the topic `baseline`."""

from __future__ import annotations

import threading
import time
from array import array
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from rclpy.node import Node
from std_srvs.srv import Trigger

from acts_core.errors import ActsError, CalibrationError, SettingsError
from acts_core.files import is_there, path_of
from acts_core.frames import SampleFrame
from acts_core.runtime import Pace, begin, within_patience
from acts_core.settings import is_given
from acts_core.skin import Layout, layout
from acts_core.words import counted
from acts_driver.baseline import Baseline, BaselineTracker, KeptBaseline
from acts_driver.settings import DriverSettings
from acts_msgs.msg import Baseline as BaselineMessage
from acts_ros.clocks import steady_timer
from acts_ros.messages import set_stamp
from acts_ros.publishers import published
from acts_ros.qos import LATCHED

# Of what is published, and of a layout that is being read.
_PERIOD_S = 1.0
_MOVED_COUNTS = 0.5
# Older frames do not show the present skin, unless they come as rarely [s].
_FRESH_S = 0.5

_WaitFor = Callable[[Callable[[], Baseline | None], str], Baseline | None]
"""Does a work, of which it is told what it is for a person, and returns its result."""


class BaselineServices:
    """Publishes the baseline of a node's skin, and lets it be determined.

    The baseline in the file is taken over at the start; it is written by `calibrate`, not by `tare`. A driver in place
    of one that has died goes on with the baseline of that one (`KeptBaseline`).

    Parameters
    ----------
    node : rclpy.node.Node
        Gets the services ``~/calibrate`` and ``~/tare`` (std_srvs/Trigger) and the topic ``baseline``.
    settings : DriverSettings
    frame_id : str
        Of the messages' headers.

    Raises
    ------
    SettingsError
        When the file holds no baseline of this array.
    """

    def __init__(self, node: Node, settings: DriverSettings, frame_id: str) -> None:
        self._node = node
        self._frame_id = frame_id
        self._path: Path | None = None
        self._tracker: BaselineTracker
        self._layout: Future[Layout] | None = None
        self._published: Baseline | None = None
        self._pace = Pace()
        # Between calibrations that are being stored, on threads of their own; and the last of them.
        self._storing = threading.Lock()
        self._newest: Baseline | None = None
        # Serial numbers of the board that is read, and of that of the baseline; 0 where not known.
        self._board_id = self._baseline_board_id = 0
        self._problem_told = ""
        self._publisher = node.create_publisher(BaselineMessage, "baseline", **published(LATCHED))
        node.create_service(Trigger, "~/calibrate", self._calibrate)
        node.create_service(Trigger, "~/tare", self._tare)
        self._kept: KeptBaseline | None = None
        try:
            # Nobody is answered yet: a slow file has all the time it needs.
            self._begin(settings, lambda load, _what: load(), self._left_baseline(settings))
        except ActsError:
            self.leave()
            raise
        steady_timer(node, _PERIOD_S, self._step)

    def begin(self, settings: DriverSettings) -> None:
        """Begin anew with other parameters, while no frames come.

        Raises
        ------
        SettingsError
            When the file holds no baseline of this array, or takes too long to be read; nothing has changed then.
        """
        self._begin(settings, lambda load, what: within_patience(load, SettingsError, what))

    def arrange(self, settings: DriverSettings) -> None:
        """Take over how the taxels lie on the skin, as soon as the layout's file is read."""
        self._layout = begin(partial(layout, settings.layout or "square", settings.rows, settings.cols))

    def leave(self) -> None:
        """Leave the baseline to the driver that takes over from this one, whose process is going to end by an error."""
        if self._kept is not None:
            self._kept.close()
            self._kept = None

    def close(self) -> None:
        """Keep the baseline no longer: the driver ends in order."""
        if self._kept is not None:
            self._kept.forget()
        self.leave()

    def _left_baseline(self, settings: DriverSettings) -> Baseline | None:
        """Begin to keep the baseline; that of a driver which this one is in place of."""
        source = settings.replay if settings.is_replay else settings.port
        name, path = self._node.get_fully_qualified_name(), _calibration_path(settings)
        try:
            self._kept = KeptBaseline(f"{name} {source} {path}")
            return self._kept.take_over(settings.rows, settings.cols, path)
        except ActsError as error:
            self._node.get_logger().warning(str(error))
            return None

    def _begin(self, settings: DriverSettings, wait_for: _WaitFor, left: Baseline | None = None) -> None:
        path, rows, cols = _calibration_path(settings), settings.rows, settings.cols
        tracker = BaselineTracker(rows, cols, settings.baseline_config())

        def load() -> Baseline | None:
            return Baseline.load(path, rows, cols) if path is not None and is_there(path, error=SettingsError) else None

        baseline = left
        if baseline is None and path is not None:
            baseline = wait_for(load, f"reading calibration_file = {path}")
        self._published = None
        self._path, self._tracker, self._pace = path, tracker, Pace()
        self.arrange(settings)
        self._baseline_board_id = 0 if baseline is None else baseline.board_id
        if baseline is not None:
            tracker.set(baseline)
            self._publish(baseline)
            origin = path if left is None else f"the driver that has died ({left.source.name.lower()})"
            self._node.get_logger().info(f"baseline of {counted(int(baseline.valid.sum()), 'taxel')} from {origin}")
        elif path is not None:
            service = self._node.resolve_service_name("~/calibrate")
            self._node.get_logger().info(f"no baseline yet: {path} is not there, the service {service} writes it")
        if baseline is None:
            # Whoever subtracts a former one, be it of a driver that has ended, would go on.
            self._publisher.publish(baseline_message(Baseline.none(rows, cols), self._frame_id))
            if self._kept is not None:
                self._kept.forget()

    def observe(self, frames: Sequence[tuple[SampleFrame, int]]) -> None:
        """Update the baseline by frames with their stamps [ns], on the reader's thread."""
        if frames:
            self._pace.step(time.monotonic(), len(frames))
            self._tracker.observe(frames)

    def end(self) -> None:
        """Tell that no frames come from now on: what is remembered is not the present skin, however young."""
        self._pace = Pace()
        self._board_id = 0

    def board_answers(self, board_id: int) -> None:
        """Tell which board is read, by its serial number; from any thread."""
        self._board_id = board_id
        problem = self.problem
        if problem and problem != self._problem_told:
            self._node.get_logger().warning(problem)
        self._problem_told = problem

    @property
    def problem(self) -> str:
        """That the baseline is of another board's skin, in words; empty where it is not, or that is not known."""
        baseline_id, board_id = self._baseline_board_id, self._board_id
        if not baseline_id or not board_id or baseline_id == board_id:
            return ""
        return (
            f"the baseline is of board {baseline_id}, and the port leads to board {board_id}: give the port "
            f"serial:{baseline_id}, or calibrate"
        )

    def values(self) -> dict[str, object]:
        """What the driver's diagnostics say of the baseline."""
        present, drift = self._tracker.present(), self._tracker.drift()
        return {
            "baseline": "none" if present is None else present.source.name.lower(),
            "baseline_board": self._baseline_board_id or "not known",
            "baseline_taxels": 0 if present is None else int(present.valid.sum()),
            "baseline_below": self._tracker.below(),
            "baseline_drift_per_min.median": "none" if drift is None else drift.median,
            "baseline_drift_per_min.largest": "none" if drift is None else drift.largest,
        }

    def _calibrate(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        try:
            self._require_frames()
            forgotten = self._forgotten()
            calibration = self._tracker.calibrate(keeps_others=not forgotten)
        except ActsError as error:
            return self._answer(response, False, str(error))
        baseline = replace(calibration.baseline, board_id=self._board_id)
        self._baseline_board_id = baseline.board_id
        # In force even where the file cannot be written.
        self._publish(baseline)
        path, self._newest = self._path, baseline
        try:
            if path is not None:
                within_patience(lambda: self._store(baseline, path), SettingsError, f"{path}: storing the baseline")
        except ActsError as error:
            return self._answer(response, False, f"calibrated until the driver ends, but not stored: {error}")
        stored = "" if self._path is None else f"; stored in {self._path}"
        return self._answer(response, True, f"{calibration}{forgotten}{stored}")

    def _store(self, baseline: Baseline, path: Path) -> None:
        """Write the file, after an older calibration that a slow disk holds up, and not after a newer one."""
        with self._storing:
            if baseline is self._newest:
                baseline.save(path)

    def _tare(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        try:
            self._require_frames()
            forgotten = self._forgotten()
            tare = self._tracker.tare(keeps_others=not forgotten)
        except ActsError as error:
            return self._answer(response, False, str(error))
        self._baseline_board_id = self._board_id
        self._publish(tare.baseline)
        return self._answer(response, True, f"{tare}{forgotten}")

    def _forgotten(self) -> str:
        """That nothing is kept of the baseline where it is of another board's skin; empty where it may be kept."""
        if not self.problem:
            return ""
        return f"; what was known of the skin of board {self._baseline_board_id} is forgotten"

    def _require_frames(self) -> None:
        """Raise where no frames arrive: the remembered ones do not show the present skin."""
        heard_s, now_s = self._pace.last_s, time.monotonic()
        if heard_s is None:
            raise CalibrationError("no frames: is the driver configured, and does the board send?")
        if self._pace.is_silent(now_s, _FRESH_S):
            raise CalibrationError(
                f"no frames for {now_s - heard_s:.1f} s: the driver's diagnostics tell why; call again when they are "
                "back"
            )

    def _answer(self, response: Trigger.Response, success: bool, message: str) -> Trigger.Response:
        if success:
            self._node.get_logger().info(message)
        else:
            self._node.get_logger().warning(message)
        response.success = success
        response.message = message
        return response

    def _step(self) -> None:
        if self._kept is not None:
            self._kept.refresh()
        if self._layout is not None and self._layout.done():
            self._take_over(self._layout)
            self._layout = None
        self._publish_where_moved()

    def _take_over(self, read: Future[Layout]) -> None:
        try:
            self._tracker.arrange(read.result())
        except ActsError as error:
            self._node.get_logger().warning(
                f"{error}; the baseline goes on with the neighbours that it knows, at first those of the matrix"
            )

    def _publish_where_moved(self) -> None:
        present, last = self._tracker.present(), self._published
        if present is None or (last is not None and np.abs(present.counts - last.counts).max() < _MOVED_COUNTS):
            return
        self._publish(present)

    def _publish(self, baseline: Baseline) -> None:
        self._publisher.publish(baseline_message(baseline, self._frame_id))
        self._published = baseline
        self._keep(replace(baseline, board_id=self._baseline_board_id))

    def _keep(self, baseline: Baseline) -> None:
        if self._kept is None:
            return
        try:
            self._kept.keep(baseline)
        except ActsError as error:
            self._node.get_logger().warning(str(error))
            # An older one would be wrong.
            self.close()


def _calibration_path(settings: DriverSettings) -> Path | None:
    file = settings.calibration_file
    return path_of(file, error=SettingsError) if is_given(file) else None


def baseline_message(baseline: Baseline, frame_id: str) -> BaselineMessage:
    """A baseline as it is published."""
    message = BaselineMessage()
    message.header.frame_id = frame_id
    set_stamp(message.header.stamp, baseline.time_ns or time.time_ns())
    message.rows, message.cols = baseline.counts.shape
    message.source = int(baseline.source)
    message.baseline = array("f", baseline.counts.tobytes())
    message.noise = array("f", baseline.noise_counts.tobytes())
    message.valid = baseline.valid.ravel().tolist()
    return message
