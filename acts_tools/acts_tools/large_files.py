# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A line for the user before a large file is read, which takes long and is silent."""

from __future__ import annotations

import sys
from pathlib import Path

from acts_core.files import UNPACKED_BYTES_MAX, unpacked_bytes


def tell_if_large(path: Path) -> None:
    """Print how much an npz file unpacks to, if it is more than `UNPACKED_BYTES_MAX`."""
    size = unpacked_bytes(path)
    if size > UNPACKED_BYTES_MAX:
        print(f"reading {path}: {size / 1e6:.0f} MB unpacked", file=sys.stderr, flush=True)
