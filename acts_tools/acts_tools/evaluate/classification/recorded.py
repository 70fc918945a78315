# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Classification of labelled recordings: the paper's SRC, ours, and nearest neighbour on full frames."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.array import TOUCH_COUNTS
from acts_core.errors import RecordingError
from acts_core.files import FramesFile, without_contact
from acts_core.words import counted
from acts_recon.objects import ImageClassifierConfig, build_object_library
from acts_tools.evaluate.classification.contenders import SCHEMES, Contender, contenders
from acts_tools.evaluate.classification.trials import accuracy, answers
from acts_tools.evaluate.images.options import require_frames

NEAREST = "nearest"
_RUN_UP_S = 1.0
"""Time that is played before the classified frame [s]."""


def run_recorded(
    recorded: FramesFile,
    ms: Sequence[int],
    show: Callable[[float], None],
    write: Callable[[dict[str, Any]], None] = lambda _: None,
) -> dict[str, Any]:
    """Classify the strongest frame of every recording by the strongest frames of other recordings.

    The first half of each object's recordings, in the order of the file, is the library; the rest is classified.
    Recordings without a touch in their strongest frame are skipped. `show` is called with the share that is done,
    `write` after each M with the results so far.

    Returns
    -------
    dict
        `over_m`: a list of accuracies by method; `library`, `presses`, `classes`: their numbers.

    Raises
    ------
    RecordingError
        When there is no label or rate, only one label, or an object has fewer than two recordings.
    SettingsError
        It names each M that the array does not have.
    """
    if recorded.rate_hz is None or not recorded.label:
        missing = "no `rate_hz`" if recorded.rate_hz is None else "no `label`"
        raise RecordingError(
            f"{missing} in the file: needed are a rate and a label for every recording (start, length)"
        )
    flat = recorded.frames * recorded.live
    peaks = recorded.peaks()
    largest = [int(flat[peak].max()) for peak in peaks]
    if max(largest) <= TOUCH_COUNTS:
        raise RecordingError(f"nothing was touched: {without_contact(max(largest), TOUCH_COUNTS)}")
    if len(set(recorded.label)) < 2:
        raise RecordingError(
            f"all recordings have the label {recorded.label[0]!r}: of one object every answer is right; needed are two "
            "or more"
        )
    require_frames(((scheme, m) for m in ms for scheme in SCHEMES), recorded.frames.shape[1:])
    known, asked = _split(recorded, [count > TOUCH_COUNTS for count in largest])
    frames = np.stack([flat[peaks[number]] for number in known])
    labels = [recorded.label[number] for number in known]
    coarse = build_object_library(frames, labels, touch_counts=TOUCH_COUNTS)
    fine = build_object_library(frames, labels, touch_counts=ImageClassifierConfig().touch_counts)
    truth = [coarse.names.index(recorded.label[number]) for number in asked]
    over_m: dict[str, list[dict[str, Any]]] = defaultdict(list)
    cosines = np.stack([flat[peaks[number]].ravel() for number in asked]) @ fine.columns
    nearest = fine.classes[np.argmax(cosines, axis=1)]
    results = {"over_m": over_m, "library": len(known), "presses": len(asked), "classes": coarse.n_classes}
    done = 0
    for m in ms:
        judged = contenders(coarse, fine, m)
        for method, contender in judged.items():
            right = 0
            for number, wanted in zip(asked, truth, strict=True):
                show(done / (len(ms) * len(judged) * len(asked)))
                done += 1
                start = recorded.start[number]
                frames = flat[start : start + recorded.length[number]]
                right += _answer(contender, frames, recorded.rate_hz, peaks[number] - start) == wanted
            over_m[method].append({"m": m, **accuracy(right, len(asked))})
        over_m[NEAREST].append({"m": m, **accuracy(int((nearest == truth).sum()), len(asked))})
        write(results)
    return results


def _answer(contender: Contender, frames: NDArray[np.uint16], rate_hz: float, peak: int) -> int | None:
    """What is answered to the strongest frame of a recording, by its number in the recording."""
    peak_s = peak / rate_hz
    # The last frame of samples that ends by the strongest frame; the first frame is held before.
    return answers(contender, np.ascontiguousarray(frames), rate_hz, peak_s, [0.0], run_up_s=min(peak_s, _RUN_UP_S))[0]


def _split(recorded: FramesFile, touched: Sequence[bool]) -> tuple[list[int], list[int]]:
    """Indices of the recordings in the library, and of those to classify."""
    known, asked = [], []
    for label in sorted(set(recorded.label)):
        own = [n for n, other in enumerate(recorded.label) if other == label and touched[n]]
        if len(own) < 2:
            raise RecordingError(f"{label!r} has {counted(len(own), 'recording')} with a touch; needed are at least 2")
        half = len(own) // 2
        known += own[:half]
        asked += own[half:]
    return known, asked
