# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Places in launch files, and errors that name them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from acts_core.errors import LaunchError


@dataclass(frozen=True)
class Place:
    """A file and line."""

    file: Path
    line: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}"


class PlacedError(LaunchError):
    """A launch error whose message starts with the place."""


@contextmanager
def located(place: Place) -> Iterator[None]:
    """Put a place before the message of a launch error without one; so the innermost place is kept."""
    try:
        yield
    except PlacedError:
        raise
    except LaunchError as error:
        raise PlacedError(f"{place}: {error}") from error
