# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What there is to know of a terminal, such as a serial port, before it is opened."""

from __future__ import annotations

import os
from pathlib import Path

_LINK_TOLERANCE_NS = 100_000_000
# /dev/ptmx, under whatever name (Documentation/admin-guide/devices.txt of Linux).
_MULTIPLEXER = os.makedev(5, 2)


def leads_to(path: str) -> str:
    """What a path leads to by links, as `os.path.realpath` tells, or the path itself.

    That raises an OSError where a link vanishes while it is looked at, as that of an adapter that is unplugged.
    """
    try:
        return os.path.realpath(path)
    except OSError:
        return str(Path(path).absolute())


def is_stale_link(path: str) -> bool:
    """Whether a link points to a pseudo-terminal that was made after it.

    A simulated board that was killed leaves its link behind, and its terminal's number soon belongs to somebody else,
    whose input would be taken.
    """
    target = leads_to(path)
    try:
        if not Path(path).is_symlink() or not target.startswith("/dev/pts/"):
            return False
        return Path(target).stat().st_ctime_ns > Path(path).lstat().st_mtime_ns + _LINK_TOLERANCE_NS
    except OSError:
        # Gone by now, or in a folder that is not ours to look into; opening tells.
        return False


def is_multiplexer(path: str) -> bool:
    """Whether opening a path would make a new pseudo-terminal, on which nobody ever writes."""
    try:
        return Path(path).stat().st_rdev == _MULTIPLEXER
    except OSError:
        # Opening tells.
        return False


def holders(path: str) -> list[str]:
    """Names and process numbers of the programs that have a port open, as far as this user may see."""
    device = leads_to(path)
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if int(process.name) != os.getpid() and any(
                os.path.realpath(link) == device for link in (process / "fd").iterdir()
            ):
                # Cut off after 15 bytes, perhaps within a letter.
                name = (process / "comm").read_bytes().decode(errors="replace").strip()
                found.append(f"{name} (process {process.name})")
        except OSError:
            # Another user's process, or one that has just ended.
            continue
    return sorted(found)
