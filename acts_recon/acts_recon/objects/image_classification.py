# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Which object presses: known objects against an image of which some taxels are surer than others.

The paper's SRC (`classification`) classifies the samples of one frame. Here the image of several frames is
classified, each taxel weighted by its uncertainty (docs/recovery.md has the figures):

- **Weighted least squares.** Residuals are of ``w (image - pattern)``, where e in
  ``w^2 = 1 / (noise^2 + (e image)^2 + sigma^2)`` is the `relative_error`. Untouched taxels have weight, too:
  they count against an object that would press them.
- **Several depths.** An object that has only begun to press shows its lowest parts. Each column of the library is
  therefore known at several depths: on an elastic foundation, a smaller depth takes a constant off all forces.
- **Force prior.** Force goes with depth: a small object pressed hard is not a large one that has just touched.
  The penalty of a force is its negative log-likelihood, scaled: ``(e / force_error * log(force))^2`` of the force
  relative to the library's, about which it is log-normal.
- **Non-negative least squares.** A class explains the image by non-negative multiples of its own columns.
- **Memory.** Residuals are averaged over the last frames, exponentially.
- **SRC at rest.** While the skin hardly changes, SRC on the whole image (`image_src_kernels`) tells similar objects
  apart better. Its residuals are weighed in by `src_weight`, as a geometric mean.

`ImageClassifier` runs `image_classification_kernels` on one image after another, in single precision. The reference
implementation for a single image, in double precision, is `classification_reference` in the tests.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.errors import ArrayError
from acts_core.kernels import as_compiled
from acts_core.settings import setting, validate
from acts_core.skin import ForceResponse, Response
from acts_recon.objects import image_classification_kernels as kernels
from acts_recon.objects import image_src_kernels
from acts_recon.objects.classification import Classification
from acts_recon.objects.classification_kernels import decide
from acts_recon.objects.object_library import ObjectLibrary
from acts_recon.objects.rate_of_change import RateOfChange

LEVELS = (0.0, 0.2, 0.4, 0.6, 0.75, 0.87, 0.94)
"""What is taken off a column's forces to know it less deep, as shares of the largest."""

REFINED_CLASSES = 5
"""Classes that may mix their columns: those of which one column alone explains most."""

MIXED_COLUMNS = 6
"""Columns, of all depths, that a class mixes: those that alone explain most."""

_LEAST_WEIGHT = 0.01
"""Below it SRC is not asked: it would take time and change nothing."""


@dataclass(frozen=True)
class ImageClassifierConfig:
    """Settings of the classification of images.

    The node sets `touch_counts` and `src_weight` alone; the others are no parameters, and as the figures in docs/ have
    them.
    """

    touch_counts: int = setting(15, "counts above which a taxel is pressed; others are 0", minimum=0, maximum=COUNT_MAX)
    noise_counts: float = setting(6.0, "standard deviation of a fresh, unpressed taxel", minimum=0.1, maximum=COUNT_MAX)
    relative_error: float = setting(
        0.08, "standard deviation of a pressed taxel from the library's, of its value", minimum=0, maximum=10
    )
    force_error: float = setting(
        0.2, "standard deviation of how hard is pressed, from the library's at that depth, as a logarithm", minimum=0.01
    )
    memory_s: float = setting(0.003, "time constant of the average of residuals over frames [s]", minimum=0, maximum=10)
    src_weight: float = setting(
        2.0, "weight of SRC on a resting image against the comparison of images; 0: none", minimum=0, maximum=100
    )
    rest_counts_per_s: float = setting(
        4000.0, "rate of change of the skin at which SRC has half its weight [counts/s]", minimum=1, maximum=1e9
    )

    def __post_init__(self) -> None:
        validate(self)


def shallower_patterns(
    library: ObjectLibrary, response: Response | None = None
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.int64]]:
    """Every column of a library at all `LEVELS`.

    Parameters
    ----------
    library : ObjectLibrary
    response : Response, optional
        From counts to newtons and back.

    Returns
    -------
    patterns : np.ndarray [shape=(n_columns * n_levels, taxels), dtype=float32]
        Each of norm 1; 0 throughout where nothing is left of a faint press.
    norms_counts : np.ndarray [shape=(n_columns * n_levels,), dtype=float32]
        Norm of each as it was pressed [counts]; 1 where nothing is left.
    classes : np.ndarray [shape=(n_columns * n_levels,), dtype=int64]
    """
    response = ForceResponse() if response is None else response
    counts = (library.columns * library.norms_counts).T.astype(np.float64)
    forces_n = response.force_n(counts)
    # Level 0 is the frame as it was measured; above full scale there is no way from counts to force and back.
    cut = [counts]
    for level in LEVELS[1:]:
        less_n = np.maximum(forces_n - level * forces_n.max(axis=1, keepdims=True), 0.0)
        cut.append(np.where(less_n > 0, response.counts(less_n), 0.0))
    patterns = np.stack(cut, axis=1).reshape(-1, counts.shape[1])
    norms_counts = np.linalg.norm(patterns, axis=1)
    norms_counts[norms_counts == 0] = 1.0
    return (
        (patterns / norms_counts[:, None]).astype(np.float32),
        norms_counts.astype(np.float32),
        np.repeat(library.classes, len(LEVELS)),
    )


def src_weight(rate_counts_per_s: float, config: ImageClassifierConfig) -> float:
    """Weight of SRC's residuals against those of the comparison of images, by the skin's rate of change."""
    return config.src_weight / (1 + (rate_counts_per_s / config.rest_counts_per_s) ** 2)


class ImageClassifier:
    """Classifies image after image without allocating; everything is compiled before the first one.

    Parameters
    ----------
    library : ObjectLibrary
        Best of frames whose counts above some 15 are kept: also faint parts tell objects apart.
    config : ImageClassifierConfig, optional
    response : Response, optional
        From counts to newtons and back: how the library's objects look less deep.
    """

    def __init__(
        self,
        library: ObjectLibrary,
        config: ImageClassifierConfig | None = None,
        response: Response | None = None,
    ) -> None:
        self.library = library
        self.config = config or ImageClassifierConfig()
        taxels, n_classes = library.rows * library.cols, library.n_classes
        self._model = kernels.Model.of(*shallower_patterns(library, response), len(LEVELS), n_classes)
        self._state = kernels.State.empty(taxels, len(self._model.classes), n_classes)
        self._settings = kernels.Settings(
            touch_counts=float(self.config.touch_counts),
            noise_counts=self.config.noise_counts,
            relative_error=self.config.relative_error,
            force_weight=self.config.relative_error / self.config.force_error,
            refined=REFINED_CLASSES,
            mixing=MIXED_COLUMNS,
        )
        self._rate_of_change = RateOfChange(library.rows, library.cols, self.config.touch_counts)
        self._src_model = image_src_kernels.Model.of(library)
        self._src_work = image_src_kernels.Workspace.empty(taxels, n_classes)
        self._explained = self._state.explained[:: len(LEVELS)]
        self._skipped_s = 0.0
        # Compile, or load from the cache, what the first image would otherwise wait seconds for.
        image = np.full((library.rows, library.cols), COUNT_MAX, dtype=np.float32)
        # Nothing was measured, so the skin is at rest and SRC is compiled as well.
        self.step(image, np.zeros_like(image), np.full_like(image, np.inf), 0.001)
        self.reset()

    def reset(self) -> None:
        """Start anew."""
        self._rate_of_change.reset()
        self._skipped_s = 0.0
        self._state.left.fill(0)
        self._state.energy.fill(0)

    def update(
        self,
        image: NDArray[np.float32],
        sigma: NDArray[np.float32],
        age_s: NDArray[np.float32],
        period_s: float,
    ) -> None:
        """Update the rate of change by the next image, without classifying it.

        Parameters and errors are those of `step`.
        """
        self._inflated_sigma(image, sigma, age_s, period_s)

    def step(
        self,
        image: NDArray[np.float32],
        sigma: NDArray[np.float32],
        age_s: NDArray[np.float32],
        period_s: float,
    ) -> Classification:
        """Classify the next image.

        Parameters
        ----------
        image : np.ndarray [shape=(rows, cols), dtype=float32]
            Counts.
        sigma : np.ndarray [shape=(rows, cols), dtype=float32]
            Standard deviation of each [counts].
        age_s : np.ndarray [shape=(rows, cols), dtype=float32]
            Time since each was measured [s]; inf: never.
        period_s : float
            Time since the last image [s].

        Returns
        -------
        Classification
            Its `residuals` are overwritten by the next image: copy what is to be kept.

        Raises
        ------
        ArrayError
            When the image does not fit the library, or is not C-contiguous. Everything is left as it was.
        """
        config, residuals = self.config, self._state.residuals
        inflated_sigma = self._inflated_sigma(image, sigma, age_s, period_s)
        # The residuals of earlier images fade over the images that were not classified, too.
        skipped_s, self._skipped_s = self._skipped_s, 0.0
        kept = math.exp(-skipped_s / config.memory_s) if config.memory_s > 0 else 0.0
        flat = as_compiled(image).ravel()
        touched = kernels.class_residuals(self._model, flat, inflated_sigma, self._settings, kept, self._state)
        if not touched:
            return Classification(False, 0, residuals, 0.0)
        weight = src_weight(self._rate_of_change.rate_counts_per_s, config)
        if weight >= _LEAST_WEIGHT and image_src_kernels.class_residuals(
            self._src_model,
            flat,
            inflated_sigma,
            residuals,
            self._explained,
            self._settings.touch_counts,
            self._src_work,
        ):
            kernels.weigh(residuals, self._src_work.residuals, weight)
        best, confidence = decide(residuals)
        return Classification(True, best, residuals, confidence)

    def _inflated_sigma(
        self, image: NDArray[np.float32], sigma: NDArray[np.float32], age_s: NDArray[np.float32], period_s: float
    ) -> NDArray[np.float32]:
        """Sigma of each taxel, inflated by the rate of change [counts], flat; checks the image."""
        shape = (self.library.rows, self.library.cols)
        for name, array in (("image", image), ("sigma", sigma), ("age_s", age_s)):
            # Lists come from callers without types.
            if not isinstance(array, np.ndarray):
                raise ArrayError(
                    f"{name} {type(array).__name__}: needed is an array of numpy of {shape[0]} x {shape[1]}, float32"
                )
            if array.shape != shape or array.dtype != np.float32 or not array.flags.c_contiguous:
                raise ArrayError(
                    f"{name} {array.shape}, {array.dtype}: needed is a C-contiguous float32 array of "
                    f"{shape[0]} x {shape[1]}"
                )
        if not 0 <= period_s < math.inf:
            raise ArrayError(f"period_s = {period_s}: needed is a finite time, not negative")
        period_s = float(period_s)
        fields = as_compiled(image), as_compiled(sigma), as_compiled(age_s)
        inflated_sigma = self._rate_of_change.step(*fields, period_s).ravel()
        self._skipped_s += period_s
        return inflated_sigma
