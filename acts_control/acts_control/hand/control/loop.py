# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The loop of a hand: from connecting to a released hand, with everything that may interrupt it."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from math import isfinite
from typing import Protocol

from acts_control.hand.description import HandDescription
from acts_control.hand.motors import HandBus, HandError, HandLostError, HandReading
from acts_core.settings import setting, validate

_FAULT_MEMORY_S = 60.0
_NOT_FINITE = "the goals stand still, for what was asked for cannot be"


class HandPhase(IntEnum):
    """What the hand does."""

    CONNECTING = 0
    RELEASED = 1
    ENABLED = 2
    RECOVERING = 3
    GIVEN_UP = 4


@dataclass(frozen=True)
class HandLoopConfig:
    """Rates and limits of the loop."""

    rate_hz: float = setting(100.0, "how often the motors are read and commanded", minimum=10.0, maximum=500.0)
    max_speed_rad_s: float = setting(
        3.0, "fastest that a joint's goal moves towards the command [rad/s]", minimum=0.01, maximum=8.0
    )
    command_stale_after_s: float = setting(
        0.5, "without a command for longer the goals stand still [s]", minimum=0.01, maximum=10.0
    )
    silence_s: float = setting(
        0.3, "motors that do not answer for longer are connected anew [s]", minimum=0.05, maximum=10.0
    )
    connect_retry_s: float = setting(1.0, "time between attempts to connect [s]", minimum=0.05, maximum=60.0)
    max_faults: int = setting(
        2, "a motor that has switched itself off so often within a minute is given up", minimum=1, maximum=100
    )
    autostart: bool = setting(True, "whether to switch the torque on at once; else on ~/enable")

    def __post_init__(self) -> None:
        validate(self)


@dataclass(frozen=True)
class HandStatus:
    """What the loop does, as of the last cycle.

    Attributes
    ----------
    phase : HandPhase
    reason : str
        Why, in words.
    reading : HandReading or None
        Newest one; None before the first and while the hand is not connected.
    goal_rad : tuple of float
        What was sent last [rad].
    cycles, late, unanswered, recovered : int
        Cycles so far; those that began more than half a period late; reads without an answer; motors started anew.
    """

    phase: HandPhase = HandPhase.CONNECTING
    reason: str = "not started"
    reading: HandReading | None = None
    goal_rad: tuple[float, ...] = ()
    cycles: int = 0
    late: int = 0
    unanswered: int = 0
    recovered: int = 0


class Behaviour(Protocol):
    """What moves a hand instead of commands, from the loop's thread."""

    def restart(self, *, recovered: bool) -> None:
        """The torque is on again, and every joint holds where it is; `recovered`: after a motor had failed."""

    def step(self, reading: HandReading, goal_rad: Sequence[float], now_s: float, dt_s: float) -> Sequence[float]:
        """Called with each reading while the torque is on.

        Parameters
        ----------
        reading : HandReading
        goal_rad : sequence of float
            What was sent last [rad].
        now_s, dt_s : float
            By `time.monotonic`, and since the step before [s].

        Returns
        -------
        sequence of float
            Where every joint is to go [rad].
        """

    def sent(self, began_s: float, sent_s: float) -> None:
        """What `step` asked for has been sent; when its cycle began, and now, by `time.monotonic` [s]."""


class HandLoop:
    """Runs a hand in a thread of its own.

    Parameters
    ----------
    hand : HandDescription
    bus : HandBus
    config : HandLoopConfig
    log : callable
        Takes a level (info, warning, error) and a sentence; called from the loop's thread.
    on_reading : callable
        Called after every reading, from the loop's thread.
    behaviour : Behaviour or None
        Says where the joints go; None: `command` does.

    Attributes
    ----------
    status : HandStatus
        Replaced as a whole.
    """

    def __init__(
        self,
        hand: HandDescription,
        bus: HandBus,
        config: HandLoopConfig,
        log: Callable[[str, str], None],
        on_reading: Callable[[HandReading], None] = lambda _reading: None,
        behaviour: Behaviour | None = None,
    ) -> None:
        self.status = HandStatus()
        self._hand = hand
        self._bus = bus
        self._config = config
        self._log = log
        self._on_reading = on_reading
        self._behaviour = behaviour
        self._index = {joint.name: k for k, joint in enumerate(hand.joints)}
        self._lock = threading.Lock()
        self._target: dict[int, float] = {}
        self._commanded_s = -1e9
        self._enabled = config.autostart
        self._is_on = False  # whether the torque of a motor may be on
        self._closing = threading.Event()
        self._faults: list[deque[float]] = [deque(maxlen=config.max_faults) for _ in hand.joints]
        self._thread = threading.Thread(target=self._run, name="hand_loop", daemon=True)

    def launch(self) -> None:
        """Start the thread."""
        self._thread.start()

    def close(self, timeout_s: float = 10.0) -> None:
        """Release the hand and end the thread."""
        self._closing.set()
        if self._thread.is_alive():
            self._thread.join(timeout_s)

    def command(self, angles_rad: Mapping[str, float]) -> None:
        """Send joints to angles; those that are not named keep their goal.

        Raises
        ------
        HandError
            For no name, one that the hand does not have, or an angle that is not finite; nothing is changed then.
        """
        if not angles_rad:
            raise HandError(f"a command without a joint; the hand's joints are {', '.join(self._index)}")
        unknown = next((name for name in angles_rad if name not in self._index), None)
        if unknown is not None:
            raise HandError(f"the hand has no joint {unknown[:64]!r}; its joints are {', '.join(self._index)}")
        broken = [f"{name} = {angle}" for name, angle in angles_rad.items() if not isfinite(angle)]
        if broken:
            raise HandError(f"{', '.join(broken)}: angles have to be finite")
        now_s = time.monotonic()
        with self._lock:
            if now_s - self._commanded_s > self._config.command_stale_after_s:
                self._target.clear()
            for name, angle in angles_rad.items():
                self._target[self._index[name]] = self._hand.joints[self._index[name]].clipped(angle)
            self._commanded_s = now_s

    def enable(self) -> str:
        """Switch the torque on, now or as soon as the hand is connected; why that cannot be, or nothing."""
        if self._closing.is_set() or not self._thread.is_alive():
            return f"the hand's loop has ended: {self.status.reason}"
        for faults in self._faults:
            faults.clear()
        self._enabled = True
        return ""

    def release(self) -> str:
        """Switch the torque off, now or as soon as the hand is connected; why that cannot be now, or nothing."""
        self._enabled = False
        status = self.status
        if not self._thread.is_alive():
            return f"the hand's loop has ended: {status.reason}"
        if status.phase is HandPhase.CONNECTING:
            return f"the hand is not connected ({status.reason}); its motors are released as soon as it is"
        return ""

    def _run(self) -> None:
        try:
            while not self._closing.is_set():
                self._run_once()
                self._closing.wait(self._config.connect_retry_s)
        finally:
            if self._is_on:
                self._switch_off_at_last()
            self._bus.close()

    def _run_once(self) -> None:
        """Until the hand is lost, or the loop is to end."""
        try:
            self._connect()
            if not self._closing.is_set():
                self._serve()
        except HandLostError as error:
            self._log("error", str(error))
            self._set(HandPhase.CONNECTING, str(error), reading=None)
        except HandError as error:
            self._log("error", f"{error}; connecting anew")
            self._set(HandPhase.CONNECTING, str(error), reading=None)
        except Exception:
            # The thread ends with it, when the motors have been switched off; `enable` says that nothing runs.
            self._set(HandPhase.GIVEN_UP, "the hand's loop failed", reading=None)
            raise
        finally:
            self._bus.disconnect()

    def _connect(self) -> None:
        """Try until the hand is there."""
        told = ""
        while not self._closing.is_set():
            try:
                for sentence in self._bus.connect():
                    self._log("warning", sentence)
            except HandError as error:
                if str(error) != told:
                    self._log("warning", f"{error}; trying again every {self._config.connect_retry_s:g} s")
                told = str(error)
                self._set(HandPhase.CONNECTING, told, reading=None)
                self._closing.wait(self._config.connect_retry_s)
                continue
            self._is_on = False
            self._set(HandPhase.RELEASED, "connected")
            return

    def _serve(self) -> None:
        """Read and command at the rate, until the hand is lost or the loop is to end."""
        period_s = 1.0 / self._config.rate_hz
        due_s = last_s = answered_s = time.monotonic()
        goal: list[float] = []
        try:
            while not self._closing.is_set():
                due_s += period_s
                wait_s = due_s - time.monotonic()
                if wait_s > 0.0:
                    time.sleep(wait_s)
                elif wait_s < -period_s:
                    due_s -= wait_s  # no burst of cycles to make up for lost ones
                now_s = time.monotonic()
                dt_s, last_s = now_s - last_s, now_s
                self._count(cycles=1, late=int(dt_s > 1.5 * period_s))
                try:
                    reading = self._bus.read()
                    if not all(map(isfinite, reading.q_rad)):
                        raise HandError(f"the motors answered with angles that are not finite: {reading.q_rad}")
                except HandLostError:
                    raise
                except HandError:
                    self._count(unanswered=1)
                    if now_s - answered_s > self._config.silence_s:
                        raise
                    continue
                answered_s = now_s
                self._set(self.status.phase, self.status.reason, reading=reading)
                self._on_reading(reading)
                if any(reading.faults):
                    self._recover(reading)
                    goal = []
                    continue
                goal = self._move(reading, goal, min(dt_s, 4.0 * period_s), now_s)
        finally:
            self._release_at_end()

    def _move(self, reading: HandReading, goal: list[float], dt_s: float, now_s: float) -> list[float]:
        """One cycle of a hand that is well: switch the torque as is wanted, and bring the goals nearer."""
        phase = self.status.phase
        if not self._enabled:
            if phase in (HandPhase.ENABLED, HandPhase.RECOVERING):
                self._release()
                self._set(HandPhase.RELEASED, "released by request")
            return []
        if reading.is_stopped and phase is HandPhase.ENABLED:
            self._log("warning", "the motors' watchdog has stopped them: this process stood still; the hand goes on")
            phase = HandPhase.RECOVERING
        if phase is not HandPhase.ENABLED:
            self._is_on = True
            self._bus.enable()
            with self._lock:
                self._target.clear()  # what was wanted before is old
            goal = list(reading.q_rad)
            if self._behaviour is not None:
                self._behaviour.restart(recovered=phase is HandPhase.RECOVERING)
            self._set(HandPhase.ENABLED, "holding", goal_rad=tuple(goal))
            return goal
        targets, reason = self._targets(reading, goal, now_s, dt_s)
        step = self._config.max_speed_rad_s * dt_s
        for k, target in targets.items():
            goal[k] += min(max(target - goal[k], -step), step)
        self._bus.command(goal)
        if self._behaviour is not None:
            self._behaviour.sent(now_s, time.monotonic())
        self._set(HandPhase.ENABLED, reason, goal_rad=tuple(goal))
        return goal

    def _targets(
        self, reading: HandReading, goal: Sequence[float], now_s: float, dt_s: float
    ) -> tuple[dict[int, float], str]:
        """Where joints are to go, by their numbers, and in words why."""
        if self._behaviour is None:
            with self._lock:
                fresh = now_s - self._commanded_s <= self._config.command_stale_after_s
                return (dict(self._target), "moving as commanded") if fresh else ({}, "holding")
        wanted = [float(angle) for angle in self._behaviour.step(reading, goal, now_s, dt_s)]
        joints = self._hand.joints
        if len(wanted) != len(joints) or not all(map(isfinite, wanted)):
            if self.status.reason != _NOT_FINITE:
                self._log("error", f"{_NOT_FINITE}: {wanted}; needed are {len(joints)} finite angles")
            return {}, _NOT_FINITE
        return {k: joint.clipped(angle) for k, (joint, angle) in enumerate(zip(joints, wanted, strict=True))}, "acting"

    def _recover(self, reading: HandReading) -> None:
        """Motors have switched themselves off: start them anew, or give up what does it again and again."""
        if self.status.phase is HandPhase.GIVEN_UP and not self._enabled:
            return
        now_s = time.monotonic()
        for k, fault in enumerate(reading.faults):
            if not fault:
                continue
            name = self._hand.joints[k].name
            self._faults[k].append(now_s)
            if self._gave_up():
                # First, so that it stays given up where the motors do not answer to the rest.
                self._enabled = False
                reason = f"{name}: {fault}, {self._config.max_faults} times within a minute; ~/enable to go on"
                self._log("error", reason)
                self._release()
                self._set(HandPhase.GIVEN_UP, reason)
                return
            self._log("error", f"{name}: {fault}; its motor is started anew")
            was_on = self.status.phase in (HandPhase.ENABLED, HandPhase.RECOVERING)
            self._set(HandPhase.RECOVERING if was_on else HandPhase.RELEASED, f"{name}: {fault}")
            self._bus.recover(k)
            self._count(recovered=1)

    def _gave_up(self) -> bool:
        now_s = time.monotonic()
        return any(
            len(times) == self._config.max_faults and now_s - times[0] < _FAULT_MEMORY_S for times in self._faults
        )

    def _release_at_end(self) -> None:
        if not self._closing.is_set():
            return
        try:
            self._release()
            self._set(HandPhase.RELEASED, "shutting down")
        except HandError as error:
            self._log("error", f"{error}: the motors' own watchdog stops them")

    def _release(self) -> None:
        self._bus.release()
        self._is_on = False

    def _switch_off_at_last(self) -> None:
        """Connect once more, which switches off each motor that answers."""
        try:
            self._bus.connect()
        except HandError as error:
            self._log("error", f"the loop ends, and not all motors could be switched off: {error}")

    def _set(self, phase: HandPhase, reason: str, **changes: object) -> None:
        self.status = replace(self.status, phase=phase, reason=reason, **changes)  # type: ignore[arg-type]

    def _count(self, **counts: int) -> None:
        changed = {name: getattr(self.status, name) + count for name, count in counts.items()}
        self.status = replace(self.status, **changed)  # type: ignore[arg-type]
