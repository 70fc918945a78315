# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Presses of the 30 simulated objects, and the scores of a method on them: what the figures on recovery share."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import SettingsError
from acts_core.sampling import SamplingConfig
from acts_recon.learning import KsvdConfig, learn_dictionary
from acts_recon.methods import Method, SkinSetup
from acts_recon.sparse import Dictionary, load_dictionary, shipped_dictionary_path
from acts_sim.pressing import OBJECTS, ContactObject
from acts_tools.evaluate.estimators.methods import PAPER_TOUCH_COUNTS, method_named
from acts_tools.evaluate.images.objects_command import press_recordings
from acts_tools.evaluate.images.recovery import Recording, Task, evaluate
from acts_tools.evaluate.scene_frames import FOLLOW_COUNTS
from acts_tools.figures.run import Run
from acts_tools.firmware.board_sampler import sampler_of
from acts_tools.training.frames import model_frames
from acts_tools.training.patches import PatchChoice, choose_patches

PUBLISHED_SCHEMES = {"adaptive": "Binary Sampling", "uniform": "Down Sampling", "random": "Random Sampling"}
"""The paper's schemes, and what its figure files call them."""

SCHEMES = tuple(PUBLISHED_SCHEMES)

M = (42, 56, 64, 88, 128, 176, 256, 352, 512)
M_FAST = (64, 256)
FULL_HZ = 1000.0
"""Largest frame rate of a board."""

TENTH_HZ = 100.0
"""Frame rate where methods of single frames are compared: a tenth of the frames has the same mean."""

_OF_SINGLE_FRAMES = ("paper", "dct", "haar", "linear")

HELD_S = 0.046
"""Time since a touch began, for our images of several frames."""

_NOISE_COUNTS = 3.0
_OBJECTS_FAST = 5


def objects(run: Run) -> list[ContactObject]:
    """All objects, or a few of different size."""
    items = list(OBJECTS.values())
    return run.pick(items, items[:: len(items) // _OBJECTS_FAST][:_OBJECTS_FAST])


def presses(run: Run, items: Sequence[ContactObject]) -> list[Recording]:
    """One press of every object, as `acts evaluate objects` makes them of the same seed."""
    return press_recordings(items, 1, run.seed)


def task(
    run: Run, method: str, scheme: str, m: int, *, rate_hz: float = FULL_HZ, sparsity_ratio: float | None = None
) -> Task:
    """A method with a scheme and M taxels, scored over whole presses.

    Raises
    ------
    SettingsError
        When a method that remembers earlier frames is to have fewer of them than a board sends.
    """
    if rate_hz < FULL_HZ and method not in _OF_SINGLE_FRAMES:
        raise SettingsError(
            f"{method} at {rate_hz:g} frames/s: it remembers earlier frames, so it is scored at {FULL_HZ:g}; fewer are "
            f"for {', '.join(_OF_SINGLE_FRAMES)}"
        )
    threshold = FOLLOW_COUNTS if scheme == "tracking" else PAPER_TOUCH_COUNTS
    sampling = SamplingConfig(scheme=scheme, m=m, threshold_counts=threshold, seed=run.seed)
    return Task(
        sampling,
        method,
        rate_hz=rate_hz,
        onset_s=0.0,
        noise_counts=_NOISE_COUNTS,
        settings=() if sparsity_ratio is None else (("sparsity_ratio", sparsity_ratio),),
    )


def shipped() -> Dictionary:
    """The dictionary that comes with ACTS."""
    return load_dictionary(shipped_dictionary_path())


def support(recordings: Sequence[Recording], its: Task, dictionary: Dictionary) -> float:
    """Support accuracy, mean over all frames in contact."""
    return float(evaluate(recordings, its, dictionary)["support_accuracy"])


def over_m(
    run: Run,
    title: str,
    recordings: Sequence[Recording],
    pairs: Sequence[tuple[str, str]],
    dictionary: Dictionary,
    *,
    ms: Sequence[int] | None = None,
    rate_hz: float = FULL_HZ,
) -> dict[str, Any]:
    """Support accuracy of methods with schemes over M.

    Returns
    -------
    dict
        `m`, and `support`: by "method, scheme" a list of one number for each M.

    Raises
    ------
    SettingsError
        As `task`.
    """
    ms = run.pick(M if ms is None else ms, M_FAST)
    found: dict[str, list[float]] = {}
    with run.progress(title, len(pairs) * len(ms)) as progress:
        for method, scheme in pairs:
            values = found.setdefault(f"{method}, {scheme}", [])
            for m in ms:
                values.append(support(recordings, task(run, method, scheme, m, rate_hz=rate_hz), dictionary))
                progress.show(sum(map(len, found.values())))
    return {"m": list(ms), "support": found}


def ours_over_m(run: Run) -> dict[str, Any]:
    """Support accuracy of our method over M, on one press of every object."""

    def measure() -> Any:
        return over_m(run, "ours over M", presses(run, objects(run)), [("acts", "tracking")], shipped())

    return run.shared("ours", measure)


def samples_of_held(run: Run, frame: NDArray, scheme: str, m: int) -> tuple[NDArray, NDArray, NDArray]:
    """One frame of samples of a touch that is held: taxels, counts, and these as an image, with 0 elsewhere."""
    its = task(run, "paper", scheme, m)
    indices, counts = sampler_of(its.sampling, its.noise_counts).frame(frame[None], 0.0, 0.0)
    measured = np.zeros(frame.size)
    measured[indices] = counts
    return indices, counts, measured


def recovered_alone(method: str, indices: NDArray, counts: NDArray) -> NDArray:
    """The image of one frame of samples, by a method of single frames."""
    return _method(method).step(indices, counts, 0.0, 0.0)


def _method(name: str) -> Method:
    return method_named(name)(SkinSetup(ArrayGeometry(), touch_counts=PAPER_TOUCH_COUNTS), shipped(), {})


def ours_of_held(run: Run, frame: NDArray, m: int) -> tuple[NDArray, int]:
    """Our image of a touch that is held, `HELD_S` after it began, and how many frames it is made of."""
    its = task(run, "acts", "tracking", m)
    sampler = sampler_of(its.sampling, its.noise_counts)
    method = _method("acts")
    image, count = method.image, max(round(HELD_S / its.period_s), 1)
    for number in range(1, count + 1):
        image = method.step(*sampler.frame(frame[None], 0.0, 0.0), number * its.period_s, its.duration_s)
    return image, count


def learn(
    run: Run,
    items: Sequence[ContactObject],
    *,
    atoms: int,
    patches: int,
    frames: int,
    show: Callable[[float], None],
) -> Dictionary:
    """Learn a dictionary from presses of some objects, with the settings of `acts train`.

    Parameters
    ----------
    run : Run
        Its seed is taken.
    items : sequence of ContactObject
    atoms, patches, frames : int
        How many there are.
    show : callable
        Called with the share of the iterations that is done.
    """
    config = KsvdConfig(atoms=atoms)
    rng = np.random.default_rng(run.seed)
    pressed = model_frames(list(items), frames, run.seed)
    chosen = choose_patches(pressed, patches, rng)
    learnt = learn_dictionary(chosen, config, rng=rng, progress=lambda state: show(state.iteration / config.iterations))
    return Dictionary(learnt, PatchChoice().patch_size, {}, f"{atoms} atoms of {len(items)} objects")
