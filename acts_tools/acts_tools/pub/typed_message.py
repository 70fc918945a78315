# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A ROS message from values that somebody has typed as YAML."""

from __future__ import annotations

import importlib
from contextlib import suppress
from typing import Any

import yaml
from builtin_interfaces.msg import Time
from rosidl_parser.definition import FLOATING_POINT_TYPES, AbstractNestedType, BasicType, NamespacedType
from std_msgs.msg import Header

from acts_core.errors import SettingsError
from acts_ros.messages import set_stamp
from acts_tools.running.near_names import did_you_mean

NOW, AUTO = "now", "auto"
"""In place of the fields of a time, and of a header: the time at which the message is made."""


def typed_values(text: str) -> dict[str, Any]:
    """Values by field; a ``---`` at the end, as `acts echo` prints it, does not count.

    Raises
    ------
    SettingsError
        The text is no YAML, or no mapping of fields.
    """
    try:
        values = yaml.safe_load(text.rstrip().removesuffix("---"))
    except yaml.YAMLError as error:
        raise SettingsError(f"the values are no YAML: {error}") from error
    if not isinstance(values, dict):
        raise SettingsError(f"values = {text!r}: allowed are fields with values, such as '{{x: 0.1, y: 0.2}}'")
    return values


def typed_message(kind: type, values: Any, now_ns: int, where: str = "") -> Any:
    """Make a message. Fields that are not named keep their defaults.

    Parameters
    ----------
    kind : type
        Of the message.
    values : dict, or `NOW` for a time, or `AUTO` for a header
        Values by field; those of a field that is a message in the same way.
    now_ns : int
        Time for `NOW` and `AUTO` [ns].
    where : str
        The field that it is for, for errors.

    Raises
    ------
    SettingsError
        A field does not exist, or cannot have its value.
    """
    message: Any = _checked(kind)
    if isinstance(message, Time) and values == NOW:
        set_stamp(message, now_ns)
        return message
    if isinstance(message, Header) and values == AUTO:
        set_stamp(message.stamp, now_ns)
        return message
    kinds: dict[str, str] = message.get_fields_and_field_types()
    if not isinstance(values, dict):
        raise SettingsError(f"{where} = {values!r}: allowed are values of {', '.join(kinds)}, in braces")
    for field, slot in zip(kinds, message.SLOT_TYPES, strict=True):
        if field not in values:
            continue
        path = f"{where}.{field}" if where else field
        value = _value(values[field], slot, now_ns, path)
        try:
            setattr(message, field, value)
        except (AssertionError, OverflowError, TypeError, ValueError) as error:
            raise SettingsError(f"{path} = {values[field]!r}: allowed is {kinds[field]}") from error
    for field in values:
        if field not in kinds:
            path = f"{where}.{field}" if where else str(field)
            near = did_you_mean(str(field), kinds)
            raise SettingsError(f"{path}: there is no such field, only {', '.join(kinds)}{near}")
    return message


def _checked(kind: Any) -> Any:
    """A message that refuses values which its fields cannot have."""
    try:
        return kind(check_fields=True)
    except AssertionError:
        return kind()  # of Humble, where all do


def _value(value: Any, slot: Any, now_ns: int, path: str) -> Any:
    """What the message takes in place of what YAML has made of the words; else the same, which it refuses."""
    if isinstance(slot, AbstractNestedType) and isinstance(value, list):
        return [_value(one, slot.value_type, now_ns, f"{path}[{number}]") for number, one in enumerate(value)]
    if isinstance(slot, NamespacedType):
        package, folder, name = slot.namespaced_name()
        return typed_message(getattr(importlib.import_module(f"{package}.{folder}"), name), value, now_ns, path)
    if isinstance(slot, BasicType) and not isinstance(value, bool):
        # To YAML 1 is no float, nor is 1e-3, which has no point.
        if slot.typename in FLOATING_POINT_TYPES and isinstance(value, int | str):
            with suppress(ValueError, OverflowError):
                return float(value)
        if slot.typename == "octet" and value in range(256):
            return bytes([value])
    return value
