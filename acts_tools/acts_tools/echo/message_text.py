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
        `LONGEST_LIST` elements is the text ``... 1024 in all``. A field that has one of the message's constants bears
        its name as a comment: ``state: 3  # STATE_BALANCING``.
    """
    fields = _fields(message)
    text = yaml.safe_dump(fields, sort_keys=False, default_flow_style=None, width=_ENDLESS, allow_unicode=True)
    lines = text.split("\n")
    for field, names in _constants(message).items():
        line = f"{field}: {fields[field]}"
        if fields[field] in names and line in lines:
            lines[lines.index(line)] = f"{line}  # {names[fields[field]]}"
    return "\n".join(lines)


def _constants(message: Any) -> dict[str, dict[int, str]]:
    """Names of the constants of each field of type uint8, by their values.

    A message does not say which field a constant is for. Here these are the ones that begin with the field's name, or
    all where there is one such field, unless two of them have the same value and so cannot be for the same field.
    """
    constants = {name: value for name, value in vars(type(message)).items() if name.isupper() and type(value) is int}
    fields = [name for name, kind in message.get_fields_and_field_types().items() if kind == "uint8"]
    found = {}
    for field in fields:
        own = [name for name in constants if len(fields) == 1 or name.startswith(f"{field.upper()}_")]
        names = {constants[name]: name for name in own}
        found[field] = names if len(names) == len(own) else {}
    return found


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
