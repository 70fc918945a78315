# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A digest of what the numbers of figures are computed by, so that those of another state of the code are not kept."""

from __future__ import annotations

import hashlib
import importlib.util
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path

from acts_core.errors import SettingsError
from acts_tools.firmware import board_sampler, board_times
from acts_tools.firmware.library import library_path

PACKAGES = ("acts_core", "acts_recon", "acts_sim", "acts_control", "acts_tools")
"""Packages that compute numbers of figures; the shipped dictionary is in one of them."""

LIBRARIES = (board_sampler.LIBRARY, board_times.LIBRARY)

_ENDINGS = (".py", ".npz", ".yaml")


@cache
def code_digest() -> str:
    """Digest of all files of `PACKAGES`, but for those that only draw, and of the firmware's `LIBRARIES`.

    It is computed once: a program goes on with the modules that it has imported.
    """
    found = hashlib.sha256()
    for name, path in _files():
        content = path.read_bytes()
        found.update(f"{name} {len(content)}\n".encode())
        found.update(content)
    return found.hexdigest()[:16]


def _files() -> Iterator[tuple[str, Path]]:
    """All of these files, each with its name."""
    for package in PACKAGES:
        spec = importlib.util.find_spec(package)
        for folder in map(Path, (spec and spec.submodule_search_locations) or ()):
            for path in sorted(folder.rglob("*")):
                name = f"{package}/{path.relative_to(folder).as_posix()}"
                if path.suffix in _ENDINGS and not name.startswith("acts_tools/figures/drawing/"):
                    yield name, path
    for name in LIBRARIES:
        # A figure that needs one that is not built says so itself.
        with suppress(SettingsError):
            yield name, library_path(name)
