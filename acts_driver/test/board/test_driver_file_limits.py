# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Files that the driver reads while its services wait: small on the disk, large once unpacked."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from acts_core.errors import ActsError
from acts_driver.baseline import Baseline
from acts_driver.board.model_file import load_model


@pytest.mark.parametrize("read", [load_model, lambda path: Baseline.load(path, 32, 32)], ids=["model", "baseline"])
def test_what_unpacks_to_more_than_any_such_file_holds_is_refused(
    read: Callable[[Path], object], tmp_path: Path
) -> None:
    path = tmp_path / "bomb.npz"
    np.savez_compressed(path, atoms=np.zeros(3_000_000))
    assert path.stat().st_size < 100_000
    with pytest.raises(ActsError, match=r"unpacks to 24 MB; allowed are 17 MB"):
        read(path)
    with pytest.raises(ActsError, match="/dev/zero: not a regular file"):
        read(Path("/dev/zero"))
