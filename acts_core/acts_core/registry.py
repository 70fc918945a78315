# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What registries share: entering a thing by a decorator, looking it up by its name, and enumerations of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, MutableMapping
from enum import EnumMeta
from typing import TYPE_CHECKING, Any, TypeVar

from acts_core.errors import SettingsError

F = TypeVar("F")
T = TypeVar("T")


def registering(name: str, known: MutableMapping[str, T], what: str, thing: Callable[[F], T]) -> Callable[[F], F]:
    """A decorator of functions that enters a thing made of the function.

    Parameters
    ----------
    name : str
        Of the thing.
    known : mapping of str to object
        Where it is entered.
    what : str
        What it is, for the message.
    thing : callable
        From the function to the thing.

    Returns
    -------
    callable
        Raises `SettingsError` when there is a thing of this name already.
    """

    def enter(function: F) -> F:
        if name in known:
            raise SettingsError(f"{what} {name!r} is registered twice; choose another name")
        known[name] = thing(function)
        return function

    return enter


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
