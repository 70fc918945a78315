# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The rig of `acts evaluate hand` over the real interfaces: like `HandRig`, but with a running launch.

It is slightly behind the present, so that all data of its time have arrived: truth from a ring, status and regions
from topics. It begins with an open hand, as `HandRig` does: until the node has found the motors they have no torque,
and in most poses fingers sink towards where a grasp would find them.
"""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes import HandState
from acts_core.errors import LaunchError
from acts_core.skin import RegionContact
from acts_sim.hand import HandTruth, HandWorldConfig, held_object
from acts_tools.hand_rigs.live import HandRefusalError, LiveHand
from acts_tools.hand_rigs.recording import Array

_SILENCE_S = 10.0
_PAUSE_S = 0.3
_REFUSED_S = 5.0
_OPEN_RAD = np.array(LEAP_RIGHT.postures["open"])
# Fingers that gravity pulls at stay short of their goals.
_NEARLY_OPEN_RAD = 0.05
_OPENING_S = 2.0
_OPENINGS = 3
_GRASP_S = 10.0
_GRAVITY_M_S2 = 9.81


class LiveRig:
    """A running hand; time is real time.

    Parameters
    ----------
    hand : LiveHand
    config : HandWorldConfig
        Settings of its world.

    Attributes
    ----------
    world : LiveWorld
        The true state, and commands to the world.
    supervisor : LiveSupervisor
    reflexes : dict of str to LiveReflex
    behind_s : float
        How long after the present it knows of it, and can do something [s].
    """

    behind_s = 0.1

    def __init__(self, hand: LiveHand, config: HandWorldConfig) -> None:
        self._hand = hand
        self._recording = hand.recording
        self._pending: deque[tuple[float, Array]] = deque()
        # Ignore data from before.
        self._pieces = len(self._recording.truth_times)
        self._statuses = self._region_times = 0
        self._time_s = -math.inf
        self._row: Array | None = None
        self.world = LiveWorld(self, config)
        self.supervisor = LiveSupervisor(self)
        self.reflexes = {name: LiveReflex(self, name) for name in self._recording.statuses[-1].events}
        self.step()
        self._open()

    @property
    def time_s(self) -> float:
        """Time of the present data, CLOCK_MONOTONIC [s]."""
        return self._time_s

    @property
    def state(self) -> HandState:
        """State of the hand."""
        return HandState(self._recording.statuses[self._statuses].state)

    @property
    def regions(self) -> list[RegionContact]:
        """Contacts on the patches, a few hundredths of a second old at most."""
        regions = self._recording.regions
        return regions[self._region_times][1] if regions else []

    def step(self) -> None:
        """Advance by 2 ms.

        Raises
        ------
        LaunchError
            When no data arrive any more.
        """
        if not self._pending and not self._hand.until(self._fetch, _SILENCE_S):
            raise LaunchError(f"no data from the simulated hand for {_SILENCE_S:.0f} s")
        self._time_s, self._row = self._pending.popleft()
        statuses, regions = self._recording.statuses, self._recording.regions
        while self._statuses + 1 < len(statuses) and statuses[self._statuses + 1].time_s <= self._time_s:
            self._statuses += 1
        while self._region_times + 1 < len(regions) and regions[self._region_times + 1][0] <= self._time_s:
            self._region_times += 1

    def run(self, duration_s: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Run for a time [s], or until a condition is true; return whether it was."""
        end_s = self._time_s + duration_s
        while self._time_s < end_s:
            self.step()
            if until():
                return True
        return False

    def begin_grasp(self) -> None:
        """Begin to close the hand, as soon as it feels touch; see `HandRig`."""
        self.supervisor.grasp()

    def grasp(self) -> bool:
        """Close the hand; return whether it then holds something."""
        end_s = self._time_s + _GRASP_S
        self._begin_grasp()
        while self.run(end_s - self._time_s, self._has_closed) and self.state is HandState.STOPPED:
            # A delay of the machine of a tenth of a second stops the grasp; try again, as a person would.
            self.run(_PAUSE_S)
            self._begin_grasp()
        return self.state is HandState.HOLDING

    def object_m(self) -> NDArray[np.float64]:
        """Position of the object in the palm's frame [m]."""
        return np.array(self.world.truth.object_position_m)

    def ask(self, name: str) -> None:
        """Call a service of the hand, and advance to that time."""
        self._catch_up(self._hand.ask(name, name))

    def do(self, line: str, mark: str) -> None:
        """Send a command to the world, and advance to that time."""
        self._catch_up(self._hand.do(line, mark))

    def events(self, reflex: str) -> int:
        """Number of times that a reflex was triggered."""
        return self._recording.statuses[self._statuses].events.get(reflex, 0)

    def truth(self) -> HandTruth:
        """What is true at the moment that is told."""
        assert self._row is not None
        return HandTruth.from_row(self._row, self._recording.patches)

    def _open(self) -> None:
        for _ in range(_OPENINGS):
            self.supervisor.release()
            if self.run(_OPENING_S, lambda: bool(np.abs(self.truth().q_rad - _OPEN_RAD).max() < _NEARLY_OPEN_RAD)):
                return
            # A delay of the machine of some tenths of a second loses the motors, and stops the hand; try again, too.
        raise LaunchError(f"the simulated hand did not open within {_OPENING_S:g} s, asked {_OPENINGS} times")

    def _begin_grasp(self) -> None:
        self.supervisor.grasp()
        # Until the status says so, it has the state from before, which may be that of a hand that gripped nothing.
        self.run(_REFUSED_S, lambda: self.state is HandState.CLOSING)

    def _has_closed(self) -> bool:
        status = self._recording.statuses[self._statuses]
        was_interrupted = status.state == HandState.STOPPED and status.reason.startswith("touch is stale")
        return was_interrupted or status.state in (HandState.HOLDING, HandState.OPEN)

    def _catch_up(self, time_s: float) -> None:
        while self._time_s < time_s:
            self.step()

    def _fetch(self) -> bool:
        """Read the pieces of truth that are old enough; return whether there are data."""
        recording, known_s = self._recording, time.monotonic() - self.behind_s
        while self._pieces < len(recording.truth_times) and recording.truth_times[self._pieces][-1] < known_s:
            times_s, rows = recording.truth_times[self._pieces], recording.truth_rows[self._pieces]
            self._pending.extend(zip(times_s.tolist(), rows, strict=True))
            self._pieces += 1
        return bool(self._pending)


@dataclass(frozen=True)
class LiveSupervisor:
    """Commands to the running hand."""

    rig: LiveRig

    def grasp(self) -> str:
        """Start a grasp. Returns an empty reason, because a refusal that lasts raises an error.

        Raises
        ------
        HandRefusalError
            When the hand has refused for some seconds: touch may be late at one moment.
        """
        return self._ask("grasp")

    def release(self) -> str:
        """Start to open the hand; see `grasp`."""
        return self._ask("release")

    def _ask(self, name: str) -> str:
        end_s = time.monotonic() + _REFUSED_S
        while True:
            try:
                self.rig.ask(name)
            except HandRefusalError:
                if time.monotonic() > end_s:
                    raise
            else:
                return ""
            self.rig.run(_PAUSE_S)


@dataclass(frozen=True)
class LiveReflex:
    """State of a reflex of the running hand."""

    rig: LiveRig
    name: str

    @property
    def events(self) -> int:
        """Number of times that it was triggered."""
        return self.rig.events(self.name)


class LiveWorld:
    """The part of `HandWorld` that scenarios use."""

    def __init__(self, rig: LiveRig, config: HandWorldConfig) -> None:
        thing = None
        if config.object != "none":
            thing = held_object(config.object, config.object_size_m, config.object_mass_kg)
        self.weight_n = _GRAVITY_M_S2 * thing.mass_kg if thing else 0.0
        self.holder = LiveHolder(rig)
        self.disturbances = LiveDisturbances(rig)
        self.tip = LiveTip(rig)
        self._rig = rig

    def put(self, x_m: float, y_m: float, height_m: float = 0.0) -> None:
        """See `acts_sim.hand.world.HandWorld.put`."""
        self._rig.do(f"put {1e3 * x_m:.4f} {1e3 * y_m:.4f} {1e3 * height_m:.4f}", "put")

    @property
    def truth(self) -> HandTruth:
        """What is true at the moment that is told."""
        return self._rig.truth()

    @property
    def down(self) -> Array:
        """Direction of gravity in the palm's frame; np.ndarray [shape=(3,)], a unit vector."""
        gravity = np.array(self.truth.gravity_m_s2)
        return np.asarray(gravity / np.linalg.norm(gravity))


@dataclass(frozen=True)
class LiveHolder:
    """The springs that hold the object besides the hand."""

    rig: LiveRig

    def let_go(self) -> None:
        """Release the object."""
        self.rig.do("let_go", "let go")

    def move(self, by_m: Array, turn_rad: Array, duration_s: float) -> None:
        """See `acts_sim.hand.holder.Holder.move`."""
        numbers = (*(1e3 * by_m), *np.degrees(turn_rad), duration_s)
        self.rig.do("move " + " ".join(f"{number:.4f}" for number in numbers), "move")


@dataclass(frozen=True)
class LiveDisturbances:
    """Forces on the object."""

    rig: LiveRig

    def pull_down(self, times_weight: float, ramp_s: float) -> None:
        """See `acts_sim.hand.disturbances.Disturbances.pull_down`."""
        self.rig.do(f"load {times_weight:g} {1e3 * ramp_s:g}", f"load {times_weight:g} x weight")

    def pull(self, force_n: Array, ramp_s: float) -> None:
        """See `acts_sim.hand.disturbances.Disturbances.pull`."""
        numbers = " ".join(f"{number:.4f}" for number in force_n)
        self.rig.do(f"pull {numbers} {1e3 * ramp_s:g}", f"pull {np.linalg.norm(force_n):.2g} N")


@dataclass(frozen=True)
class LiveTip:
    """The tip that pokes the skin."""

    rig: LiveRig

    def poke(
        self,
        patch: str,
        radius_m: float,
        speed_m_s: float,
        travel_m: float,
        start_m: float,
        row: float,
        col: float,
    ) -> None:
        """See `acts_sim.hand.tip.Tip.poke`."""
        numbers = f"{1e3 * radius_m:g} {1e3 * speed_m_s:g} {1e3 * travel_m:g} {row:.3f} {col:.3f} {1e3 * start_m:g}"
        self.rig.do(f"poke {patch} {numbers}", f"poke {patch}")
