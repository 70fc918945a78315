# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts train`: learn a dictionary from recordings or from the contact model."""

from __future__ import annotations

import argparse
import hashlib
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import RecordingError, SettingsError
from acts_core.files import without_contact
from acts_core.names import full_name
from acts_core.settings import part_of
from acts_core.words import counted
from acts_recon.learning import KsvdConfig, KsvdProgress, learn_dictionary
from acts_recon.sparse import Dictionary, save_dictionary
from acts_sim.pressing import OBJECTS, FoamConfig, object_named
from acts_tools.arguments import add_settings, random_seed, refuse_unused, whole
from acts_tools.output_file import require_writable
from acts_tools.progress import Progress
from acts_tools.training.checkpoint import Checkpoint
from acts_tools.training.frames import Source, files_of, model_frames, recorded_frames
from acts_tools.training.patches import PatchChoice, choose_patches

_OF_KSVD = ("atoms", "sparsity", "iterations")
"""Settings that are options; the others stay as they are."""


_EPILOG = """\
examples:
  acts train -o mine.npz                                from the contact model, as the shipped dictionary
  acts train --frames FILE.npz -o mine.npz              from full frames of your own
  acts train --frames touch --topic /plate/samples -o mine.npz

`acts launch acts_bringup tactile.launch.xml method:=per_frame dictionary:=mine.npz` uses it. docs/reconstruction.md
explains the settings.
"""


def add_parser(subparsers: Any) -> None:
    """Add ``acts train`` to the acts command."""
    parser = subparsers.add_parser(
        "train",
        help="train a dictionary for the reconstruction",
        description="Learn a dictionary by K-SVD and write it to a file that the node reconstruction reads (its "
        "parameter dictionary). Frames come from the contact model, or from recordings. After an interruption, the "
        "same command continues from the last finished iteration, which is saved in FILE.partial.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE", help="dictionary file to write")
    parser.add_argument(
        "--frames",
        nargs="+",
        action="extend",
        type=Path,
        metavar="PATH",
        help="learn from recordings, not the contact model: npz files with `frames` (n, rows, cols), or bags with full "
        "frames (images in mono16, or samples of the scheme raster, which lie as the wires do)",
    )
    parser.add_argument("--topic", default="", help="topic of the bags (default: the only one with full frames)")
    parser.add_argument(
        "--objects", nargs="+", action="extend", metavar="NAME", help="objects of the contact model (default: all)"
    )
    million = 10**6
    for name, numbers, default, text in (
        ("presses", whole(1, million), 3000, "frames of the contact model"),
        ("patches", whole(2, million), 15000, "largest number of patches"),
        ("seed", random_seed, 0, "random seed"),
    ):
        parser.add_argument(
            f"--{name}", type=numbers, default=default, metavar="X", help=f"{text} (default: %(default)s)"
        )
    add_settings(parser, PatchChoice)
    add_settings(parser, KsvdConfig, *_OF_KSVD)


def run(arguments: argparse.Namespace) -> int:
    """Train a dictionary and return the exit code.

    Raises
    ------
    ActsError
        When the frames cannot be read, a setting is out of range, or there are too few patches.
    """
    _check(arguments)
    config = KsvdConfig(**{name: getattr(arguments, name) for name in _OF_KSVD})
    choice = part_of(PatchChoice, arguments)
    rng = np.random.default_rng(arguments.seed)
    source, settings = _source(arguments)
    patches = choose_patches(source.frames, arguments.patches, rng, choice)
    settings = {
        **asdict(config),
        "seed": arguments.seed,
        "patches": len(patches),
        "min_active": arguments.min_active,
        "touch_counts": arguments.touch_counts,
        "patch_coherence": arguments.coherence,
        **settings,
    }
    # Everything that the result depends on; the patches' hash covers the frames and the choice of patches.
    checkpoint = Checkpoint(
        _partial(arguments.output),
        {**settings, "patches_sha256": hashlib.sha256(patches.tobytes()).hexdigest()},
    )
    atoms = _learn(patches, config, rng, checkpoint)
    provenance = f"Learnt by K-SVD (acts train) from {source.description}."
    dictionary = Dictionary(atoms, arguments.patch_size, settings, provenance)
    save_dictionary(dictionary, arguments.output)
    checkpoint.remove()
    size_kb = arguments.output.stat().st_size / 1000
    print(f"{arguments.output}: {counted(dictionary.n_atoms, 'atom')}, {size_kb:.0f} kB, sha256 {dictionary.sha256}")
    return 0


def _learn(
    patches: NDArray[np.float32], config: KsvdConfig, rng: np.random.Generator, checkpoint: Checkpoint
) -> NDArray[np.float32]:
    """The atoms of patches, from where an interrupted run has left off."""
    state = checkpoint.load()
    done = 0 if state is None else state.iteration
    print(
        f"{counted(len(patches), 'patch', 'patches')}; learning {counted(config.atoms, 'atom')} in "
        + counted(config.iterations, "iteration")
        + (f", the first {done} of them taken from {checkpoint.path}" if done else ""),
        flush=True,
    )
    try:
        with Progress("iteration", config.iterations, done=done, keep=True, stream=sys.stdout) as bar:

            def show(progress: KsvdProgress) -> None:
                residual = 100 * progress.relative_error
                bar.show(
                    progress.iteration, f"residual {residual:.2f} %, {counted(progress.replaced, 'atom')} replaced"
                )

            return learn_dictionary(patches, config, rng=rng, progress=show, save=checkpoint.save, resume=state)
    except KeyboardInterrupt:
        if checkpoint.path.exists():
            print(f"interrupted; progress is saved in {checkpoint.path}: the same command continues", file=sys.stderr)
        raise


def _source(arguments: argparse.Namespace) -> tuple[Source, dict[str, Any]]:
    """The frames, and the settings of their source."""
    if arguments.frames is not None:
        recorded = recorded_frames(arguments.frames, full_name(arguments.topic) if arguments.topic else "")
        largest = int(recorded.frames.max(initial=0))
        if largest <= arguments.touch_counts:
            files = ", ".join(map(str, arguments.frames))
            words = without_contact(largest, arguments.touch_counts)
            raise RecordingError(f"{files}: {words}, or a lower --touch-counts")
        return recorded, {}
    # An object that is named twice is one object.
    objects = [object_named(name) for name in dict.fromkeys(arguments.objects or OBJECTS)]
    print(f"pressing {counted(len(objects), 'object')} into the contact model", flush=True)
    with Progress("press", arguments.presses, keep=True, stream=sys.stdout) as bar:
        frames = model_frames(objects, arguments.presses, arguments.seed, bar.show)
    presses = counted(arguments.presses, "press", "presses")
    description = f"{presses} of {counted(len(objects), 'object')} into the ACTS contact model"
    made = {"presses": arguments.presses, "objects": [item.name for item in objects], **asdict(FoamConfig())}
    return Source(frames, description), made


def _check(arguments: argparse.Namespace) -> None:
    if arguments.frames is not None and arguments.objects:
        raise SettingsError("--objects names objects of the contact model and does not go with --frames; leave one out")
    if arguments.frames is not None:
        refuse_unused(arguments, "with --frames", "presses")
    if arguments.frames is None and arguments.topic:
        raise SettingsError(f"--topic {arguments.topic}: a topic of the bags of --frames, which were not given")
    reads = files_of(arguments.frames or ())
    require_writable(arguments.output, takes_stream=False, reads=reads)
    require_writable(_partial(arguments.output), takes_stream=False, reads=reads)


def _partial(output: Path) -> Path:
    """The file of the checkpoint."""
    return output.with_name(f"{output.name}.partial")
