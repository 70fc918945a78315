# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Optional libraries for comparison; ACTS itself needs none of them."""

from __future__ import annotations

import importlib
import importlib.util
from types import ModuleType

SCIKIT_LEARN = ("sklearn", "scikit-learn")
SPAMS = ("spams", "spams-bin")


def peer(name: tuple[str, str], submodule: str = "") -> ModuleType | None:
    """A library (import name, name to install), or a module of it; None where it is not installed."""
    if importlib.util.find_spec(name[0]) is None:
        return None
    return importlib.import_module(f"{name[0]}.{submodule}" if submodule else name[0])


def missing(name: tuple[str, str]) -> str:
    """Text in place of a figure of a missing library."""
    return f"not installed: ./acts run pip install {name[1]}"
