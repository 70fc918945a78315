# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The figures by name.

To add one, write a module with ``FIGURES`` (see `acts_tools.figures.figure.Figure`), and name it here.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from acts_core.errors import SettingsError
from acts_tools.figures.board import force_response, frame_rates, on_board
from acts_tools.figures.control import hand, letters
from acts_tools.figures.events import bounces, ricochets, rotator, soft_bodies, wearables
from acts_tools.figures.figure import Figure
from acts_tools.figures.recovery import confusion, dictionaries, large_area, new_objects, recognition, support

_MODULES = (
    frame_rates,
    support,
    recognition,
    confusion,
    bounces,
    ricochets,
    soft_bodies,
    large_area,
    wearables,
    on_board,
    letters,
    hand,
    new_objects,
    dictionaries,
    force_response,
    rotator,
)

FIGURES: dict[str, Figure] = {figure.name: figure for module in _MODULES for figure in module.FIGURES}
"""All figures in the order in which they are drawn."""


def figures_named(names: Sequence[str]) -> list[Figure]:
    """Figures by name, upper or lower case, as 6A-C several of one number; all for no name.

    Raises
    ------
    SettingsError
        When there is none of a name.
    """
    known = {name.lower(): figure for name, figure in FIGURES.items()}
    found: list[Figure] = []
    for name in names:
        parts = [name.lower()] if name.lower() in known else _parts(name.lower())
        if not parts or any(part not in known for part in parts):
            raise SettingsError(f"figure {name!r}: allowed are {', '.join(FIGURES)}")
        found += [known[part] for part in parts]
    # A figure that is named twice is one figure.
    return list({figure.name: figure for figure in found}.values()) or list(FIGURES.values())


def _parts(name: str) -> list[str]:
    """6a, 6b, 6c of 6a-c; nothing of another name."""
    several = re.fullmatch(r"(\d+)([a-z])-([a-z])", name)
    if several is None:
        return []
    number, first, last = several.groups()
    return [f"{number}{chr(letter)}" for letter in range(ord(first), ord(last) + 1)]
