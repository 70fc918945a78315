# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Enumerations whose members come out of a registry."""

from __future__ import annotations

from enum import EnumMeta
from typing import TYPE_CHECKING, Any


class FromRegistry(EnumMeta):
    """Metaclass of an enumeration of which a type checker cannot know the members."""

    if TYPE_CHECKING:

        def __getattr__(cls, name: str) -> Any: ...
