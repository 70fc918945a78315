# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What registries share: looking a thing up by its name, and enumerations whose members are those of a registry."""

from __future__ import annotations

from collections.abc import Mapping
from enum import EnumMeta
from typing import TYPE_CHECKING, Any, TypeVar

from acts_core.errors import SettingsError

T = TypeVar("T")


def named(name: str, known: Mapping[str, T], what: str) -> T:
    """Look a thing up by its name.

    Parameters
    ----------
    name : str
    known : mapping of str to object
        Those that exist, by name.
    what : str
        What it is, for the message.

    Raises
    ------
    SettingsError
        There is none; the message names those that exist.
    """
    if name not in known:
        raise SettingsError(f"{what} {name!r} does not exist; known are {', '.join(known)}")
    return known[name]


class FromRegistry(EnumMeta):
    """Metaclass of an enumeration of which a type checker cannot know the members."""

    if TYPE_CHECKING:

        def __getattr__(cls, name: str) -> Any: ...
