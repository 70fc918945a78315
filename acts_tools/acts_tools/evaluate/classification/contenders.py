# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node's classifiers, each with the sampling that it is judged with."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

from acts_core.array import TOUCH_COUNTS, ArrayGeometry
from acts_core.errors import SettingsError
from acts_core.sampling import SamplingConfig
from acts_recon.classifiers import CLASSIFIERS, FusedImageRecogniser, ObjectRecogniser, SrcRecogniser
from acts_recon.methods import Fusion, Recovery, SkinSetup
from acts_recon.objects import ImageClassifierConfig, ObjectLibrary

PAPER, ACTS = "paper", "acts"
SCHEMES = ("adaptive", "tracking")
"""Of the paper's method, and of all others."""

UNKNOWN_NOISE = 0.0
"""Of a recording whose noise is not known, as the node's parameter `noise_counts` [counts]."""


class Contender:
    """A classifier of the node with its own settings, its recovery, and a way of sampling.

    Parameters
    ----------
    kind : type of ObjectRecogniser
        With fusion, the node's default method; one that needs no image is given one, too.
    library : ObjectLibrary
    m : int
        Taxels per frame.
    scheme : str
        Of the sampling.
    touch_counts : int
        A taxel above it is pressed, and followed by the sampling.
    noise_counts : float
        Standard deviation of a reading [counts]; 0: not known.

    Attributes
    ----------
    sampling : SamplingConfig
    recovery : Recovery
    spent_us : list of float
        Processor time of each answer in contact, without the recovery of its image [us].
    """

    def __init__(
        self,
        kind: type[ObjectRecogniser],
        library: ObjectLibrary,
        m: int,
        *,
        scheme: str,
        touch_counts: int,
        noise_counts: float,
    ) -> None:
        rows, cols = library.rows, library.cols
        self.sampling = SamplingConfig(scheme=scheme, rows=rows, cols=cols, m=m, threshold_counts=touch_counts)
        skin = SkinSetup(ArrayGeometry(rows=rows, cols=cols), touch_counts=touch_counts, noise_counts=noise_counts)
        self.recovery = Recovery(Fusion(skin), skin)
        self._recogniser = kind(library, kind.Config(), skin, self.recovery.method)
        self.spent_us: list[float] = []

    def reset(self) -> None:
        """Prepare for another recording."""
        self.recovery.reset()
        self._recogniser.reset()

    def update(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float) -> None:
        """Update by a frame of samples, without an answer; parameters as of `ObjectRecogniser.update`."""
        self.recovery.step(indices, counts, end_s, duration_s)
        self._recogniser.update(indices, counts, end_s, duration_s)

    def answer(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> int | None:
        """Update by a frame of samples and return the class; None without a contact."""
        self.recovery.step(indices, counts, end_s, duration_s)
        began_s = time.thread_time()
        result = self._recogniser.step(indices, counts, end_s, duration_s)
        if not result.touched:
            return None
        self.spent_us.append(1e6 * (time.thread_time() - began_s))
        return result.best


def papers(library: ObjectLibrary, m: int, scheme: str = "adaptive") -> Contender:
    """The paper's method: SRC on the samples of each frame alone, of adaptive sampling or another of its schemes."""
    return Contender(SrcRecogniser, library, m, scheme=scheme, touch_counts=TOUCH_COUNTS, noise_counts=UNKNOWN_NOISE)


def ours(
    library: ObjectLibrary,
    m: int,
    *,
    noise_counts: float = UNKNOWN_NOISE,
    kind: type[ObjectRecogniser] = FusedImageRecogniser,
) -> Contender:
    """Our method, or another of the node (docs/extending.md): tracking sampling, and fusion that is told the noise."""
    touch_counts = ImageClassifierConfig().touch_counts
    return Contender(kind, library, m, scheme="tracking", touch_counts=touch_counts, noise_counts=noise_counts)


def contenders(
    coarse: ObjectLibrary, fine: ObjectLibrary, m: int, *, noise_counts: float = UNKNOWN_NOISE
) -> dict[str, Contender]:
    """All classifiers by name: the paper's, ours, and further ones of the node.

    Parameters
    ----------
    coarse, fine : ObjectLibrary
        Libraries of the same presses: without counts below the paper's touch threshold, and with them.
    m : int
        Taxels per frame.
    noise_counts : float
        Standard deviation of a reading [counts]; 0: not known, as of recorded presses.

    Raises
    ------
    SettingsError
        When a classifier of the node has the name of the paper's or of ours in reports.
    """
    for name in (PAPER, ACTS):
        if name in CLASSIFIERS:
            raise SettingsError(
                f"classifier {name!r} in acts_recon/classifiers/registry.py: the evaluation calls another one so, "
                f"which it would replace; give the classifier a name that is neither {PAPER} nor {ACTS}"
            )
    further = {name: kind for name, kind in CLASSIFIERS.items() if kind not in (SrcRecogniser, FusedImageRecogniser)}
    return {
        PAPER: papers(coarse, m),
        ACTS: ours(fine, m, noise_counts=noise_counts),
        **{name: ours(fine, m, noise_counts=noise_counts, kind=kind) for name, kind in further.items()},
    }
