# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""CPU time of FastOMP for an image, compared with scikit-learn, SPAMS and the limit of the processor.

A frame is 55 samples of 32 x 32 taxels, with 49 overlapping patches of 8 x 8; the dictionary is the shipped one with
1000 atoms. There are two kinds of frames: adaptive samples of single presses, in which only the touched patches need
atoms, and random samples of a skin that is pressed everywhere, in which all patches do.

The time of FastOMP is that of a whole frame, from its samples to the image. The other libraries get prepared problems
(the measured rows of the dictionary, for SPAMS also normalised) and are timed for the pursuit alone: one call per
patch, with as many atoms. All take turns on the same frames, in CPU time of one thread.

The limit is the number of multiply-adds in FastOMP over the rate at which this core does them in registers.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, TOUCH_COUNTS
from acts_core.sampling import Sampler, SamplingConfig, measure_in
from acts_recon.sparse import (
    SPARSITY_RATIO,
    PatchLayout,
    PatchModel,
    fast_omp,
    load_dictionary,
    patch_layout,
    shipped_dictionary_path,
    sparsity,
    workspace,
)
from acts_recon.sparse import fastomp_kernels as kernels
from acts_sim.pressing import OBJECTS
from acts_tools.bench.references.multiply_adds import peak_per_s
from acts_tools.bench.references.peers import SCIKIT_LEARN, SPAMS, missing, peer
from acts_tools.bench.result import Figure, Result
from acts_tools.bench.workbench import Workbench
from acts_tools.training.frames import model_frames

M = 55
FRAMES = 10
CALLS = 50
"""Repetitions of FastOMP in a turn, because it is much faster than the others."""
SAME = 0.01
"""Tolerance of residuals, relative to the samples: rounding causes such differences where two atoms tie."""

_TITLES = {"press": "a press", "skin": "the whole skin"}

Samples = tuple[NDArray[np.uint16], NDArray[np.uint16]]


@dataclass(frozen=True)
class Problem:
    """The sparse coding problem of one patch."""

    A: NDArray[np.float32]
    y: NDArray[np.float32]
    atoms: int


def measure(workbench: Workbench) -> Result:
    """Time both kinds of frames, for half of the time each."""
    layout = patch_layout(32, 32)
    atoms = load_dictionary(shipped_dictionary_path(), patch_size=8).atoms
    peak = peak_per_s()
    figures = [Figure("peak", "multiply-adds of one core, in registers", peak / 1e9, "thousand million/s")]
    problems: list[str] = []
    for kind, frames in (("press", _presses()), ("skin", _pressed_everywhere())):
        workbench.check_stop()
        compared = _compare(kind, frames, layout, atoms, peak, workbench)
        figures += compared.figures
        problems += compared.problems
    return Result(figures, problems)


def multiply_adds(problem: Problem) -> int:
    """Number in FastOMP on one patch: correlations, orthogonalisation, residual, coefficients, and the patch itself.

    Comparisons of correlations, and work that is done once per frame, are not counted.
    """
    (m, n_atoms), s = problem.A.shape, problem.atoms
    correlations = s * m * n_atoms
    orthogonal = s * (s - 1) // 2 * 2 * m
    rest = s * 4 * m + s * (s - 1) // 2
    return correlations + orthogonal + rest + s * 64


def patch_problems(layout: PatchLayout, atoms: NDArray[np.float32], samples: Samples) -> list[Problem]:
    """Problems of the pressed patches of a frame."""
    value = np.zeros(layout.rows * layout.cols, dtype=np.float32)
    measured = np.zeros(value.size, dtype=bool)
    value[samples[0]] = np.where(samples[1] > TOUCH_COUNTS, samples[1], 0)
    measured[samples[0]] = True
    problems = []
    for taxels in layout.taxels:
        rows = np.flatnonzero(measured[taxels])
        y = value[taxels[rows]]
        if y.any():
            problems.append(Problem(np.ascontiguousarray(atoms[rows]), y, sparsity(rows.size)))
    return problems


def _compare(
    kind: str,
    frames: list[Samples],
    layout: PatchLayout,
    atoms: NDArray[np.float32],
    peak: float,
    workbench: Workbench,
) -> Result:
    """Time one kind of frames; `peak` is the largest number of multiply-adds a second."""
    work = [patch_problems(layout, atoms, samples) for samples in frames]
    recover = _recovery(layout, atoms)
    contenders: dict[str, Callable[[], Any]] = {
        "ours": lambda: [recover(samples) for _ in range(CALLS) for samples in frames],
    }
    linear_model, spams = peer(SCIKIT_LEARN, "linear_model"), peer(SPAMS)
    if linear_model is not None:
        contenders["sklearn"] = lambda: [_by_sklearn(linear_model, one) for patches in work for one in patches]
    if spams is not None:
        ready = [_for_spams(one) for patches in work for one in patches]
        contenders["spams"] = lambda: [_by_spams(spams, *one) for one in ready]
    with warnings.catch_warnings():
        # scikit-learn warns of atoms that are equal on the few measured taxels; here it is only timed.
        warnings.simplefilter("ignore")
        problems = _disagreements(work[0], linear_model, spams)
        seconds = _take_turns(contenders, workbench)
    seconds["ours"] /= CALLS
    ours_us = 1e6 * float(np.median(seconds["ours"])) / len(frames)
    limit_us = 1e6 * sum(multiply_adds(one) for patches in work for one in patches) / len(frames) / peak
    n_patches = sum(map(len, work)) / len(frames)
    figures = [
        Figure(f"{kind}.us", f"FastOMP, {_TITLES[kind]}: {n_patches:.0f} of 49 patches pressed", ours_us, "us"),
        Figure(f"{kind}.limit_us", "    the arithmetic limit", limit_us, "us"),
        Figure(f"{kind}.to_limit", "    to the arithmetic limit", ours_us / limit_us, "times", is_ratio=True),
    ]
    for name, library, label in (
        ("sklearn", SCIKIT_LEARN, "scikit-learn, orthogonal_mp"),
        ("spams", SPAMS, "SPAMS, omp"),
    ):
        if name not in seconds:
            figures.append(Figure(f"{kind}.{name}_us", f"    {label}", missing(library)))
            continue
        theirs_us = 1e6 * float(np.median(seconds[name])) / len(frames)
        ratio = float(np.median(seconds[name] / seconds["ours"]))
        figures.append(Figure(f"{kind}.{name}_us", f"    {label}", theirs_us, "us"))
        figures.append(Figure(f"{kind}.{name}_ratio", f"    {label}, to ours", ratio, "times", is_ratio=True))
    return Result(figures, problems)


def _recovery(layout: PatchLayout, atoms: NDArray[np.float32]) -> Callable[[Samples], None]:
    model = PatchModel.of(layout, atoms)
    buffers = workspace(layout)
    image = np.zeros(layout.rows * layout.cols, dtype=np.float32)

    def recover(samples: Samples) -> None:
        kernels.recover_image(model, *samples, TOUCH_COUNTS, COUNT_MAX, SPARSITY_RATIO, True, buffers, image)

    return recover


def _by_sklearn(linear_model: Any, problem: Problem) -> Any:
    return linear_model.orthogonal_mp(problem.A, problem.y, n_nonzero_coefs=problem.atoms)


def _for_spams(problem: Problem) -> tuple[NDArray[np.float32], NDArray[np.float32], int]:
    norms = np.maximum(np.linalg.norm(problem.A, axis=0), np.float32(1e-6))
    return np.asfortranarray(problem.A / norms), np.asfortranarray(problem.y[:, None]), problem.atoms


def _by_spams(spams: Any, A: NDArray[np.float32], y: NDArray[np.float32], atoms: int) -> Any:
    # Without `eps` its stopping residual is undefined, and it often stops before the first atom.
    return spams.omp(y, A, L=atoms, eps=0.0, numThreads=1)


def order_recursive(A: NDArray[np.floating], y: NDArray[np.floating], atoms: int) -> float:
    """Norm of the residual that SPAMS should leave, relative to that of `y`.

    Its `omp` is not OMP, but order recursive matching pursuit. On normalised columns the first atom is the same; each
    further one is the atom that reduces the residual most. The residual is smaller, for more work.
    """
    orthogonal = A.astype(np.float64)
    residual = y.astype(np.float64)
    for _ in range(atoms):
        norms = np.linalg.norm(orthogonal, axis=0)
        gain = np.abs(residual @ orthogonal) / np.where(norms > 1e-3, norms, np.inf)
        best = int(np.argmax(gain))
        if gain[best] == 0:
            break
        direction = orthogonal[:, best] / norms[best]
        residual -= direction * (direction @ residual)
        orthogonal -= np.outer(direction, direction @ orthogonal)
    return float(np.linalg.norm(residual) / np.linalg.norm(y))


def _left(A: NDArray[np.float32], y: NDArray[np.float32], coefficients: NDArray[np.floating]) -> float:
    """Norm of the residual ``y - A x``, relative to that of `y`."""
    return float(np.linalg.norm(y - A @ coefficients) / np.linalg.norm(y))


def _disagreements(work: list[Problem], linear_model: Any, spams: Any) -> list[str]:
    """Check that each timed method solves the problems: its residual must be that of the method it implements."""
    found = []
    for one in work:
        if linear_model is not None:
            chosen, coefficients = fast_omp(one.A, one.y, one.atoms)
            ours = _left(one.A[:, chosen], one.y, coefficients)
            theirs = _left(one.A, one.y, _by_sklearn(linear_model, one))
            if abs(theirs - ours) > SAME:
                found.append(f"scikit-learn leaves {theirs:.3f} of a patch where FastOMP leaves {ours:.3f}")
        if spams is not None:
            A, y, atoms = _for_spams(one)
            theirs = _left(A, y[:, 0], _by_spams(spams, A, y, atoms).toarray()[:, 0])
            expected = order_recursive(A, y[:, 0], atoms)
            if abs(theirs - expected) > SAME:
                found.append(f"SPAMS leaves {theirs:.3f} of a patch where its method leaves {expected:.3f}")
    return found


def _take_turns(contenders: dict[str, Callable[[], Any]], workbench: Workbench) -> dict[str, NDArray[np.float64]]:
    """CPU time of every contender in every turn [s]."""
    for run in contenders.values():
        run()
    seconds: dict[str, list[float]] = {name: [] for name in contenders}
    end_s = time.monotonic() + workbench.seconds / 2
    while time.monotonic() < end_s or len(seconds["ours"]) < 3:
        workbench.check_stop()
        for name, run in contenders.items():
            begin_s = time.thread_time()
            run()
            seconds[name].append(time.thread_time() - begin_s)
    return {name: np.array(times) for name, times in seconds.items()}


def _presses() -> list[Samples]:
    frames = model_frames(list(OBJECTS.values()), 3 * FRAMES, seed=1)[::3]
    sampler = Sampler(SamplingConfig(m=M, threshold_counts=50))
    return [sampler.frame(measure_in(frame)) for frame in frames]


def _pressed_everywhere() -> list[Samples]:
    row, col = np.indices((32, 32))
    field = (500 + 300 * np.sin(row / 5) * np.cos(col / 4)).astype(np.uint16)
    sampler = Sampler(SamplingConfig(scheme="random", m=M))
    return [sampler.frame(measure_in(field)) for _ in range(FRAMES)]
