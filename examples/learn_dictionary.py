# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Learn a dictionary from full frames of your own.

    python3 examples/learn_dictionary.py FILE.npz DICTIONARY.npz [ATOMS]

FILE.npz holds `frames` (n, rows, cols), 0 to 1023 counts. `acts train` does the same with more choice.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

from acts_core.errors import ActsError
from acts_core.files import load_frames
from acts_recon.learning import KsvdConfig, learn_dictionary, prune_coherent, random_patches
from acts_recon.sparse import Dictionary, save_dictionary

PATCH_SIZE = 8


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path, help="an .npz file with full frames")
    parser.add_argument("dictionary", type=Path, help="the .npz file to write")
    parser.add_argument("atoms", type=int, nargs="?", default=1000, help="atoms of the dictionary (%(default)s)")
    arguments = parser.parse_args()
    if not arguments.dictionary.parent.is_dir():
        parser.error(f"{arguments.dictionary}: there is no folder {arguments.dictionary.parent}; make it first")
    if arguments.dictionary.is_dir():
        parser.error(f"{arguments.dictionary} is a folder; name the file to write")
    config = KsvdConfig(atoms=arguments.atoms)
    rng = np.random.default_rng(0)

    frames = load_frames(arguments.file).frames
    # 8 x 8 taxels from anywhere, with at least 4 of them pressed, and no two alike.
    patches = random_patches(frames, 40 * config.atoms, size=PATCH_SIZE, min_active=4, rng=rng)
    patches = patches[prune_coherent(patches, 0.99)]
    print(f"{len(patches)} patches out of {len(frames)} frames")

    atoms = learn_dictionary(
        patches,
        config,
        rng=rng,
        progress=lambda state: print(f"iteration {state.iteration}: {100 * state.relative_error:.1f} % unexplained"),
    )
    save_dictionary(
        Dictionary(atoms, PATCH_SIZE, provenance=f"learnt from {arguments.file.name}"), arguments.dictionary
    )
    print(f"{arguments.dictionary}: {config.atoms} atoms, for Reconstructor, and for the node's parameter `dictionary`")


if __name__ == "__main__":
    try:
        main()
    except (ActsError, OSError) as error:
        sys.exit(f"error: {error}")
