# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Find packages and their executables in the ament index, without importing ROS."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Mapping
from pathlib import Path, PurePath

from acts_core.errors import LaunchError

_INDEX = "share/ament_index/resource_index/packages"


def prefix(package: str, environment: Mapping[str, str]) -> Path:
    """Installation prefix of a package.

    Parameters
    ----------
    package : str
        Name of the package.
    environment : mapping of str to str
        ``AMENT_PREFIX_PATH`` in it is searched in order.

    Raises
    ------
    LaunchError
        There is no such package.
    """
    if re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]+", package) is None:
        raise LaunchError(f"'{package}' is not a valid package name")
    folders = [folder for folder in environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if folder]
    if not folders:
        raise LaunchError(
            f"package '{package}' not found: AMENT_PREFIX_PATH is empty. "
            "Enter the environment first (`./acts ...`, or source a ROS 2 workspace)."
        )
    for folder in folders:
        if (Path(folder) / _INDEX / package).is_file():
            return Path(folder)
    raise LaunchError(f"package '{package}' not found, searching: {folders}")


def share(package: str, environment: Mapping[str, str]) -> Path:
    """Share folder of a package: launch files, parameters, message definitions."""
    return prefix(package, environment) / "share" / package


def executable(package: str, name: str, environment: Mapping[str, str]) -> Path:
    """Path of an executable that a package installs in ``lib/<package>``.

    Raises
    ------
    LaunchError
        The package, its folder of executables, or the executable does not exist.
    """
    root = prefix(package, environment)
    folder = root / "lib" / package
    if not folder.is_dir():
        raise LaunchError(f"package '{package}' found at '{root}', but libexec directory '{folder}' does not exist")
    found = shutil.which(name, path=str(folder))
    if found is None:
        there = sorted(path.name for path in folder.iterdir() if os.access(path, os.X_OK) and path.is_file())
        raise LaunchError(
            f"executable '{name}' not found on the libexec directory '{folder}' (there: {', '.join(there) or 'none'})"
        )
    return Path(found)


def launch_file(package: str, name: str, environment: Mapping[str, str]) -> Path:
    """Path of a launch file anywhere in a package's share folder.

    Raises
    ------
    LaunchError
        There is none of this name, or more than one.
    """
    root = share(package, environment)
    # A name, or the end of a path below the share folder; what is neither, or looks like a pattern, is in none.
    wanted = PurePath(name).parts
    found = sorted(
        path for path in root.rglob("*") if path.relative_to(root).parts[-len(wanted) :] == wanted and path.is_file()
    )
    if len(found) == 1:
        return found[0]
    if found:
        paths = ", ".join(f"'{path}'" for path in found)
        raise LaunchError(
            f"file '{name}' was found more than once in the share directory of package '{package}': [{paths}]"
        )
    there = sorted(path.name for path in root.rglob("*.launch.xml"))
    raise LaunchError(
        f"file '{name}' was not found in the share directory of package '{package}' which is at '{root}' "
        f"(launch files there: {', '.join(there) or 'none'})"
    )
