# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A ROS message as YAML, for reading."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import yaml

LONGEST_LIST = 128
"""Of longer lists the first elements are shown, as `ros2 topic echo` does."""

_ENDLESS = float("inf")


def message_text(message: Any) -> str:
    """All fields of a message, one a line; those that have fields of their own are indented, or in braces.

    Parameters
    ----------
    message : message
        Of any type.

    Returns
    -------
    str
        YAML, with a newline at the end. A float32 has 7 digits. In place of what is left out of a list of more than
        `LONGEST_LIST` elements is the text ``... 1024 in all``.
    """
    return yaml.safe_dump(
        _fields(message), sort_keys=False, default_flow_style=None, width=_ENDLESS, allow_unicode=True
    )


def _fields(message: Any) -> dict[str, Any]:
    kinds: dict[str, str] = message.get_fields_and_field_types()
    return {name: _value(getattr(message, name), kind) for name, kind in kinds.items()}


def _value(value: Any, kind: str) -> Any:
    if hasattr(value, "get_fields_and_field_types"):
        return _fields(value)
    if isinstance(value, bytes):
        return value[0]  # a `byte`, such as the level of a diagnostic status
    if isinstance(value, float):
        return float(f"{value:.7g}") if kind.startswith(("float", "sequence<float")) else value
    if isinstance(value, str | int):
        return value
    return _list(value, kind)


def _list(values: Any, kind: str) -> list[Any]:
    shown: Sequence[Any] = values[:LONGEST_LIST]
    shown = shown.tolist() if hasattr(shown, "tolist") else shown
    texts = [_value(value, kind) for value in shown]
    return texts if len(values) == len(shown) else [*texts, f"... {len(values)} in all"]
