# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The control loop: a thread with absolute deadlines that takes the robot from connecting to a defined stop."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from math import inf

from acts_control.ball.controller import BallController, BallReport, ControlInput, ControllerConfig, Phase
from acts_control.ball.reference import ReferenceReport
from acts_control.loop_rate import LoopRate, steady_s
from acts_control.robots.base import (
    CommandRefusedError,
    Robot,
    RobotConfig,
    RobotReading,
    RobotStoppedError,
    RobotTakenError,
    RobotWatch,
    TiltGate,
)
from acts_core.errors import ActsError, RobotError
from acts_core.settings import setting

_HOMING_PERIOD_S = 0.02
_ENDING_PERIOD_S = 0.002
_ENDING_TIMEOUT_S = 3.0
# What held up this process for longer may have held up whoever hands on what the robot says, too; nobody has looked at
# the robot for the rest, so that it counts for no deadline of it.
_LONGEST_LOOK_S = 0.03
# In the unit of the joints, rad or m.
_HOMED = 0.002
_STANDING_STILL = 2e-4
_STANDING_STILL_POLLS = 5

# Longest step the controller is told of: after the process was held up, it goes on from where it was. It is shorter
# where the robot would refuse what the plate may turn meanwhile.
_MAX_PERIODS = 4
_MIN_STEP_S = 1e-4

# How often the reason for a refused command is looked for, and how long after one another [s].
_REASON_LOOKS = 50
_REASON_PERIOD_S = 0.002


@dataclass(frozen=True)
class LoopConfig(ControllerConfig, RobotConfig):
    """All of the control loop."""

    autostart: bool = setting(True, "whether to connect and move to the level pose at once; else on ~/start")
    connect_retry_s: float = setting(1.0, "time between attempts to connect [s]", minimum=0.05, maximum=60.0)

    def __post_init__(self) -> None:
        ControllerConfig.__post_init__(self)
        RobotConfig.__post_init__(self)


@dataclass(frozen=True)
class LoopStatus:
    """What the loop does, as of the last step; see BalanceStatus for the meaning of the fields."""

    phase: Phase = Phase.STOPPED
    reason: str = "not started"
    error_m: tuple[float, float] = (0.0, 0.0)
    tilt_commanded_rad: tuple[float, float] = (0.0, 0.0)
    tilt_measured_rad: tuple[float, float] = (0.0, 0.0)
    joints: tuple[float, ...] = ()
    touch_age_s: float = float("inf")
    reference_problem: str = ""
    steps: int = 0
    late_steps: int = 0


class ControlLoop:
    """Runs the robot in a thread of its own.

    Parameters
    ----------
    config : LoopConfig
    robot : Robot
    now_ns : callable
        The clock of the stamps [ns].
    on_step : callable
        Called after every control step with the time [ns] and the measured tilt [rad].
    steady_s, sleep : callable
        The clock that steps and waits go by [s], and how to let it pass; a simulation has its own.

    Attributes
    ----------
    look : callable
        Called at the begin of every control step with the phase; may renew `ball` and `reference`.
    stood_still : callable
        Takes when a start was asked for, by `loop_rate.steady_s` [s], or inf; in words that this program has stood
        still since, or nothing.
    ball : BallReport or None
        Newest estimate, to be set by `look` or by whoever receives it.
    reference : ReferenceReport or None
        Newest reference, likewise.
    status : LoopStatus
        Replaced as a whole after every step.
    """

    def __init__(
        self,
        config: LoopConfig,
        robot: Robot,
        now_ns: Callable[[], int],
        on_step: Callable[[int, tuple[float, float]], None] = lambda _now_ns, _tilt: None,
        *,
        steady_s: Callable[[], float] = steady_s,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self.look: Callable[[Phase], None] = lambda _phase: None
        self.stood_still: Callable[[float], str] = lambda _asked_s: ""
        self.ball: BallReport | None = None
        self.reference: ReferenceReport | None = None
        self.status = LoopStatus()
        self._config = config
        self._newest_config = config
        self._robot = robot
        self._now_ns = now_ns
        self._on_step = on_step
        self._steady_s = steady_s
        self._sleep = sleep
        # Guards the four below, and wakes the thread when one changes.
        self._changed = threading.Condition()
        self._wanted = False
        # When the session was asked for by `start` [s].
        self._asked_s = inf
        # What ended the session asked for, in words; empty while it should go on.
        self._stop_reason = ""
        self._closing = False
        # When motion ends at the latest, also before the plate is level [s].
        self._end_by_s = inf
        self._thread = threading.Thread(target=self._run, name="control_loop", daemon=True)

    def launch(self) -> None:
        """Start the thread, and with `autostart` the robot."""
        self._wanted = self._config.autostart
        self._thread.start()

    @property
    def is_stopping(self) -> bool:
        """Whether motion has been asked to end and has not ended yet."""
        return self._wanted and bool(self._stop_reason)

    def start(self) -> bool:
        """Begin anew; False when it is running already."""
        with self._changed:
            if self._wanted or self._closing or not self._thread.is_alive():
                return False
            self._stop_reason = ""
            self._wanted = True
            self._asked_s = self._steady_s()
            # At once, although the thread may still be cutting the last connection: what ended that is past.
            self.status = LoopStatus(phase=Phase.CONNECTING, reason="connecting")
            self._changed.notify_all()
            return True

    def change(self, config: LoopConfig) -> None:
        """Use other settings from the next control step on, where they are `Changeable.RUNNING`. From any thread."""
        self._newest_config = config

    def stop(self, reason: str) -> bool:
        """End motion: level the plate, stop the servo, release the robot. False when it is stopped already."""
        with self._changed:
            if not self._wanted:
                return False
            self._stop_reason = self._stop_reason or reason
            self._changed.notify_all()
            return True

    def close(self, timeout_s: float = 5.0) -> None:
        """End motion and the thread; a plate that is not level within three seconds stays as it is."""
        with self._changed:
            self._closing = True
            self._end_by_s = min(self._end_by_s, self._steady_s() + _ENDING_TIMEOUT_S)
            self._stop_reason = self._stop_reason or "shutting down"
            self._changed.notify_all()
        if self._thread.is_alive():
            self._thread.join(timeout_s)

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._wanted or self._closing)
                if self._closing:
                    return
            self._session()

    def _session(self) -> None:
        """From connecting to a stop, whatever the reason."""
        lost, reason = False, "the control loop failed"
        watch = RobotWatch(self._config)
        try:
            if not self._connect():
                reason = self._stop_reason
                return
            reason = self._servo(watch) if self._home(watch) else self._stop_reason
        except ActsError as error:
            # After a stop or loss of the robot nothing is sent to it any more; otherwise its program is ended.
            lost, reason = isinstance(error, RobotError), str(error)
        except Exception:
            self._closing = True  # the thread ends with it, and nothing can be started any more
            raise
        finally:
            ending = "; the robot's program may still run"
            try:
                ending = "" if lost else self._end_program(watch)
            finally:
                # Whatever comes of that. Told before the connection is cut, however long that takes; a start asked for
                # from now on comes after it.
                with self._changed:
                    self._wanted = False
                    self.status = replace(self.status, phase=Phase.STOPPED, reason=reason + ending)
                self._robot.disconnect()

    def _connect(self) -> bool:
        self.status = LoopStatus(phase=Phase.CONNECTING, reason="connecting")
        while self._may_go_on():
            try:
                self._robot.connect(self._may_go_on)
                return True
            except (RobotStoppedError, RobotTakenError):
                raise
            except RobotError as error:
                self.status = replace(self.status, reason=str(error))
            with self._changed:
                self._changed.wait_for(lambda: self._stop_reason, self._config.connect_retry_s)
        return False

    def _may_go_on(self) -> bool:
        """Whether the robot may still begin to move; who asked for that may have come near while nothing happened."""
        stood_still = self.stood_still(self._asked_s)
        if stood_still:
            self.stop(f"{stood_still} while it connected; call start again")
        return not self._stop_reason

    def _home(self, watch: RobotWatch) -> bool:
        """Move to the level pose; False when that was broken off."""
        if not self._may_go_on():
            return False  # no more since the robot was just connected
        self.status = replace(self.status, phase=Phase.HOMING, reason="moving to the level pose")
        before = self._checked(watch, 0.0).joints
        timeout_s = self._robot.begin_levelling()
        still, left_s = 0, timeout_s
        while left_s > 0.0:
            if self._stop_reason:
                self._robot.end_levelling()
                self._await_end(watch)
                return False
            left_s -= self._pause(_HOMING_PERIOD_S)
            reading = self._checked(watch, _HOMING_PERIOD_S)
            moved = max((abs(new - old) for new, old in zip(reading.joints, before, strict=True)), default=0.0)
            before = reading.joints
            still = still + 1 if moved < _STANDING_STILL and reading.off_level < _HOMED else 0
            if still >= _STANDING_STILL_POLLS:
                return True
        self._robot.end_levelling()
        self._await_end(watch)
        raise RobotError(f"the level pose was not reached within {timeout_s:.1f} s")

    def _servo(self, watch: RobotWatch) -> str:
        """Close the loop until motion has ended; the reason."""
        config = self._config
        period = 1.0 / config.control_rate_hz
        controller = BallController(config)
        gate = TiltGate(config)
        joints: tuple[float, ...] = ()
        steps = late = refused = 0
        rate = LoopRate(period, self._steady_s, self._sleep)
        while controller.state.phase is not Phase.STOPPED:
            cycle = rate.wait()
            if cycle.now_s > self._end_by_s:
                # By its settings levelling may take longer than a process may take to end.
                self._end_tilting(watch)
                return f"{controller.state.reason}; levelling was broken off after {_ENDING_TIMEOUT_S:g} s"
            steps += 1
            late += cycle.is_late
            passed_s = min(max(cycle.dt_s, _MIN_STEP_S), _MAX_PERIODS * period)
            # Before the robot is read and the time taken: it may have a whole queue of contacts to work on.
            self.look(controller.state.phase)
            reading = self._checked(watch, passed_s)
            if self._stop_reason:
                controller.end(self._stop_reason)
            self._take_changes(controller, gate)
            dt = min(passed_s, self._robot.longest_step_rad / gate.fastest_rad_s)
            now_ns = self._now_ns()
            measured = reading.tilt_rad
            tilt = controller.step(ControlInput(now_ns, self.ball, self.reference, measured), dt)
            fault = gate.fault(tilt, dt)
            if not fault:
                try:
                    joints = self._tilt(watch, tilt)
                    gate.sent(tilt)
                except CommandRefusedError as error:
                    fault = str(error)
            refused = refused + 1 if fault else 0
            if refused > 1:
                # Not even the way back to level can be sent.
                self._end_tilting(watch)
                return fault
            if fault:
                controller.end(fault)
            state = controller.state
            self.status = LoopStatus(
                # The robot counts as stopped only once it follows no more.
                phase=state.phase if state.phase is not Phase.STOPPED else self.status.phase,
                reason=state.reason,
                error_m=state.error_m,
                tilt_commanded_rad=tilt,
                tilt_measured_rad=measured,
                joints=joints,
                touch_age_s=state.touch_age_s,
                reference_problem=state.reference_problem,
                steps=steps,
                late_steps=late,
            )
            self._on_step(now_ns, measured)
        self._end_tilting(watch)
        return controller.state.reason

    def _tilt(self, watch: RobotWatch, tilt_rad: tuple[float, float]) -> tuple[float, ...]:
        """Send a tilt; the joint positions that were sent for it."""
        try:
            return self._robot.tilt(*tilt_rad)
        except CommandRefusedError:
            raise
        except RobotError as error:
            raise RobotError(self._cause(watch) or str(error)) from error

    def _end_tilting(self, watch: RobotWatch) -> None:
        self._robot.end_tilting()
        self._await_end(watch)

    def _take_changes(self, controller: BallController, gate: TiltGate) -> None:
        if self._newest_config is not self._config:
            self._config = self._newest_config
            controller.change(self._config)
            gate.limits = self._config

    def _end_program(self, watch: RobotWatch) -> str:
        """End the robot's program; what went wrong, to be added to the reason."""
        try:
            self._robot.release()
            self._await_end(watch)
        except RobotError as error:
            return f"; the robot's program may still run: {error}"
        return ""

    def _await_end(self, watch: RobotWatch) -> None:
        """Wait until the robot has done what ends motion. It may brake for a while, but it must be there."""
        left_s = _ENDING_TIMEOUT_S
        while self._robot.is_busy:
            passed_s = self._pause(_ENDING_PERIOD_S)
            left_s -= passed_s
            loss = watch.loss(self._robot.read(), passed_s)
            if loss:
                raise RobotError(loss)
            if left_s < 0.0:
                raise RobotError(f"the robot has not ended its motion within {_ENDING_TIMEOUT_S:g} s")

    def _checked(self, watch: RobotWatch, dt: float) -> RobotReading:
        try:
            reading = self._robot.read()
        except RobotError as error:
            raise RobotError(self._cause(watch) or str(error)) from error
        fault = watch.step(reading, dt)
        if fault:
            raise RobotError(fault)
        return reading

    def _cause(self, watch: RobotWatch) -> str:
        """Why a command was refused, or nothing: that it was is often known a packet earlier than why."""
        for _ in range(_REASON_LOOKS):
            with suppress(RobotError):
                fault = watch.step(self._robot.read(), 0.0)
                if fault:
                    return fault
            self._sleep(_REASON_PERIOD_S)
        return ""

    def _pause(self, seconds: float) -> float:
        """Let time pass between two looks at the robot; how much of it counts [s]."""
        begin_s = self._steady_s()
        self._sleep(seconds)
        return min(self._steady_s() - begin_s, _LONGEST_LOOK_S)
