# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Interface of the checks to the machine: files, limits and environment, which tests can replace."""

from __future__ import annotations

import grp
import os
import resource
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from acts_core.errors import SettingsError
from acts_core.runtime import parse_cores

_CPU_SETSIZE = 1024


@dataclass(frozen=True)
class Space:
    """Size of a file system.

    Attributes
    ----------
    total_bytes, free_bytes : int
    """

    total_bytes: int
    free_bytes: int


def _space(path: Path) -> Space:
    status = os.statvfs(path)
    return Space(status.f_blocks * status.f_frsize, status.f_bavail * status.f_frsize)


def _group_names() -> frozenset[str]:
    names = set()
    for number in {os.getegid(), *os.getgroups()}:
        try:
            names.add(grp.getgrgid(number).gr_name)
        except KeyError:
            names.add(str(number))
    return frozenset(names)


@dataclass(frozen=True)
class Machine:
    """Sources of the checks.

    Attributes
    ----------
    root : Path
        Folder that stands for ``/``.
    environment : mapping of str to str
        Environment variables.
    limit : callable
        Function from a resource's number to its soft and hard limit.
    groups : frozenset of str
        Names of the groups of this process.
    may_use : callable
        Function that returns whether a file may be read and written.
    space : callable
        Function from a path to the size of its file system.
    """

    root: Path = Path("/")
    environment: Mapping[str, str] = field(default_factory=lambda: os.environ)
    limit: Callable[[int], tuple[int, int]] = resource.getrlimit
    groups: frozenset[str] = field(default_factory=_group_names)
    may_use: Callable[[Path], bool] = lambda path: os.access(path, os.R_OK | os.W_OK)
    space: Callable[[Path], Space] = _space

    def text(self, path: str) -> str | None:
        """Content of a file without surrounding blanks; None where it cannot be read."""
        try:
            return (self.root / path).read_text(errors="replace").strip()
        except OSError:
            return None

    def number(self, path: str) -> int | None:
        """The integer in a file; None where there is none."""
        try:
            return int(self.text(path) or "")
        except ValueError:
            return None

    def found(self, pattern: str) -> list[Path]:
        """Sorted paths below the root that match a pattern; empty where the folder cannot be read."""
        try:
            return sorted(self.root.glob(pattern))
        except OSError:
            return []

    def status(self, key: str) -> str | None:
        """A line of ``/proc/self/status``, such as ``CapEff``."""
        for line in (self.text("proc/self/status") or "").splitlines():
            name, _, value = line.partition(":")
            if name == key:
                return value.strip()
        return None

    def has_capability(self, number: int) -> bool:
        """Whether this process has a capability, by its number in ``linux/capability.h``."""
        try:
            return bool(int(self.status("CapEff") or "0", 16) >> number & 1)
        except ValueError:
            return False

    def cores(self) -> frozenset[int] | None:
        """The cores that this process may run on; None where that is unknown."""
        try:
            return parse_cores(self.status("Cpus_allowed_list") or "", range(_CPU_SETSIZE)) or None
        except SettingsError:
            return None

    def control_group(self, controller: str) -> str | None:
        """Folder of this process's control group, relative to the root; None where there is none.

        Parameters
        ----------
        controller : str
            Controller of version 1, such as ``cpu``; empty for version 2.
        """
        for line in (self.text("proc/self/cgroup") or "").splitlines():
            _, controllers, path = [*line.split(":", 2), "", ""][:3]
            if controller in controllers.split(","):
                folder = "sys/fs/cgroup" + (f"/{controller}" if controller else "")
                return folder + path.rstrip("/")
        return None
