# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the hand does: it opens, closes, holds, avoids or stands still, and asks the reflexes of that state.

Plain logic of one step, for the loop's own thread; `grasp`, `release` and `stop` may be called from any other.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.control.grasp import Grasp, GraspConfig, towards
from acts_control.hand.control.step_rule import StepRule, StepRuleConfig
from acts_control.hand.control.touch import HandTouch, no_touch
from acts_control.hand.description import HandKinematics
from acts_control.hand.motors import HandReading
from acts_control.hand.reflexes import HandState, Reflex, Sensed, Wish
from acts_control.loop_rate import steady_s
from acts_core.errors import SettingsError
from acts_core.settings import setting, validate
from acts_core.skin import RegionContact

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SupervisorConfig(StepRuleConfig, GraspConfig):
    """When the hand does what."""

    touch_stale_after_s: float = setting(0.1, "touch that is older counts as none [s]", minimum=0.005, maximum=5.0)
    max_force_n: float = setting(
        40.0, "a finger gives way where a region feels more, whatever else is wanted [N]", minimum=0.5, maximum=140.0
    )

    def __post_init__(self) -> None:
        validate(self)
        if self.grip_force_n >= self.max_force_n:
            raise SettingsError(
                f"grip_force_n = {self.grip_force_n:g}: allowed is less than max_force_n = {self.max_force_n:g}, at "
                f"which a finger gives way, or it would never have gripped"
            )


@dataclass(frozen=True)
class SupervisorStatus:
    """What is worth publishing, as of the last step.

    Attributes
    ----------
    state : HandState
    reason : str
        Why, in words.
    touch_age_s : float
        Of the newest touch; infinite before the first [s].
    touch_comes_old_s : float
        See `HandTouch.comes_old_s` [s].
    is_stale : bool
        Whether the newest counts as none.
    active : tuple of str
        Reflexes that ask for something, in the order of their priority.
    events : mapping of str to int
        How often each reflex has been set off.
    steps, refused : int
        Steps so far; messages of touch and answers of reflexes left out, for what cannot be.
    refusal : str
        Why the last of them was; empty before the first.
    unfelt : tuple of str
        Regions of the hand of which the newest touch says nothing: nothing is felt there.
    """

    state: HandState = HandState.STOPPED
    reason: str = "not started"
    touch_age_s: float = float("inf")
    touch_comes_old_s: float = 0.0
    is_stale: bool = True
    active: tuple[str, ...] = ()
    events: Mapping[str, int] = field(default_factory=dict)
    steps: int = 0
    refused: int = 0
    refusal: str = ""
    unfelt: tuple[str, ...] = ()


class HandSupervisor:
    """Composes reflexes into goals for the joints.

    Parameters
    ----------
    kinematics : HandKinematics
    reflexes : mapping of str to Reflex
    config : SupervisorConfig

    Attributes
    ----------
    status : SupervisorStatus
        Replaced as a whole.
    stood_still : callable
        Takes when a grasp was asked for, by `loop_rate.steady_s` [s]; in words that this program has stood still since,
        or nothing.

    Raises
    ------
    SettingsError
        When the hand has no such posture to grasp from, or settings of reflexes do not go together with its own.
    """

    def __init__(self, kinematics: HandKinematics, reflexes: Mapping[str, Reflex], config: SupervisorConfig) -> None:
        if config.grasp_posture not in kinematics.hand.postures:
            known = ", ".join(kinematics.hand.postures)
            raise SettingsError(f"grasp_posture = {config.grasp_posture!r}: the hand has {known}")
        for reflex in reflexes.values():
            reflex.check(config.grip_force_n, config.max_force_n)
        self._kinematics = kinematics
        self._hand = kinematics.hand
        self._reflexes = dict(sorted(reflexes.items(), key=lambda item: -item[1].priority))
        self._config = config
        self.status = SupervisorStatus(events=self._events())
        self.stood_still: Callable[[float], str] = lambda _asked_s: ""
        self._rule = StepRule(self._hand, config)
        self._state, self._reason = self.status.state, self.status.reason
        self._resumed = self._state
        # The last one counts. Filled from any thread: nothing that comes in between is overwritten.
        self._wanted: deque[str] = deque()
        self._asked_s = math.inf  # when the last grasp was asked for
        self._grasp = Grasp(config)
        self._touch = HandTouch(kinematics)
        self._was_stale = True
        self._stepped_s = math.inf  # at the last step; none before, and since the torque is on

    # --- from any thread

    def grasp(self) -> str:
        """Close until something is gripped, then hold it; why that cannot be, or nothing."""
        status = self.status
        if status.is_stale:
            advice = "" if status.touch_comes_old_s else ": is the skin's topic `regions` published?"
            return f"{no_touch(status.touch_age_s, status.touch_comes_old_s)}{advice}"
        self._asked_s = steady_s()
        self._wanted.append("grasp")
        return ""

    def release(self) -> str:
        """Open the hand."""
        self._wanted.append("release")
        return ""

    def stop(self) -> str:
        """Stand still, the torque on; what is held stays held."""
        self._wanted.append("stop")
        return ""

    # --- from the loop's thread

    def restart(self, *, recovered: bool) -> None:
        """The torque is on again, and every joint holds where it is; `recovered`: after motors had failed or stopped.

        The hand stands still then, whatever it did before: something else may be between its fingers by now. Only what
        was asked for while a motor was started anew is done.
        """
        if recovered:
            reason = "motors had failed or stopped: goals stand where the joints are; grasp anew"
        else:
            self._wanted.clear()  # what was asked for before the hand was lost is old
            reason = "goals stand where the joints are"
        self._become(HandState.STOPPED, reason)
        self._stepped_s = math.inf
        self.status = replace(self.status, state=self._state, reason=self._reason, active=())

    def touch(self, regions: Sequence[RegionContact], stamp_s: float, now_s: float) -> bool:
        """Take what the skin feels.

        Parameters
        ----------
        regions : sequence of RegionContact
        stamp_s, now_s : float
            When it was measured, and the present, by the clock of `step` [s].

        Returns
        -------
        bool
            False where it cannot be, or newer touch has come before: it counts as not come.
        """
        return self._touch.take(regions, stamp_s, now_s)

    def refuse(self, why: str) -> bool:
        """Count touch that has come and cannot be used; False."""
        return self._touch.refuse(why)

    @property
    def _refused(self) -> int:
        """Messages of touch and answers of reflexes left out so far."""
        return self._touch.refused + self._rule.refused

    def watch(self, now_s: float) -> None:
        """Judge the touch that has come, while the torque is off and there are no steps; `now_s` as in `touch` [s]."""
        age_s = self._touch.age_s(now_s)
        self.status = replace(
            self.status,
            touch_age_s=age_s,
            touch_comes_old_s=self._touch.comes_old_s(now_s, self._config.touch_stale_after_s),
            is_stale=age_s > self._config.touch_stale_after_s,
            refused=self._refused,
            refusal=self._touch.refusal,
            unfelt=self._touch.unfelt,
        )

    def waited(self, seconds: float) -> None:
        """See `acts_control.hand.control.Behaviour`."""
        self._stepped_s += seconds

    def step(self, reading: HandReading, goal_rad: Sequence[float], now_s: float, dt_s: float) -> Array:
        """The goals of all joints for now.

        Parameters
        ----------
        reading : HandReading
        goal_rad : sequence of float
            Those that were sent last [rad].
        now_s, dt_s : float
            The time, and since the step before, as far as goals may move for it [s].

        Returns
        -------
        np.ndarray [shape=(joints,)]
            [rad]
        """
        q, goal = np.array(reading.q_rad), np.array(goal_rad)
        self._obey()
        age_s = self._touch.age_s(now_s)
        stale_after_s = self._config.touch_stale_after_s
        # The loop tells of no more than a few periods: nobody has looked at touch for the rest.
        stood_still = now_s - self._stepped_s > dt_s + stale_after_s
        self._stepped_s = now_s
        is_stale = stood_still or age_s > stale_after_s
        if is_stale and (not self._was_stale or self._state is HandState.CLOSING):
            self._lose_touch("this program stood still" if stood_still else "touch is stale")
        elif self._was_stale and not is_stale:
            self._find_touch()
        self._was_stale = is_stale
        sensed = Sensed(
            time_s=now_s,
            dt_s=dt_s,
            state=self._state,
            kinematics=self._kinematics,
            q_rad=q,
            goal_rad=goal,
            current_ma=np.array(reading.current_ma),
            step_rad_s=self._rule.step_rad_s,
            regions={} if is_stale else self._touch.regions,
            is_new=self._touch.is_new and not is_stale,
            is_shaped=self._grasp.is_shaped,
        )
        self._touch.is_new = False
        asked, active = self._ask(sensed, is_stale)
        goal = self._rule.goals(goal, q, sensed.current_ma, asked, dt_s)
        self.status = SupervisorStatus(
            state=self._state,
            reason=self._reason,
            touch_age_s=age_s,
            touch_comes_old_s=self._touch.comes_old_s(now_s, stale_after_s),
            is_stale=is_stale,
            active=tuple(active),
            events=self._events(),
            steps=self.status.steps + 1,
            refused=self._refused,
            refusal=self._touch.refusal,
            unfelt=self._touch.unfelt,
        )
        return goal

    def _events(self) -> dict[str, int]:
        return {name: reflex.events for name, reflex in self._reflexes.items()}

    def _ask(self, sensed: Sensed, is_stale: bool) -> tuple[list[Wish], list[str]]:
        """What is to be done now, that of the highest priority first, and the reflexes that ask for it."""
        limited = self._give_way(sensed)
        of_reflexes = {} if is_stale else self._reflex_wishes(sensed)
        wishes = [*([] if limited is None else [limited]), *of_reflexes.values()]
        # Who claims all joints has the hand: closing waits meanwhile.
        has_hand = any(wish.claimed is not None and wish.claimed.all() for wish in wishes)
        own = None if has_hand and sensed.state is HandState.CLOSING else self._own(sensed, is_stale)
        if own is not None:
            wishes.append(own)
        avoids = next((wish.why for wish in of_reflexes.values() if wish.avoids and wish.why), "")
        self._change_by(wishes, avoids, sensed.state)
        return wishes, list(of_reflexes)

    def _reflex_wishes(self, sensed: Sensed) -> dict[str, Wish]:
        """What the reflexes of the present state ask for, by their names and in the order of their priority.

        Of one whose steps are not finite nothing counts: neither that it holds or avoids, nor the joints it claims.
        """
        wishes = {}
        for name, reflex in self._reflexes.items():
            wish = reflex.step(sensed) if sensed.state in reflex.states else None
            if wish is not None and self._rule.is_usable(wish):
                wishes[name] = wish
            elif wish is not None:
                self._touch.refusal = f"{name} asks for steps that are not finite"
        return wishes

    def _change_by(self, wishes: Sequence[Wish], avoids: str, state: HandState) -> None:
        """Change to the state that the wishes of a step ask for; `avoids`: why something is avoided, or nothing."""
        if avoids and state in (HandState.CLOSING, HandState.HOLDING):
            self._resumed = state
            self._become(HandState.AVOIDING, avoids)
        elif not avoids and state is HandState.AVOIDING:
            self._become(self._resumed, "nothing sharp any more")
        elif state is HandState.CLOSING:
            for wish in wishes:
                if wish.holds:
                    self._become(HandState.HOLDING, wish.why)

    # --- what the supervisor itself does

    def _own(self, sensed: Sensed, is_stale: bool) -> Wish | None:
        if sensed.state is HandState.OPEN:
            return towards(sensed, "open", self._config.open_speed_rad_s)
        if sensed.state is HandState.CLOSING and not is_stale:
            wish = self._grasp.step(sensed)
            if self._grasp.ended:
                state = HandState.HOLDING if self._grasp.has_gripped else HandState.OPEN
                self._become(state, self._grasp.ended)
            return wish
        return None

    def _give_way(self, sensed: Sensed) -> Wish | None:
        """Open every finger that presses with more than is allowed, whatever is asked for besides."""
        pressed = [name for name, one in sensed.regions.items() if one.force_n > self._config.max_force_n]
        if not pressed:
            return None
        steps = sensed.steps()
        fingers = [sensed.finger(name) for name in pressed]
        if "" in fingers:
            fingers = list(self._hand.fingers)  # any of them may hold it to the palm
        for finger in fingers:
            steps -= self._config.max_steps * 0.2 * sensed.closing(finger)
        return Wish(steps, f"{', '.join(pressed)} felt more than is allowed", steps < 0.0, at_once=True)

    # --- changes

    def _obey(self) -> None:
        wanted = ""
        while self._wanted:
            wanted = self._wanted.popleft()
        stood_still = self.stood_still(self._asked_s) if wanted == "grasp" else ""
        if stood_still:
            # As while a motor was started anew: there may be a hand of somebody's between the fingers by now.
            self._become(HandState.STOPPED, f"{stood_still} before it began to close; grasp anew")
        elif wanted == "grasp":
            self._reset_reflexes()
            self._grasp.reset()
            self._become(HandState.CLOSING, "grasp")
        elif wanted == "release":
            self._become(HandState.OPEN, "released by request")
        elif wanted == "stop":
            self._become(HandState.STOPPED, "stopped by request")

    def _lose_touch(self, why: str) -> None:
        goes_on_with = self._resumed if self._state is HandState.AVOIDING else self._state
        if goes_on_with is HandState.CLOSING:
            self._become(HandState.STOPPED, f"{why} while closing; grasp anew")
        elif self._state in (HandState.HOLDING, HandState.AVOIDING):
            self._rule.reset()  # or the steps that were asked for last would only fade
            self._become(HandState.HOLDING, f"{why}: the grip stays as it is, no reflex acts")

    def _find_touch(self) -> None:
        self._reset_reflexes()
        if self._state is HandState.HOLDING:
            self._reason = "touch is back"

    def _become(self, state: HandState, reason: str) -> None:
        if state is HandState.STOPPED:
            self._rule.reset()
            # No reflex is asked meanwhile: what each remembers would be old.
            self._reset_reflexes()
        self._state, self._reason = state, reason

    def _reset_reflexes(self) -> None:
        for reflex in self._reflexes.values():
            reflex.reset()
