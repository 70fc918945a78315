# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Accuracy of the paper's SRC and of ours on the same presses of simulated objects, over M and over time.

The paper's method: adaptive sampling, each frame alone (the node's classifier ``src``). Ours: tracking sampling, and
the fused image of several frames (``fused_image``). Both sample the same recordings by the firmware's sampler with
frames that begin at the same times, and have libraries from the same presses.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.array import TOUCH_COUNTS
from acts_core.sampling import MEASUREMENT_US
from acts_recon.fusion import known_noise
from acts_recon.objects import ImageClassifierConfig, ObjectLibrary, build_object_library
from acts_sim.pressing import RATE_HZ as RECORDED_HZ
from acts_sim.pressing import ContactObject, FoamConfig, PressingArm, PressingConfig
from acts_tools.evaluate.classification.contenders import Contender, contenders
from acts_tools.evaluate.statistics import wilson
from acts_tools.firmware.board_sampler import BoardSampler
from acts_tools.percentiles import percentiles

TIMES_MS = (2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 25, 30, 40, 50, 60, 80)
MIDDLE_MS = 60.0
"""Time after contact at which a press is held, for the accuracy over M [ms]."""

M_OVER_TIME = 64
MS = (42, 48, 56, 64, 88, 128, 256, 512)
_BEFORE_S = 0.100
"""Time without touch before a press, in which tracking scans the skin [s]."""

_LISTEN_S = 0.025
"""Time for which our method classifies before the first scored answer [s]; its memory is shorter."""


def _frame_period_s(m: int) -> float:
    """Time between frames [s]: a millisecond, or that of `m` measurements if it is longer."""
    return max(1e-3, m * MEASUREMENT_US * 1e-6)


def answers(
    contender: Contender,
    frames: NDArray[np.uint16],
    recorded_hz: float,
    contact_s: float,
    times_s: Sequence[float],
    *,
    run_up_s: float | None = None,
) -> list[int | None]:
    """Play a recording; return the last answer that is available at each of some times since contact.

    Parameters
    ----------
    contender : Contender
    frames : np.ndarray [shape=(n, rows, cols), dtype=uint16]
    recorded_hz : float
        Frames of the recording per second.
    contact_s : float
        Time at which contact begins [s]; a frame of samples begins at the same time.
    times_s : sequence of float
        Increasing times since contact [s].
    run_up_s : float, optional
        Time that is played before contact [s]; by default all of it.

    Returns
    -------
    list of int or None [len(times_s)]
        Classes; None where no contact was detected.
    """
    m = contender.sampling.m
    period_s, step_s = _frame_period_s(m), MEASUREMENT_US * 1e-6
    run_up_s = contact_s if run_up_s is None else run_up_s
    contender.reset()
    sampler = BoardSampler(contender.sampling)
    # Number of the last frame whose answer is available at each time; frame 0 begins with the contact.
    wanted = [int(np.floor((time_s - m * step_s) / period_s + 1e-6)) for time_s in times_s]
    listen = wanted[0] - int(_LISTEN_S / period_s)
    found: dict[int, int | None] = {}
    for number in range(min(-int(run_up_s / period_s), wanted[0]), wanted[-1] + 1):
        begin_s = contact_s + number * period_s
        indices, counts = sampler.frame(frames, begin_s * recorded_hz, step_s * recorded_hz)
        end_s = begin_s + m * step_s
        if number < listen:
            contender.update(indices, counts, end_s, m * step_s)
        else:
            found[number] = contender.answer(indices, counts, end_s, m * step_s)
    return [found[number] for number in wanted]


@dataclass(frozen=True)
class Trials:
    """Numbers of arms and presses.

    Attributes
    ----------
    arms : int
        Number of arms, each with its own skin, spots and library.
    presses : int
        Presses of every object on every arm.
    columns : int
        Library presses of every object on every arm, none of them among `presses`.
    seed : int
    """

    arms: int = 4
    presses: int = 3
    columns: int = 5
    seed: int = 1
    pressing: PressingConfig = field(default_factory=PressingConfig)
    foam: FoamConfig = field(default_factory=FoamConfig)
    objects: tuple[ContactObject, ...] | None = None


@dataclass
class Score:
    """Correct answers of a method: one row per press, one column per question."""

    rows: list[list[bool]] = field(default_factory=list)

    def summary(self, questions: Sequence[float], name: str) -> list[dict[str, Any]]:
        """Accuracy with its 95 % interval (Wilson) for every question."""
        right = np.array(self.rows, dtype=bool)
        return [
            {name: question, **accuracy(int(right[:, column].sum()), len(right))}
            for column, question in enumerate(questions)
        ]


def accuracy(right: int, n: int) -> dict[str, Any]:
    """Accuracy of `right` answers of `n`, with its 95 % interval by Wilson's method."""
    low, high = wilson(right, n)
    return {"accuracy": right / n, "low": low, "high": high, "presses": n}


def arm_of(trials: Trials, number: int) -> tuple[PressingArm, ObjectLibrary, ObjectLibrary]:
    """An arm by its number, and libraries of its presses: without counts below the paper's threshold, and with them."""
    arm = PressingArm(trials.objects, trials.pressing, trials.foam, seed=trials.seed * 1000 + number)
    known, labels = arm.held_frames(trials.columns)
    coarse = build_object_library(known, labels, touch_counts=TOUCH_COUNTS)
    fine = build_object_library(known, labels, touch_counts=ImageClassifierConfig().touch_counts)
    return arm, coarse, fine


def press_of(arm: PressingArm, item: int, after_s: float) -> tuple[NDArray[np.uint16], float]:
    """A new press of an object, recorded until `after_s` after the foam is touched, and the time of contact [s]."""
    frames = arm.recording(item, _BEFORE_S, after_s)
    return frames, float(np.argmax(frames.max(axis=(1, 2)) > TOUCH_COUNTS)) / RECORDED_HZ


def run_trials(
    trials: Trials,
    ms: Sequence[int] = MS,
    times_ms: Sequence[float] = TIMES_MS,
    show: Callable[[float], None] = lambda _: None,
    write: Callable[[dict[str, Any]], None] = lambda _: None,
) -> dict[str, Any]:
    """Press, sample and classify.

    `show` is called with the share of the presses that is done, `write` after each arm with the results so far: all M
    are judged on the same presses.

    Returns
    -------
    dict
        `over_m` and `over_time`: a list of accuracies by method ("paper", "acts", further ones of the node).
        `frame_us`: `median` and `p99` of the processor time to classify a frame by method, at `M_OVER_TIME`.
    """
    spent_us: dict[str, list[float]] = defaultdict(list)
    over_m: dict[str, dict[int, Score]] = defaultdict(lambda: {m: Score() for m in ms})
    over_time: dict[str, Score] = defaultdict(Score)
    times_s = [1e-3 * time_ms for time_ms in times_ms]
    after_s = 1e-3 * max(MIDDLE_MS, *times_ms) + 0.015
    results: dict[str, Any] = {}
    for number in range(trials.arms):
        arm, coarse, fine = arm_of(trials, number)
        noise_counts = known_noise(trials.foam.noise_counts)
        judged = {m: contenders(coarse, fine, m, noise_counts=noise_counts) for m in ms}
        timed = contenders(coarse, fine, M_OVER_TIME, noise_counts=noise_counts)
        for item in range(len(arm.objects)):
            show((number + item / len(arm.objects)) / trials.arms)
            wanted = coarse.names.index(arm.objects[item].name)
            for _ in range(trials.presses):
                frames, contact_s = press_of(arm, item, after_s)
                for method, contender in timed.items():
                    found = answers(contender, frames, RECORDED_HZ, contact_s, times_s)
                    over_time[method].rows.append([answer == wanted for answer in found])
                for m in ms:
                    for method, contender in judged[m].items():
                        found = answers(contender, frames, RECORDED_HZ, contact_s, [1e-3 * MIDDLE_MS])
                        over_m[method][m].rows.append([found[0] == wanted])
        for method, contender in timed.items():
            spent_us[method] += contender.spent_us
        results = {
            "over_m": {
                method: [score.summary([m], "m")[0] for m, score in scores.items()] for method, scores in over_m.items()
            },
            "over_time": {method: score.summary(times_ms, "time_ms") for method, score in over_time.items()},
            "frame_us": {
                method: percentiles(spent, ("median", "p99"), decimals=None) if spent else None
                for method, spent in spent_us.items()
            },
        }
        write(results)
    return results
