# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Runs the hand's world in real time, a little ahead of the clock, and writes counts and truth to rings."""

from __future__ import annotations

import time
from dataclasses import dataclass

from acts_sim.hand import STEP_S, HandWorld
from acts_sim.shared import TimedRingWriter

STEP_NS = round(STEP_S * 1e9)

LONGEST_BEHIND_NS = 100_000_000
"""A world that is further behind the clock than this skips the missed time, in which everything stands still [ns]."""

_LATE_NS = 1_000_000


@dataclass(frozen=True)
class HandWorldStatistics:
    """Counters of a loop since its start.

    Attributes
    ----------
    steps, late, skipped : int
        Steps of the world, 2 ms each; steps that began more than 1 ms late; skipped steps.
    work_s : float
        Time spent in steps [s].
    """

    steps: int = 0
    late: int = 0
    skipped: int = 0
    work_s: float = 0.0


class HandWorldLoop:
    """Steps a world at each call, every 2 ms, and writes each step with its time.

    Parameters
    ----------
    world : HandWorld
    field : TimedRingWriter
        Ring for the counts, which the board reads.
    truth : TimedRingWriter
        Ring for the rows of truth, see `acts_sim.hand.truth`.
    lead_ns : int
        How far the world is ahead of the clock [ns].

    Attributes
    ----------
    statistics : HandWorldStatistics
        Replaced by a new object after each step.
    """

    def __init__(self, world: HandWorld, field: TimedRingWriter, truth: TimedRingWriter, lead_ns: int) -> None:
        self.statistics = HandWorldStatistics()
        self._world = world
        self._field = field
        self._truth = truth
        self._lead_ns = lead_ns
        self._world_ns = 0

    def step(self, _dt_s: float) -> None:
        """Execute the step of the world that is due now."""
        start_ns = time.monotonic_ns()
        before = self.statistics
        behind_ns = start_ns + self._lead_ns - (self._world_ns + STEP_NS)
        skipped = 0
        if behind_ns > LONGEST_BEHIND_NS:
            skipped = 0 if before.steps == 0 else behind_ns // STEP_NS
            self._world_ns += behind_ns
        self._world_ns += STEP_NS
        self._world.step()
        self._field.write(self._world_ns, self._world.counts)
        self._truth.write(self._world_ns, self._world.truth_row())
        self.statistics = HandWorldStatistics(
            before.steps + 1,
            before.late + (_LATE_NS < behind_ns <= LONGEST_BEHIND_NS),
            before.skipped + skipped,
            before.work_s + (time.monotonic_ns() - start_ns) / 1e9,
        )
