# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Values of `param` tags, with types from YAML or the `type` attribute, as in launch_ros."""

from __future__ import annotations

from typing import TypeAlias

import yaml

from acts_core.errors import LaunchError
from acts_core.yaml_values import YamlLoader
from acts_tools.launch import substitutions
from acts_tools.launch.substitutions import Scope, Template

Scalar: TypeAlias = "bool | int | float | str"
Content: TypeAlias = "Template | bool | int | float | list[Template | bool | int | float]"
"""A value before substitution: all text is a template."""

_SCALARS: dict[str, type] = {"str": str, "bool": bool, "int": int, "float": float}
_LISTS = {f"list_of_{name}": name for name in _SCALARS}
TYPE_NAMES = (*_SCALARS, *_LISTS, "yaml")
"""Allowed values of the `type` attribute."""


def read(text: str, type_name: str | None) -> Content:
    """Read the value of a parameter in the file.

    Parameters
    ----------
    text : str
        The attribute, with substitutions.
    type_name : str or None
        One of `TYPE_NAMES`; None and "yaml" leave the type to YAML, so that ``123`` is an int.

    Raises
    ------
    LaunchError
        The value cannot be of the type, whatever the values of its substitutions.
    """
    value = _coerce(text, type_name, embedded=True)
    if isinstance(value, list):
        content = [substitutions.parse(item) if isinstance(item, str) else item for item in value]
        wanted = _LISTS.get(type_name or "")
        if wanted is not None and any(_is_plain_text(item) and wanted != "str" for item in content):
            raise _mismatch(text, type_name)
        return content
    if isinstance(value, str):
        template = substitutions.parse(value)
        if type_name in _SCALARS and type_name != "str" and _is_plain_text(template):
            raise _mismatch(text, type_name)
        return template
    return value


def evaluate(content: Content, type_name: str | None, scope: Scope) -> Scalar | list[Scalar]:
    """The value of a parameter after substitution.

    Raises
    ------
    LaunchError
        A substitution fails, or its value is not of the type.
    """
    if isinstance(content, list):
        item_type = _LISTS.get(type_name or "")
        items: list[Scalar] = []
        for item in content:
            if isinstance(item, tuple):
                text = substitutions.perform(item, scope)
                # YAML has already given a type to text of the file itself.
                value = text if _is_plain_text(item) else coerce(text, item_type)
                if isinstance(value, list):
                    raise _mismatch(text, type_name)
                items.append(value)
            else:
                items.append(item)
        if len({type(item) for item in items}) > 1:
            raise LaunchError(f"Expected a sequence with items of uniform type, got {items}")
        return items
    if not isinstance(content, tuple):
        return content
    text = substitutions.perform(content, scope)
    return text if _is_plain_text(content) else coerce(text, type_name)


def coerce(text: str, type_name: str | None) -> Scalar | list[Scalar]:
    """Convert text to a type.

    Parameters
    ----------
    text : str
        Text after substitution.
    type_name : str or None
        One of `TYPE_NAMES`; None as "yaml".

    Raises
    ------
    LaunchError
        The text is not of the type.
    """
    return _coerce(text, type_name, embedded=False)


def _coerce(text: str, type_name: str | None, embedded: bool) -> Scalar | list[Scalar]:
    """With `embedded`, text of another type is kept, because its substitutions may still give the right type."""
    if type_name is None or type_name == "yaml":
        return _yaml(text, type_name, embedded)
    if type_name in _LISTS:
        value = _yaml(text, type_name, embedded)
        allowed = (_SCALARS[_LISTS[type_name]], *((str,) if embedded else ()))
        if not isinstance(value, list) or any(type(item) not in allowed for item in value):
            raise _mismatch(text, type_name)
        return value
    if type_name == "str":
        return text
    if type_name in ("int", "float"):
        try:
            return int(text) if type_name == "int" else float(text)
        except ValueError as error:
            if embedded:
                return text
            raise _mismatch(text, type_name) from error
    value = _yaml({"1": "true", "0": "false"}.get(text, text), type_name, embedded)
    if isinstance(value, bool) or (embedded and isinstance(value, str)):
        return value
    raise _mismatch(text, type_name)


def _yaml(text: str, type_name: str | None, embedded: bool) -> Scalar | list[Scalar]:
    if not text:
        return text
    try:
        value = yaml.load(text, YamlLoader)
    except yaml.YAMLError as error:
        if embedded:
            return text
        raise _mismatch(text, type_name) from error
    except (ValueError, RecursionError) as error:
        # A time stamp such as 2024-13-45, or see `YamlLoader`; thousands of brackets. No substitution makes that right.
        raise _mismatch(text, type_name) from error
    if isinstance(value, list):
        kinds = {type(item) for item in value}
        if embedded:
            kinds -= {str}
        if len(kinds) <= 1 and kinds <= {bool, int, float, str}:
            return value
    elif isinstance(value, (bool, int, float, str)):
        return value
    raise _mismatch(text, type_name)


def _is_plain_text(item: object) -> bool:
    return isinstance(item, tuple) and substitutions.plain(item) is not None


def _mismatch(text: str, type_name: str | None) -> LaunchError:
    wanted = type_name or "yaml: a bool, int, float, str or a list of one of these"
    return LaunchError(f"Cannot convert value '{text}' to '{wanted}'")
