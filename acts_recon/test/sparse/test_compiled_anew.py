# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""An image is the same, bit for bit, by kernels that were just compiled and by those that were kept from before."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

RECOVER = """
import hashlib
import numpy as np
from acts_core.array import ArrayGeometry
from acts_recon.sparse import Reconstructor, load_dictionary, shipped_dictionary_path

reconstructor = Reconstructor(ArrayGeometry(), load_dictionary(shipped_dictionary_path()))
rng = np.random.default_rng(1)
rows, cols = np.mgrid[:32, :32]
digest = hashlib.sha256()
for step in range(50):
    skin = 700 * np.exp(-((rows - 10 - step / 20) ** 2 + (cols - 12) ** 2) / 8)
    indices = rng.permutation(1024)[:200].astype(np.uint16)
    digest.update(reconstructor.recover(indices, skin.ravel()[indices].astype(np.uint16)).tobytes())
print(digest.hexdigest())
"""


def test_an_image_does_not_depend_on_whether_kernels_were_just_compiled(tmp_path: Path) -> None:
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    compiled, kept = (
        subprocess.run(
            [sys.executable, "-c", RECOVER], env=environment, capture_output=True, text=True, check=True, timeout=300
        ).stdout
        for _ in range(2)
    )
    assert compiled == kept
