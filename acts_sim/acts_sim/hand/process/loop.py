"""Lets the hand's world keep up with the clock, a little ahead of it, and shares what skin and truth are."""

from __future__ import annotations

import time
from dataclasses import dataclass

from acts_sim.hand import STEP_S, HandWorld
from acts_sim.shared import TimedRingWriter

STEP_NS = round(STEP_S * 1e9)

LONGEST_BEHIND_NS = 100_000_000
"""A world that is further behind than this leaves out the rest: everything stood still meanwhile."""

_LATE_NS = 1_000_000


@dataclass(frozen=True)
class LoopStatistics:
    """What a loop has done since its start.

    Attributes
    ----------
    steps, late, skipped : int
        Steps of the world, 2 ms each; those that began more than 1 ms late; those left out.
    work_s : float
        Time spent in steps [s].
    """

    steps: int = 0
    late: int = 0
    skipped: int = 0
    work_s: float = 0.0


class HandLoop:
    """Steps a world as it is called, every 2 ms, and writes each step with the time it is for.

    Parameters
    ----------
    world : HandWorld
    field : TimedRingWriter
        Of the counts, for the board.
    truth : TimedRingWriter
        Of the rows of truth, see `acts_sim.hand.truth`.
    lead_ns : int
        How far the world is ahead of the clock [ns].

    Attributes
    ----------
    statistics : LoopStatistics
        Replaced as a whole.
    """

    def __init__(self, world: HandWorld, field: TimedRingWriter, truth: TimedRingWriter, lead_ns: int) -> None:
        self.statistics = LoopStatistics()
        self._world = world
        self._field = field
        self._truth = truth
        self._lead_ns = lead_ns
        self._world_ns = 0

    def step(self, _dt_s: float) -> None:
        """Let a step of the world happen: the one that is due now."""
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
        self.statistics = LoopStatistics(
            before.steps + 1,
            before.late + (_LATE_NS < behind_ns <= LONGEST_BEHIND_NS),
            before.skipped + skipped,
            before.work_s + (time.monotonic_ns() - start_ns) / 1e9,
        )
