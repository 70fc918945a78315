# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Import of pyarrow, the optional library that writes parquet."""

from __future__ import annotations

import importlib
from typing import Any

from acts_core.errors import RecordingError


def arrow() -> tuple[Any, Any]:
    """Return the modules ``pyarrow`` and ``pyarrow.parquet``.

    Raises
    ------
    RecordingError
        They are not installed.
    """
    try:
        return importlib.import_module("pyarrow"), importlib.import_module("pyarrow.parquet")
    except ImportError as error:
        raise RecordingError(
            "the Python package pyarrow, which writes parquet files, is not installed. Install it with: "
            "./acts run python3 -m pip install pyarrow (on a ROS installation: pip install pyarrow); "
            "csv and npz do without"
        ) from error
