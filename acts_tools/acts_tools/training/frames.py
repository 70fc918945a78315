# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Full frames for training, from recordings (npz files and bags) or from the contact model."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import RecordingError
from acts_core.files import load_frames
from acts_sim.pressing import ContactModel, ContactObject
from acts_tools.large_files import tell_if_large

_OF_A_BAG = (".zstd", "metadata.yaml")
"""How the names of a bag's other files end: compressed ones, and what it says of itself."""


@dataclass(frozen=True)
class Source:
    """Frames and a description of their source.

    Attributes
    ----------
    frames : np.ndarray [shape=(n, rows, cols), dtype=uint16]
        Counts, 0 to 1023.
    description : str
        Text for the dictionary's provenance.
    """

    frames: NDArray[np.uint16]
    description: str


def is_bag(path: Path) -> bool:
    """Whether a path is a bag: a folder, or a file of one of rosbag2's storages."""
    return path.is_dir() or path.suffix in (".mcap", ".db3")


def each_once(paths: Sequence[Path]) -> list[Path]:
    """Without those that are given once more: their frames would count twice. A link has a name of its own."""
    once: dict[Path, Path] = {}
    for path in paths:
        once.setdefault(path.parent.resolve() / path.name, path)
    return list(once.values())


def files_of(paths: Sequence[Path]) -> list[Path]:
    """The files that are read of recordings: of a bag's folder those of the bag, not what else is there."""
    files = []
    for path in paths:
        parts = path.iterdir() if path.is_dir() else [path]
        files += [part for part in parts if part == path or is_bag(part) or part.name.endswith(_OF_A_BAG)]
    return files


def recorded_frames(paths: Sequence[Path], topic: str = "") -> Source:
    """All frames of recordings.

    Parameters
    ----------
    paths : sequence of Path
        npz files with `frames`, which are 0 where the file's `live` is false, or bags (see
        `acts_tools.training.bag_frames`).
    topic : str
        Topic of the bags; empty for the only one with full frames.

    Raises
    ------
    RecordingError
        A file cannot be read, has no full frames, or has frames of another size.
    """
    if topic and not any(map(is_bag, paths)):
        raise RecordingError(f"--topic {topic}: none of the recordings is a bag; leave it out")
    parts: list[NDArray[np.uint16]] = []
    descriptions = []
    for path in each_once(paths):
        if is_bag(path):
            from acts_tools.training.bag_frames import bag_frames

            frames, used = bag_frames(path, topic)
            description = f"{len(frames)} frames of {used} in {path.resolve().name}"
        else:
            tell_if_large(path)
            file = load_frames(path)
            # What is no taxel, or a broken one, reads something all the same.
            frames = file.frames if file.live.all() else file.frames * file.live
            description = f"{len(frames)} frames of {path.name}"
        if parts and frames.shape[1:] != parts[0].shape[1:]:
            raise RecordingError(
                f"{path}: frames of {_size(frames)}, those of {paths[0]} are {_size(parts[0])}: all must be of one size"
            )
        parts.append(frames)
        descriptions.append(f"{description} (sha256 {digest_of(path)})")
    return Source(parts[0] if len(parts) == 1 else np.concatenate(parts), ", ".join(descriptions))


def model_frames(
    objects: list[ContactObject], presses: int, seed: int, show: Callable[[int], None] = lambda _: None
) -> NDArray[np.uint16]:
    """Frames of random presses of each object in turn; np.ndarray [shape=(presses, 32, 32), dtype=uint16].

    `show` is called with the number of frames after each.
    """
    model = ContactModel(seed=seed)
    frames = []
    for i in range(presses):
        frames.append(model.random_frame(objects[i % len(objects)]))
        show(i + 1)
    return np.stack(frames)


def digest_of(path: Path) -> str:
    """SHA-256 of a file, or of all files of a folder in the order of their names."""
    digest = hashlib.sha256()
    for part in sorted(path.iterdir()) if path.is_dir() else [path]:
        if part.is_file():
            with part.open("rb") as file:
                while piece := file.read(1 << 20):
                    digest.update(piece)
    return digest.hexdigest()


def _size(frames: NDArray) -> str:
    return f"{frames.shape[1]} x {frames.shape[2]} taxels"
