# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The steps of one foot, sample by sample."""

from __future__ import annotations

import math
from collections import deque
from enum import Enum
from typing import NamedTuple

import numpy as np

from acts_recon.gait.config import GaitConfig
from acts_recon.gait.loads import LoadLearner, Loads
from acts_recon.gait.step import Step

# Faster samples are averaged over this time: a foot does nothing quicker that matters here, but noise does.
_BIN_S = 0.01
# Of the time between two samples: how far the force of a foot crosses a level from the straight line between them.
_BETWEEN = 0.15
_LONGEST_PATH = 6000
_CLOCK_BACK_S = 1.0


class _Bin(NamedTuple):
    """Means of the samples of a hundredth of a second, or one sample."""

    time_s: float
    force: float
    moment_x: float
    moment_y: float


class _Crossing(NamedTuple):
    time_s: float
    sd_s: float


class _Stance(NamedTuple):
    """A foot that carries.

    `lifted` is what pressed the foot before, while it was lifted; `bins` those of the stance, the last `_LONGEST_PATH`,
    and `peak` the largest force of all, once it is over.
    """

    strike: _Crossing
    swing_s: float | None
    lifted: _Bin
    bins: tuple[_Bin, ...] = ()
    peak: float = -math.inf


class _Phase(Enum):
    UNKNOWN = 0
    LIFTED = 1
    LOADED = 2


class FootTracker:
    """Finds the steps of one foot.

    Parameters
    ----------
    config : GaitConfig, optional

    Attributes
    ----------
    least_span : float
        What a load must at least be to be one, in the unit of the forces: the other foot knows.
    """

    def __init__(self, config: GaitConfig | None = None) -> None:
        self.config = config or GaitConfig()
        self.least_span = 0.0
        self._newest_s = -math.inf
        self._forget()
        self._begin_anew()

    @property
    def loads(self) -> Loads | None:
        """What has been learnt of this foot; None before it has lifted and carried."""
        loads = self._learner.loads
        return loads if loads is not None and loads.span >= self.least_span else None

    @property
    def carries_since_s(self) -> float | None:
        """When the foot was set down, while it carries; None while it does not, or where that is not known [s]."""
        return self._stance.strike.time_s if self._stance is not None else None

    def step(self, time_s: float, force: float, x_m: float = 0.0, y_m: float = 0.0) -> tuple[Step, ...]:
        """Take a sample.

        Parameters
        ----------
        time_s : float
            Later than that of the sample before; others are left out. Where the clock is set back by more than a
            second all begins anew.
        force : float
            In any unit, with any offset; a sample that is not a number is left out.
        x_m, y_m : float
            Centre of pressure across and along the foot [m].

        Returns
        -------
        tuple of Step
            Those that are over with this sample: mostly none, several where the loads have just been learnt.
        """
        if not all(map(math.isfinite, (time_s, force, x_m, y_m))):
            return ()
        sample = _Bin(time_s, force, force * x_m, force * y_m)
        if time_s < self._newest_s - _CLOCK_BACK_S:
            self._newest_s = -math.inf
            self._forget()
            self._begin_anew()
        elif time_s <= self._newest_s:
            return ()
        elif time_s > self._newest_s + self.config.longest_gap_s:
            told = self._close()
            if self.loads is None:
                # What came before belongs to a start that was broken off.
                self._forget()
            return told + self._add(sample)
        return self._add(sample)

    def finish(self) -> tuple[Step, ...]:
        """Tell the last step, where the recording ends right after it."""
        return self._close() + self._confirmed(math.inf)

    def _forget(self) -> None:
        self._learner = LoadLearner(self.config)
        self._backlog: deque[_Bin] = deque()
        self._samples: list[_Bin] = []

    def _begin_anew(self) -> None:
        self._phase = _Phase.UNKNOWN
        self._begun_s = math.inf
        self._last: _Bin | None = None
        self._rise: _Crossing | None = None
        self._lifted_at: _Crossing | None = None
        self._lightest: _Bin | None = None
        self._drop_path()
        self._stance: _Stance | None = None
        self._over: tuple[_Stance, _Crossing] | None = None

    def _drop_path(self) -> None:
        self._bins: deque[_Bin] = deque(maxlen=_LONGEST_PATH)
        self._peak = -math.inf

    def _keep(self, now: _Bin) -> None:
        self._bins.append(now)
        self._peak = max(self._peak, now.force)

    def _add(self, sample: _Bin) -> tuple[Step, ...]:
        pause_s = sample.time_s - self._newest_s
        self._newest_s = sample.time_s
        self._samples.append(sample)
        return self._close() if sample.time_s + pause_s - self._samples[0].time_s >= _BIN_S else ()

    def _close(self) -> tuple[Step, ...]:
        """Average the samples that wait, and look at them."""
        if not self._samples:
            return ()
        mean = _Bin(*(sum(column) / len(self._samples) for column in zip(*self._samples, strict=True)))
        self._samples.clear()
        self._learner.add(mean.time_s, mean.force)
        self._backlog.append(mean)
        loads = self.loads
        if loads is None:
            while self._backlog[0].time_s < mean.time_s - self.config.learning_s:
                self._backlog.popleft()
            return ()
        told: list[Step] = []
        while self._backlog:
            told += self._look(self._backlog.popleft(), loads)
        return tuple(told)

    def _look(self, now: _Bin, loads: Loads) -> tuple[Step, ...]:
        told: tuple[Step, ...] = ()
        last, share = self._last, loads.share(now.force)
        if last is None or now.time_s - last.time_s > self.config.longest_gap_s:
            told = self._confirmed(math.inf)
            self._begin_anew()
            self._begun_s = now.time_s
            last = now
        self._last = now
        if self._phase is not _Phase.LOADED:
            return told + self._look_lifted(last, now, share, loads)
        if share < self.config.lifted_share:
            self._lift(_crossing(last, now, self.config.lifted_share, loads), now)
        else:
            self._keep(now)
        return told

    def _look_lifted(self, last: _Bin, now: _Bin, share: float, loads: Loads) -> tuple[Step, ...]:
        if share < self.config.lifted_share:
            self._phase, self._rise = _Phase.LIFTED, None
            self._drop_path()
            if self._lightest is None or now.force < self._lightest.force:
                self._lightest = now
            return self._confirmed(now.time_s)
        if self._phase is _Phase.LIFTED and self._rise is None:
            if self._lifted_at is None and now.time_s - self._begun_s < self.config.shortest_s:
                # A foot that stands seems lifted until its skin was measured everywhere, right after the start.
                self._phase = _Phase.UNKNOWN
            else:
                self._rise = _crossing(last, now, self.config.lifted_share, loads)
        # A swing ends where the force begins to rise, however slowly it does.
        told = self._confirmed(now.time_s if self._rise is None else self._rise.time_s)
        self._keep(now)
        return told + self._load() if share > self.config.loaded_share else told

    def _load(self) -> tuple[Step, ...]:
        """The foot carries. Where it was not lifted for long enough, what was over goes on, known or not."""
        self._phase, rise = _Phase.LOADED, self._rise
        if rise is None or self._lightest is None:
            return ()
        swing_s = rise.time_s - self._lifted_at.time_s if self._lifted_at is not None else None
        if swing_s is not None and swing_s < self.config.shortest_s:
            if self._over is not None:
                self._stance, self._over = self._over[0], None
                self._bins = deque((*self._stance.bins, *self._bins), maxlen=_LONGEST_PATH)
                self._peak = max(self._peak, self._stance.peak)
            return ()
        told = self._confirmed(math.inf)
        self._stance = _Stance(rise, swing_s, self._lightest)
        return told

    def _lift(self, crossing: _Crossing, now: _Bin) -> None:
        stance = self._stance
        is_step = stance is not None and crossing.time_s - stance.strike.time_s >= self.config.shortest_s
        if stance is not None and is_step:
            self._over = stance._replace(bins=tuple(self._bins), peak=self._peak), crossing
        if stance is None or is_step:
            self._lifted_at = crossing
        self._phase, self._stance, self._rise, self._lightest = _Phase.LIFTED, None, None, now
        self._drop_path()

    def _confirmed(self, now_s: float) -> tuple[Step, ...]:
        """The step that is over, once the foot has been lifted for long enough."""
        if self._over is None or now_s - self._over[1].time_s < self.config.shortest_s:
            return ()
        (stance, toe_off), self._over = self._over, None
        step = _step(stance, toe_off)
        return (step,) if step is not None else ()


def _step(stance: _Stance, toe_off: _Crossing) -> Step | None:
    """None where the foot never pressed more than while it was lifted: then the loads were not those of the foot."""
    bins = np.array(stance.bins)
    bins = bins[bins[:, 1] > stance.lifted.force]
    if not bins.size:
        return None
    force, moment_x, moment_y = (bins[:, 1:] - np.array(stance.lifted)[1:]).T
    return Step(
        *stance.strike,
        *toe_off,
        stance.swing_s,
        stance.peak - stance.lifted.force,
        bins[:, 0],
        force,
        moment_x / force,
        moment_y / force,
    )


def _crossing(before: _Bin, after: _Bin, share: float, loads: Loads) -> _Crossing:
    """When the force crossed a share of the load between two bins."""
    level = loads.lifted + share * loads.span
    rise, pause_s = after.force - before.force, after.time_s - before.time_s
    if not rise or not pause_s:
        return _Crossing(after.time_s, _BETWEEN * pause_s)
    part = min(max((level - before.force) / rise, 0.0), 1.0)
    from_noise_s = min(loads.noise * pause_s / abs(rise), pause_s)
    return _Crossing(before.time_s + part * pause_s, math.hypot(from_noise_s, _BETWEEN * pause_s))
