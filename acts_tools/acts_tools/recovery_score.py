"""How well full images are recovered from few samples of a frame, on recorded or modelled frames.

Prints a table::

    python3 -m acts_tools.recovery_score --frames recordings.npz --dictionary mine.npz other.npz:atoms
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, ArrayGeometry
from acts_core.errors import ActsError, DictionaryError
from acts_core.force import ForceResponse
from acts_core.frames_file import FramesFile, load_frames
from acts_core.sampling import Sampler, SamplingConfig, measure_in
from acts_recon.contact import find_contact
from acts_recon.dictionary import Dictionary, load_dictionary
from acts_recon.fastomp import recover_image
from acts_recon.patches import patch_layout
from acts_recon.reconstructor import Reconstructor, ReconstructorConfig
from acts_recon.shipped import shipped_dictionary_path
from acts_sim.objects import OBJECTS
from acts_tools.train import model_frames


@dataclass(frozen=True)
class RecoveryScore:
    """Means over the frames that hold a contact.

    Attributes
    ----------
    frames : int
        Frames scored.
    relative_error : float
        Norm of image minus truth over norm of truth.
    cop_error_taxels : float
        Distance of the count-weighted centres, over the frames whose contact was found at all.
    missed : float
        Share of the frames whose contact was not found.
    frame_us : float
        Median time for recovery and contact [us].
    """

    frames: int
    relative_error: float
    cop_error_taxels: float
    missed: float
    frame_us: float


def score_recovery(
    frames: NDArray[np.uint16],
    live: NDArray[np.bool_],
    dictionary: Dictionary,
    sampling: SamplingConfig,
    *,
    touch_counts: int = 60,
) -> RecoveryScore:
    """Sample every frame, recover it, compare.

    Parameters
    ----------
    frames : np.ndarray [shape=(n, rows, cols), dtype=uint16]
        Values at or below `touch_counts` count as 0; frames without any above are left out.
    live : np.ndarray [shape=(rows, cols), dtype=bool]
        Taxels to score.
    dictionary : Dictionary
    sampling : SamplingConfig
        Its `rows` and `cols` must be those of the frames.
    touch_counts : int
    """
    geometry = ArrayGeometry(rows=frames.shape[1], cols=frames.shape[2])
    reconstructor = Reconstructor(geometry, dictionary, ReconstructorConfig(touch_counts=touch_counts))
    sampler = Sampler(sampling)
    errors, distances, durations = [], [], []
    missed = 0
    for frame in frames:
        truth = np.where(live & (frame > touch_counts), frame, 0).astype(np.float64)
        if not truth.any():
            continue
        indices, counts = sampler.frame(measure_in(frame))
        began = time.perf_counter()
        reconstructor.step(indices, counts)
        durations.append(time.perf_counter() - began)
        image = np.where(live, reconstructor.image, 0).astype(np.float64)
        errors.append(np.linalg.norm(image - truth) / np.linalg.norm(truth))
        if image.any():
            distances.append(math.dist(_centre(image), _centre(truth)))
        else:
            missed += 1
    n = len(errors)
    return RecoveryScore(
        frames=n,
        relative_error=float(np.mean(errors)) if n else math.nan,
        cop_error_taxels=float(np.mean(distances)) if distances else math.nan,
        missed=missed / n if n else math.nan,
        frame_us=1e6 * float(np.median(durations)) if n else math.nan,
    )


def _centre(image: NDArray[np.float64]) -> tuple[float, float]:
    row, col = np.indices(image.shape)
    return float((row * image).sum() / image.sum()), float((col * image).sum() / image.sum())


def dictionary_named(word: str) -> Dictionary:
    """A dictionary from a file of `acts train`, or, for ``FILE:ARRAY``, from an array (pixels, atoms) of any npz file.

    Raises
    ------
    DictionaryError
        When there is none.
    """
    name, separator, array = word.rpartition(":")
    if not separator or Path(word).exists():
        return load_dictionary(Path(word))
    try:
        with np.load(name, allow_pickle=False) as archive:
            atoms = archive[array]
    except (OSError, ValueError, KeyError) as error:
        raise DictionaryError(f"{word}: no array {array!r} can be read from {name} ({error})") from error
    return Dictionary(atoms, math.isqrt(atoms.shape[0]), {}, word)


def twin_us(frames: NDArray[np.uint16], dictionary: Dictionary, sampling: SamplingConfig, touch_counts: int) -> float:
    """Median time of the plain NumPy version for recovery and contact [us], on frames that hold a contact."""
    geometry = ArrayGeometry(rows=frames.shape[1], cols=frames.shape[2])
    layout = patch_layout(geometry.rows, geometry.cols, size=dictionary.patch_size)
    response = ForceResponse()
    sampler = Sampler(sampling)
    durations = []
    for frame in frames:
        indices, counts = sampler.frame(measure_in(frame))
        values = np.where(counts > touch_counts, counts, 0).astype(np.float64)
        if values.any():
            began = time.perf_counter()
            image = recover_image(layout, dictionary.atoms, indices, values)
            find_contact(np.clip(image, 0, COUNT_MAX), geometry, response, touch_counts=touch_counts)
            durations.append(time.perf_counter() - began)
    return 1e6 * float(np.median(durations)) if durations else math.nan


def main(argv: Sequence[str] | None = None) -> int:
    """Print the table of scores."""
    parser = argparse.ArgumentParser(prog="python3 -m acts_tools.recovery_score", description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=Path, help="npz of frames; without it 300 presses of the contact model")
    parser.add_argument(
        "--dictionary", nargs="+", default=[], help="dictionary files, or FILE:ARRAY of any npz (default: the shipped)"
    )
    parser.add_argument("-m", type=int, nargs="+", default=[56, 128, 256], help="taxels per frame")
    parser.add_argument("--scheme", default="adaptive", help="how they are chosen")
    parser.add_argument("--search-counts", type=int, default=50, help="counts above which neighbours are searched")
    parser.add_argument("--touch-counts", type=int, default=60, help="counts above which a taxel is pressed")
    parser.add_argument("--twin", action="store_true", help="also time the plain NumPy version, on 30 frames")
    arguments = parser.parse_args(argv)
    try:
        if arguments.frames is None:
            frames = model_frames(list(OBJECTS.values()), 300, seed=1)
            recorded = FramesFile(
                frames, np.ones(frames.shape[1:], dtype=bool), np.arange(len(frames)), np.ones(len(frames), dtype=int)
            )
        else:
            recorded = load_frames(arguments.frames)
        peaks = recorded.peak_frames()
        print(
            f"{'dictionary':30} {'M':>4} {'frames':>6} {'rel. error':>10} {'CoP [taxels]':>12} {'missed':>7} {'us':>6}"
        )
        for word in arguments.dictionary or [str(shipped_dictionary_path())]:
            dictionary = dictionary_named(word)
            for m in arguments.m:
                sampling = SamplingConfig(
                    scheme=arguments.scheme,
                    rows=peaks.shape[1],
                    cols=peaks.shape[2],
                    m=m,
                    threshold_counts=arguments.search_counts,
                )
                s = score_recovery(peaks, recorded.live, dictionary, sampling, touch_counts=arguments.touch_counts)
                line = f"{Path(word).name[-30:]:30} {m:4} {s.frames:6} {s.relative_error:10.3f} "
                line += f"{s.cop_error_taxels:12.2f} {100 * s.missed:6.1f}% {s.frame_us:6.0f}"
                if arguments.twin:
                    thin = peaks[:: max(1, len(peaks) // 30)]
                    line += f"   NumPy {twin_us(thin, dictionary, sampling, arguments.touch_counts):.0f}"
                print(line, flush=True)
    except ActsError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
