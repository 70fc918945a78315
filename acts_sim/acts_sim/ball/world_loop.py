# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Runs a world in real time, a little ahead of the host's clock, and writes the field of counts to a ring."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

from acts_sim.ball.joint_follower import JointFollower
from acts_sim.ball.world import World, WorldState
from acts_sim.shared import TimedRingWriter

STEP_NS = 2_000_000
"""Length of a step [ns], as the simulated robot's cycle; between two steps the board interpolates the field."""

WAKE_NS = 2 * STEP_NS
"""Time between wake-ups of the process [ns]: a wake-up costs several times as much as a step."""

LEAD_NS = WAKE_NS + STEP_NS
"""How far the world is ahead of the clock after a wake-up [ns]: until the next wake-up and two milliseconds more, so
that the board finds a field for its own time even if that wake-up is late."""

LONGEST_CATCH_UP_STEPS = 25
"""A world that is more steps behind the clock than this skips the missed time, in which the ball stands still."""

_LATE_NS = 1_000_000


@dataclass(frozen=True)
class LoopStatistics:
    """Counters of a loop since its start.

    Attributes
    ----------
    steps : int
        Steps of the world, 2 ms each.
    late : int
        Wake-ups that were more than 1 ms late.
    latest_s : float
        Largest lateness of a wake-up [s].
    skipped : int
        Steps skipped because the process did not run for too long.
    """

    steps: int = 0
    late: int = 0
    latest_s: float = 0.0
    skipped: int = 0


class WorldLoop:
    """Steps a world at 500 Hz and writes each field with its time, which is in the near future.

    Parameters
    ----------
    world : World
    joints : JointFollower
    ring : TimedRingWriter
        Ring for the field, with one value per taxel.
    on_step : callable
        Called after every step, in the loop's thread, with the step's CLOCK_MONOTONIC time [ns] and the state.
    start_ns : int or None
        CLOCK_MONOTONIC time of the world's start [ns]; None for now.
    on_running : callable
        Called once in the loop's thread, after the first steps.
    """

    def __init__(
        self,
        world: World,
        joints: JointFollower,
        ring: TimedRingWriter,
        on_step: Callable[[int, WorldState], None],
        start_ns: int | None = None,
        on_running: Callable[[], None] = lambda: None,
    ) -> None:
        self._world = world
        self._joints = joints
        self._ring = ring
        self._on_step = on_step
        self._on_running = on_running
        self._world_ns = time.monotonic_ns() if start_ns is None else start_ns
        self._statistics = LoopStatistics()
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name="world", daemon=True)
        self._failure: BaseException | None = None

    @property
    def statistics(self) -> LoopStatistics:
        """Counters since the start."""
        return self._statistics

    @property
    def failure(self) -> BaseException | None:
        """Error that ended the thread; None while it runs."""
        return self._failure

    def advance(self, now_ns: int) -> int:
        """Step the world until it is `LEAD_NS` ahead.

        Parameters
        ----------
        now_ns : int
            CLOCK_MONOTONIC [ns].

        Returns
        -------
        int
            When to call again, CLOCK_MONOTONIC [ns].
        """
        before = self._statistics
        late_ns = now_ns - self._due_ns()
        behind = max((now_ns + LEAD_NS - self._world_ns) // STEP_NS, 0)
        skipped = max(behind - LONGEST_CATCH_UP_STEPS, 0)
        self._world_ns += skipped * STEP_NS
        for _ in range(behind - skipped):
            self._world_ns += STEP_NS
            state = self._world.step(self._joints.at(self._world_ns), STEP_NS / 1e9)
            self._ring.write(self._world_ns, self._world.counts)
            self._on_step(self._world_ns, state)
        first = before.steps == 0
        self._statistics = LoopStatistics(
            steps=before.steps + behind - skipped,
            late=before.late + (late_ns > _LATE_NS and not first),
            latest_s=max(before.latest_s, 0.0 if first else late_ns / 1e9),
            skipped=before.skipped + (0 if first else skipped),
        )
        return self._due_ns()

    def _due_ns(self) -> int:
        return self._world_ns + WAKE_NS - LEAD_NS

    def start(self) -> None:
        """Start a thread that steps the world."""
        self._thread.start()

    def stop(self) -> None:
        """Stop the thread and wait for its end."""
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join()

    def _run(self) -> None:
        try:
            self.advance(time.monotonic_ns())
            self._on_running()
            while not self._stop.is_set():
                next_ns = self.advance(time.monotonic_ns())
                time.sleep(max(next_ns - time.monotonic_ns(), 0) / 1e9)
        except BaseException as error:
            # The owner of the loop reports `failure`; the traceback goes to standard error.
            self._failure = error
            raise
