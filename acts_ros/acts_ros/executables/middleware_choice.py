# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A middleware that is chosen but not installed, told in words before ROS meets it."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from acts_core.errors import LaunchError, SettingsError
from acts_ros.processes import packages

_CHOICE = "RMW_IMPLEMENTATION"
_INDEX = "share/ament_index/resource_index/rmw_typesupport"
# Of the package that loads the others.
_NONE = "rmw_implementation"


def check_middleware(environment: Mapping[str, str]) -> None:
    """Check that the chosen middleware is installed; to be called before rclpy is imported, which ends the process.

    Raises
    ------
    SettingsError
        It is not; naming those that are.
    """
    chosen, path = environment.get(_CHOICE), environment.get("AMENT_PREFIX_PATH")
    if not (chosen and path):
        return
    try:
        packages.prefix(chosen, environment)
    except LaunchError:
        indices = [Path(folder) / _INDEX for folder in path.split(os.pathsep)]
        there = {file.name for index in indices if index.is_dir() for file in index.iterdir()} - {_NONE}
        raise SettingsError(
            f"{_CHOICE}={chosen}: that is not installed here, but {', '.join(sorted(there)) or 'none'}; install it, "
            "export another, or unset it for the default"
        ) from None
