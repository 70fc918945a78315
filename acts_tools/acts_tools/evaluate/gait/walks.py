# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Random walks on simulated insoles, and how well their steps are found."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from acts_recon.gait import GaitConfig, Step
from acts_sim.walking import Footfall, Walk, Walking, walk
from acts_tools.evaluate.gait.insoles import FoundSteps, InsoleRecording, find_steps
from acts_tools.evaluate.statistics import mean

_DURATION_S = 20.0
_NEAR_S = 0.15


def random_walk(rng: np.random.Generator) -> Walk:
    """Any cadence from a stroll to a hurry, any weight, insole, noise; an object in one shoe of four pairs."""
    weight_n = rng.uniform(300.0, 1200.0)
    return Walk(
        cadence_per_min=rng.uniform(40.0, 150.0),
        stance_share=rng.uniform(0.55, 0.70),
        limp=rng.uniform(-0.08, 0.08),
        weight_n=weight_n,
        counts_per_n=float(np.exp(rng.uniform(np.log(3.0), np.log(30.0)))),
        noise_counts=rng.uniform(0.0, 3.0),
        object_n=0.2 * weight_n * float(rng.uniform() < 0.25),
    )


class WalkScores:
    """Compares the steps that are found with the true ones.

    Parameters
    ----------
    rate_hz : float
        Frames per second of the insoles.
    """

    def __init__(self, rate_hz: float) -> None:
        self._rate_hz = rate_hz
        self._walks = self._steps = self._found = self._wrong = self._of_standing = 0
        self._strike_ms: list[float] = []
        self._toe_off_ms: list[float] = []
        self._sigmas: list[float] = []
        self._centre_mm: list[float] = []
        self._cadence: list[float] = []
        self._double: list[float] = []

    def add(self, seed: Sequence[int]) -> None:
        """Let somebody walk, and somebody stand."""
        rng = np.random.default_rng(seed)
        config = random_walk(rng)
        walking = walk(config, _DURATION_S, rng)
        found = self._find(walking, rng)
        self._walks += 1
        for foot in range(2):
            self._compare(walking, foot, found.steps[foot])
        if found.gait.cadence_per_min is not None:
            self._cadence.append(abs(found.gait.cadence_per_min - _cadence_per_min(walking)))
        if found.gait.double_support is not None:
            self._double.append(abs(found.gait.double_support - _double_support(walking)))
        standing = walk(Walk(cadence_per_min=0.0, noise_counts=config.noise_counts), _DURATION_S, rng)
        self._of_standing += sum(map(len, self._find(standing, rng).steps))

    def _find(self, walking: Walking, rng: np.random.Generator) -> FoundSteps:
        time_s = np.arange(rng.uniform(0.0, 1.0 / self._rate_hz), walking.duration_s, 1.0 / self._rate_hz)
        recording = InsoleRecording("walk", time_s, walking.frames(time_s, rng))
        return find_steps(recording, walking.walk.length_m, walking.walk.width_m)

    def _compare(self, walking: Walking, foot: int, found: Sequence[Step]) -> None:
        true = _whole(walking, foot)
        share = GaitConfig().lifted_share
        self._steps += len(true)
        left = list(found)
        for footfall in true:
            rise_s, fall_s = footfall.above_s(share)
            near = [step for step in left if abs(step.strike_s - rise_s) < _NEAR_S]
            if not near:
                continue
            step = near[0]
            left.remove(step)
            self._found += 1
            strike_s, toe_off_s = step.strike_s - rise_s, step.toe_off_s - fall_s
            self._strike_ms.append(1e3 * strike_s)
            self._toe_off_ms.append(1e3 * toe_off_s)
            self._sigmas += [abs(strike_s) / step.strike_sd_s, abs(toe_off_s) / step.toe_off_sd_s]
            self._centre_mm += (1e3 * np.abs(step.y_m - walking.y_m(foot, step.time_s))).tolist()
        self._wrong += len(left)

    def result(self) -> dict[str, Any]:
        """An entry of the report."""
        return {
            "rate_hz": self._rate_hz,
            "walks": self._walks,
            "steps": self._steps,
            "found": self._found,
            "wrong": self._wrong,
            "cadence_error_per_min": mean(self._cadence),
            "strike_error_ms": {"mean": mean(self._strike_ms), "sd": _sd(self._strike_ms)},
            "toe_off_error_ms": {"mean": mean(self._toe_off_ms), "sd": _sd(self._toe_off_ms)},
            "within_1_sigma": mean([value <= 1.0 for value in self._sigmas]),
            "centre_error_mm": mean(self._centre_mm),
            "double_support_error": mean(self._double),
            "steps_of_standing": self._of_standing,
        }


def _whole(walking: Walking, foot: int) -> list[Footfall]:
    return [footfall for footfall in walking.footfalls[foot] if footfall.is_whole]


def _cadence_per_min(walking: Walking) -> float:
    strides = [np.diff([footfall.strike_s for footfall in _whole(walking, foot)]) for foot in range(2)]
    return 120.0 / float(np.median(np.concatenate(strides)))


def _double_support(walking: Walking) -> float:
    """Of the time of the whole strides, both feet above the share that counts as lifted."""
    times_s = np.arange(0.0, walking.duration_s, 1e-3)
    share = GaitConfig().lifted_share
    carries = [np.zeros(times_s.size, dtype=bool) for _ in range(2)]
    for foot in range(2):
        for footfall in _whole(walking, foot):
            rise_s, fall_s = footfall.above_s(share)
            carries[foot] |= (times_s >= rise_s) & (times_s < fall_s)
    first = max(_whole(walking, foot)[0].strike_s for foot in range(2))
    last = min(_whole(walking, foot)[-1].strike_s for foot in range(2))
    inside = (times_s >= first) & (times_s < last)
    return float((carries[0] & carries[1])[inside].mean())


def _sd(values: list[float]) -> float | None:
    return float(np.std(values)) if values else None
