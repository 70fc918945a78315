# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A temporary installation prefix with packages that a test makes up."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from acts_tools.launch.evaluate import Plan


@dataclass(frozen=True)
class Prefix:
    """An ament prefix below a temporary folder."""

    path: Path

    def script(self, name: str, text: str, package: str = "fake") -> Path:
        """Install an executable of a package."""
        return self._write(self.path / "lib" / package / name, text, package, 0o755)

    def python(self, name: str, text: str, package: str = "fake") -> Path:
        """Install a Python program as an executable of a package."""
        return self.script(name, f"#!/usr/bin/env python3\n{text}", package)

    def launch(self, name: str, body: str, package: str = "fake") -> Path:
        """Install a launch file of a package; `body` is what stands inside of the launch tag."""
        return self.share(f"launch/{name}", f"<launch>\n{body}\n</launch>", package)

    def share(self, name: str, text: str, package: str = "fake") -> Path:
        """Install a file in a package's share folder."""
        return self._write(self.path / "share" / package / name, text, package, 0o644)

    def _write(self, path: Path, text: str, package: str, mode: int) -> Path:
        index = self.path / "share/ament_index/resource_index/packages" / package
        index.parent.mkdir(parents=True, exist_ok=True)
        index.touch()
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(mode)
        return path


Launch = Callable[..., Plan]
"""Evaluates the body of a launch file."""


def words(plan: Plan) -> list[list[str]]:
    """Arguments of every process, without the program."""
    return [list(process.command[1:]) for process in plan.processes]
