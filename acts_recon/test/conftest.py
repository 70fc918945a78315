# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A small dictionary, the node in a ROS domain, and recorded frames where they are present."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from recon_bench import Bench, Listener

from acts_recon.sparse import Dictionary, save_dictionary


@pytest.fixture(scope="session")
def dictionary() -> Dictionary:
    """Smooth random atoms for 8 x 8 patches."""
    rng = np.random.default_rng(7)
    row, col = np.indices((8, 8))
    atoms = []
    for _ in range(150):
        r, c = rng.uniform(-2, 10, 2)
        sr, sc = rng.uniform(0.7, 4, 2)
        atoms.append(np.exp(-(((row - r) / sr) ** 2) - ((col - c) / sc) ** 2).T.ravel() + 1e-3 * rng.random(64))
    matrix = np.array(atoms).T
    return Dictionary((matrix / np.linalg.norm(matrix, axis=0)).astype(np.float32), 8, {"seed": 7}, "made for tests")


@pytest.fixture(scope="session")
def dictionary_path(dictionary: Dictionary, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file that holds it."""
    path = tmp_path_factory.mktemp("dictionaries") / "test.npz"
    save_dictionary(dictionary, path)
    return path


@pytest.fixture
def make_bench(dictionary_path: Path) -> Iterator[Callable[..., Bench]]:
    """A function that starts the node in the ROS domain of a number with some parameters."""
    benches: list[Bench] = []

    def make(domain_id: int, **parameters: object) -> Bench:
        benches.append(Bench(domain_id, dictionary_path, parameters))
        return benches[-1]

    yield make
    for bench in benches:
        bench.close()


@pytest.fixture
def make_peers() -> Iterator[Callable[..., Listener]]:
    """A function that starts a node that listens in the ROS domain of a number; other nodes can be added to it."""
    made: list[Listener] = []

    def make(domain_id: int, namespace: str = "/plate") -> Listener:
        made.append(Listener(domain_id, namespace))
        return made[-1]

    yield make
    for peers in made:
        peers.close()


@pytest.fixture(scope="session")
def grasp_frames(recording_path: Callable[[str], Path]) -> NDArray[np.uint16]:
    """Frames of real grasps, one in the middle of each of 40 recordings."""
    with np.load(recording_path("sdh_weiss/grasps_canvas.npz")) as archive:
        middle = archive["start"] + archive["length"] // 2
        return archive["frames"][middle[::10][:40]]
