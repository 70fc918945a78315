# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""One run of `acts figures`: its seed and size, progress, and measurements that several figures share."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from acts_tools import __version__
from acts_tools.figures.digest import code_digest
from acts_tools.figures.files import read_stamped, write_stamped
from acts_tools.progress import Progress

SHARED = "shared"
"""Folder of what several figures share, in the folder of all files."""

_T = TypeVar("_T")


@dataclass
class Run:
    """What a figure is measured with.

    Attributes
    ----------
    out : Path
        Folder of all files.
    seed : int
        Of everything random.
    fast : bool
        Few presses, drops and measurement levels: a check that the figure can be made, with rough numbers.
    again : bool
        Measure even what is in a file.
    """

    out: Path
    seed: int = 1
    fast: bool = False
    again: bool = False
    _shared: dict[str, Any] = field(default_factory=dict, repr=False)

    def pick(self, full: _T, fast: _T) -> _T:
        """One of two sizes of a measurement."""
        return fast if self.fast else full

    def progress(self, title: str, total: int) -> Progress:
        """A progress bar of a measurement with `total` steps."""
        return Progress(title, max(total, 1))

    @property
    def settings(self) -> dict[str, Any]:
        """What all numbers depend on."""
        return {"version": __version__, "code": code_digest(), "seed": self.seed, "fast": self.fast}

    def command(self, name: str) -> str:
        """The command that makes a figure again."""
        return f"acts figures {name} --seed {self.seed}" + (" --fast" if self.fast else "")

    def shared(self, name: str, measure: Callable[[], Any]) -> Any:
        """A measurement that several figures are made of: plain numbers, from memory, from its file, or new.

        Parameters
        ----------
        name : str
            Its name, and that of its file in the folder `shared`.
        measure : callable
            ``measure()``: what can be written as JSON.
        """
        if name not in self._shared:
            path = self.out / SHARED / f"{name}.json"
            known = None if self.again else read_stamped(path, self.settings)
            if known is None:
                # Through JSON, so that a number is the same whether it was measured now or earlier.
                known = {"numbers": json.loads(json.dumps(measure()))}
                write_stamped(path, {"measurement": name, **self.settings, **known})
            self._shared[name] = known["numbers"]
        return self._shared[name]
