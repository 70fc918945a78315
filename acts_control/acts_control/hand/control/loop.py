# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The loop of a hand: from connecting to a released hand, with everything that may interrupt it."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from acts_control.hand.control.behaviour import Behaviour
from acts_control.hand.control.beyond_limits import RETURN_RAD_S, beyond_reach, to_be_brought_back
from acts_control.hand.control.commands import JointCommands
from acts_control.hand.control.fault_memory import FaultMemory
from acts_control.hand.control.loop_config import HandLoopConfig
from acts_control.hand.control.status import HandPhase, HandStatus
from acts_control.hand.control.torque_wish import CUT_POWER, PendingAnswer, TorqueWish
from acts_control.hand.description import HandDescription
from acts_control.hand.motors import HandBus, HandError, HandLostError, HandReading
from acts_control.loop_rate import LoopRate, steady_s

_NOT_FINITE = "the goals stand still, for what was asked for cannot be"


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
        self._commands = JointCommands(hand, config.command_stale_after_s, log)
        self._wish = TorqueWish(is_on=config.autostart)
        self._is_on = False  # whether the torque of a motor may be on
        self._refused_since_s = math.inf  # when the motors have begun to take no goals
        self._closing = threading.Event()
        self._faults = FaultMemory(len(hand.joints), config.max_faults)
        self._thread = threading.Thread(target=self._run, name="hand_loop", daemon=True)

    def launch(self) -> None:
        """Start the thread."""
        self._wish.is_served = True
        self._thread.start()

    def close(self, timeout_s: float = 10.0) -> None:
        """Release the hand and end the thread."""
        self._closing.set()
        if self._thread.is_alive():
            self._thread.join(timeout_s)

    def command(self, angles_rad: Mapping[str, float]) -> None:
        """Send joints to angles; those that are not named keep their goal.

        After this program stood still, which is logged, commands are left out for `command_stale_after_s`.

        Raises
        ------
        HandError
            For no name, one that the hand does not have, or an angle that is not finite; nothing is changed then.
        """
        self._commands.take(angles_rad)

    def enable(self) -> str:
        """Switch the torque on, now or as soon as the hand is connected; why it is still off, or nothing.

        Waits until it is on, for two seconds at most.
        """
        return self.ask_enable().wait()

    def ask_enable(self) -> PendingAnswer:
        """Like `enable`, for who does not wait here."""
        if self._wish.is_served:
            if not self._wish.is_on:
                self._faults.forget()  # somebody has looked after the motors
            self._wish.on()
        phase = self.status.phase
        # An enabled hand may be about to switch its torque off, as was asked for before this.
        is_at_work = self._wish.is_under_way if phase is HandPhase.ENABLED else phase is not HandPhase.CONNECTING
        waits = self._wish.is_served and is_at_work
        return PendingAnswer(self._wish.on_is_known, lambda: self._wish.why_not_on(self.status), waits=waits)

    @property
    def is_torque_wanted(self) -> bool:
        """Whether the torque is to be on: where it is off, it comes on as soon as it can."""
        return self._wish.is_on

    def cancel_enable(self) -> bool:
        """The torque stays off, if it is wanted and has yet to come on, also again; whether that is so."""
        if not self._wish.is_under_way:
            return False
        self._wish.off("stopped before it was on")
        return True

    def release(self) -> str:
        """Switch the torque off, now or as soon as the hand is connected; why it may still be on, or nothing.

        Waits for what the motors say to it, for two seconds at most.
        """
        return self.ask_release().wait()

    def ask_release(self) -> PendingAnswer:
        """Like `release`, for who does not wait here."""
        self._wish.off("released by request")
        waits = self._wish.is_served and self.status.phase is not HandPhase.CONNECTING
        return PendingAnswer(self._wish.off_is_known, lambda: self._wish.why_not_off(self.status), waits=waits)

    def _run(self) -> None:
        try:
            while not self._closing.is_set():
                self._run_once()
                self._closing.wait(self._config.connect_retry_s)
        finally:
            if self._is_on:
                self._switch_off_at_last()
            self._bus.close()
            self._wish.is_served = False
            self._wish.tell_all()

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
        except Exception as error:
            # The thread ends with it, when the motors have been switched off; `enable` says that nothing runs.
            reason = f"the loop failed with {type(error).__name__}: {error}; start the node again"
            self._set(HandPhase.GIVEN_UP, reason, reading=None)
            raise
        finally:
            self._wish.tell_all()
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
                self._bus.disconnect()  # or its port, opened already, may keep the next attempt from it
                self._closing.wait(self._config.connect_retry_s)
                continue
            self._is_on = False
            self._set(HandPhase.RELEASED, self._wish.why_released)
            return

    def _serve(self) -> None:
        """Read and command at the rate, until the hand is lost or the loop is to end."""
        period_s = 1.0 / self._config.rate_hz
        # When they have begun to give no answer: while this program stands still, nobody asks them.
        silent_since_s = math.inf
        rate = LoopRate(period_s)
        goal: list[float] = []
        try:
            while not self._closing.is_set():
                now_s, dt_s, is_late = rate.wait()
                self._count(cycles=1, late=int(is_late))
                try:
                    reading = self._bus.read()
                    broken = reading.not_finite()
                    if broken:
                        raise HandError(f"the motors answered with {broken}")
                except HandLostError:
                    raise
                except HandError:
                    self._count(unanswered=1)
                    silent_since_s = min(silent_since_s, now_s)
                    if now_s - silent_since_s > self._config.silence_s:
                        raise
                    self._obey_release()  # for those that answer
                    self._note_silence(now_s)
                    continue
                silent_since_s = math.inf
                self._set(self.status.phase, self.status.reason, reading=reading)
                self._on_reading(reading)
                self._obey_release()
                if any(reading.faults):
                    self._recover(reading)
                    goal = []
                else:
                    goal = self._move(reading, goal, min(dt_s, 4.0 * period_s), now_s)
        finally:
            self._wish.has_gone_off()
            self._release_at_end()

    def _obey_release(self) -> None:
        """Switch the torque off where that is wanted."""
        if self._wish.is_on or (self._wish.off_is_known.is_set() and not self._is_on):
            return
        if self._is_on:
            self._release()
        if self.status.phase is not HandPhase.GIVEN_UP:
            self._set(HandPhase.RELEASED, self._wish.why_off)
        self._wish.off_is_known.set()

    def _move(self, reading: HandReading, goal: list[float], dt_s: float, now_s: float) -> list[float]:
        """One cycle of a hand that is well: switch the torque on if that is wanted, and bring the goals nearer."""
        phase = self.status.phase
        if not self._wish.is_on and phase is not HandPhase.ENABLED:
            return []
        if reading.is_stopped and phase is HandPhase.ENABLED:
            self._log(
                "warning", "the motors' watchdog has stopped them, which heard nothing for long; the hand goes on"
            )
            phase = HandPhase.RECOVERING
        if phase is not HandPhase.ENABLED:
            self._switch_on(reading, recovered=phase is HandPhase.RECOVERING)
            return []
        # Switching on takes many exchanges: goals begin where the joints are after it, or the first would be a leap.
        goal = goal or list(reading.q_rad)
        targets, reason = self._targets(reading, goal, now_s, dt_s)
        moved = self._nearer(goal, targets, dt_s)
        try:
            self._bus.command(moved)
        except HandLostError:
            raise
        except HandError:
            # One answer may be lost, as that to a read; the next goals start from those before.
            self._count(unanswered=1)
            self._refused_since_s = min(self._refused_since_s, now_s)
            if now_s - self._refused_since_s > self._config.silence_s:
                raise
            return goal
        self._refused_since_s = math.inf
        if self._behaviour is not None:
            self._behaviour.sent(now_s, steady_s())
        self._set(HandPhase.ENABLED, reason, goal_rad=tuple(moved))
        if self._wish.is_on and self._wish.is_under_way:
            # Somebody has released and enabled it since the loop looked last: the torque has stayed on.
            self._wish.has_come_on()
        return moved

    def _nearer(self, goal: Sequence[float], targets: Mapping[int, float], dt_s: float) -> list[float]:
        """The goals of all joints, moved as far towards their targets as the speed allows; without one they stay.

        What is out of a joint's limits comes back first, and slowly.
        """
        step, moved = self._config.max_speed_rad_s * dt_s, []
        for k, joint in enumerate(self._hand.joints):
            target, most = targets.get(k, goal[k]), step
            if joint.clipped(goal[k]) != goal[k]:
                target, most = joint.clipped(goal[k]), min(step, RETURN_RAD_S * dt_s)
            moved.append(goal[k] + min(max(target - goal[k], -most), most))
        return moved

    def _switch_on(self, reading: HandReading, *, recovered: bool) -> None:
        """Hold every joint where it is."""
        far = beyond_reach(self._hand, reading)
        if far:
            self._give_up(far)
            return
        self._is_on, began_s = True, steady_s()
        self._bus.enable()
        took_s, self._refused_since_s = steady_s() - began_s, math.inf
        if not self._wish.is_on:
            # Meanwhile somebody has stopped or released it: from here on the hand would hold.
            self._obey_release()
            return
        if recovered:
            self._commands.begin_again(took_s)
        else:
            self._commands.begin()
        for sentence in to_be_brought_back(self._hand, reading):
            self._log("warning", sentence)
        if self._behaviour is not None:
            self._behaviour.restart(recovered=recovered)
        self._set(HandPhase.ENABLED, "holding", goal_rad=reading.q_rad)
        self._wish.has_come_on()

    def _targets(
        self, reading: HandReading, goal: Sequence[float], now_s: float, dt_s: float
    ) -> tuple[dict[int, float], str]:
        """Where joints are to go, by their numbers, and in words why."""
        if self._behaviour is None:
            return self._commands.targets(now_s)
        wanted = [float(angle) for angle in self._behaviour.step(reading, goal, now_s, dt_s)]
        joints = self._hand.joints
        if len(wanted) != len(joints) or not all(map(math.isfinite, wanted)):
            if self.status.reason != _NOT_FINITE:
                self._log("error", f"{_NOT_FINITE}: {wanted}; needed are {len(joints)} finite angles")
            return {}, _NOT_FINITE
        return {k: joint.clipped(angle) for k, (joint, angle) in enumerate(zip(joints, wanted, strict=True))}, "acting"

    def _note_silence(self, now_s: float) -> None:
        """Motors that do not answer are no standstill of this program."""
        if self.status.phase not in (HandPhase.ENABLED, HandPhase.RECOVERING):
            return
        if self._behaviour is None:
            self._commands.look()
        else:
            self._behaviour.waited(min(steady_s() - now_s, self._config.silence_s))

    def _recover(self, reading: HandReading) -> None:
        """Motors have switched themselves off: start them anew, or give up what does it again and again."""
        # Who enables a hand that was given up has looked after these motors.
        is_forgiven = self.status.phase is HandPhase.GIVEN_UP
        if is_forgiven and not self._wish.is_on:
            return
        for k, fault in enumerate(reading.faults):
            if not fault:
                continue
            # Starting the one before anew may have taken seconds, in which the others gripped on.
            if self._closing.is_set():
                return
            self._obey_release()
            name = self._hand.joints[k].name
            if not is_forgiven and self._faults.add(k):
                self._give_up(f"{name}: {fault}, {self._config.max_faults} times within a minute; call enable to go on")
                return
            self._log("error", f"{name}: {fault}; its motor is started anew")
            if self.status.phase in (HandPhase.ENABLED, HandPhase.RECOVERING):
                self._set(HandPhase.RECOVERING, f"{name}: {fault}")
            else:
                self._set(HandPhase.RELEASED, f"{name}: {fault}" if self._wish.is_on else self._wish.why_released)
            began_s = steady_s()
            self._bus.recover(k)
            self._commands.was_at_work(steady_s() - began_s)
            self._count(recovered=1)

    def _give_up(self, reason: str) -> None:
        """All torque off, until somebody calls `enable`."""
        # First, so that it stays given up where the motors do not answer to the rest.
        self._wish.off(reason)
        self._log("error", reason)
        self._release()
        self._set(HandPhase.GIVEN_UP, reason)
        self._wish.off_is_known.set()

    def _release_at_end(self) -> None:
        if not self._closing.is_set():
            return
        try:
            self._release()
            self._set(HandPhase.RELEASED, "shutting down")
        except HandError as error:
            self._log("error", f"{error}; {CUT_POWER}")

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
