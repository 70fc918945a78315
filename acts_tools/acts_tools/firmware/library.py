# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Find the libraries that acts_firmware installs."""

from __future__ import annotations

import os
from pathlib import Path

from acts_core.errors import SettingsError


def library_path(name: str) -> Path:
    """Path of an installed library of acts_firmware.

    Parameters
    ----------
    name : str
        Name of its file.

    Raises
    ------
    SettingsError
        When it is not built.
    """
    prefixes = [Path(prefix) for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(":") if prefix]
    path = next((p for prefix in prefixes if (p := prefix / "lib" / name).is_file()), None)
    if path is None:
        raise SettingsError(f"{name} of package acts_firmware is in none of {prefixes}: build the workspace")
    return path
