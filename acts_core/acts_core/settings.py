# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings as dataclasses: every field carries its description and range, and is checked when it is set.

A settings class is a frozen dataclass whose fields are made by `setting`::

    @dataclass(frozen=True)
    class EstimatorConfig:
        touch_counts: int = setting(60, "counts above which a taxel is pressed", minimum=0, maximum=1023)

        def __post_init__(self) -> None:
            validate(self)

`from_mapping` builds one from a plain mapping (a YAML section, ROS parameters) and refuses unknown keys.
"""

from __future__ import annotations

import dataclasses
import difflib
import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import suppress
from decimal import ROUND_CEILING, Context, Decimal
from enum import Enum
from typing import Any, TypeVar, cast

import yaml

from acts_core.errors import SettingsError
from acts_core.yaml_values import YamlLoader

T = TypeVar("T")

SettingValue = bool | int | float | str | tuple[float, ...] | tuple[str, ...]

POWER_RULE = "1e-3 and 1.0e3 are text in YAML, write 1.0e-3 and 1.0e+3"
"""How YAML wants numbers with an exponent, for messages: with a point and with a sign."""

TEXT_RULE = "in YAML, on, off, yes, no, true, false and numbers are text in quotes only, as in 'on'"
"""How YAML wants text that it would take for something else, for messages."""

_METADATA_KEY = "acts_setting"


class Changeable(Enum):
    """When a setting may be changed, as a parameter of a node."""

    AT_START = "at the start"
    UNCONFIGURED = "unconfigured"
    """Where the node has a life cycle: while it is unconfigured, before it is configured or after cleanup."""
    RUNNING = "running"


@dataclasses.dataclass(frozen=True)
class SettingInfo:
    """What is known of one setting besides its name and default.

    Attributes
    ----------
    description : str
        One sentence for a person, as shown by ``ros2 param describe``.
    minimum, maximum : float or None
        Allowed range, both ends included.
    choices : tuple of str
        Allowed words; empty for any.
    length : int or None
        Required number of elements of a sequence.
    changeable : Changeable
        When it may be changed.
    """

    description: str
    minimum: float | None = None
    maximum: float | None = None
    choices: tuple[str, ...] = ()
    length: int | None = None
    changeable: Changeable = Changeable.AT_START

    @property
    def allowed(self) -> str:
        """The constraint in words, empty where anything is allowed."""
        words = []
        if self.choices:
            words.append("one of " + ", ".join(choice or "empty" for choice in self.choices))
        if self.minimum is not None and self.maximum is not None:
            words.append(f"{_number(self.minimum)} to {_number(self.maximum)}")
        elif self.minimum is not None:
            words.append(f"{_number(self.minimum)} or more")
        elif self.maximum is not None:
            words.append(f"{_number(self.maximum)} or less")
        if self.length is not None:
            words.append(f"{self.length} values")
        return ", ".join(words)


def _number(value: float) -> str:
    # Whole numbers in full: 9.22337e+18 is none that one could enter.
    return str(value) if isinstance(value, int) else f"{value:g}"


def rounded_up(value: float) -> str:
    """A lower limit for a person, of four digits and never below `value`: what is set to it is allowed."""
    return f"{Decimal(repr(value)).normalize(Context(prec=4, rounding=ROUND_CEILING)):f}"


def setting(
    default: Any,
    description: str,
    *,
    minimum: float | None = None,
    maximum: float | None = None,
    choices: Sequence[str] = (),
    length: int | None = None,
    changeable: Changeable = Changeable.AT_START,
) -> Any:
    """Make a dataclass field with a default, a description and constraints (see `SettingInfo`)."""
    info = SettingInfo(description, minimum, maximum, tuple(choices), length, changeable)
    return dataclasses.field(default=default, metadata={_METADATA_KEY: info})


def describe(settings_class: type) -> dict[str, SettingInfo]:
    """The settings of a dataclass by name, in order of definition; fields not made by `setting` are left out."""
    return {
        field.name: field.metadata[_METADATA_KEY]
        for field in dataclasses.fields(settings_class)
        if _METADATA_KEY in field.metadata
    }


def default_of(settings_class: type, name: str) -> SettingValue:
    """Default of one setting.

    Raises
    ------
    SettingsError
        The class has no setting of that name.
    """
    for field in dataclasses.fields(settings_class):
        if field.name == name:
            return cast(SettingValue, field.default)
    raise SettingsError(f"{settings_class.__name__} has no setting {name!r}")


def validate(settings: Any) -> None:
    """Check every setting of a dataclass instance.

    Raises
    ------
    SettingsError
        Naming the setting, what was given and what is allowed.
    """
    for name, info in describe(type(settings)).items():
        checked(name, getattr(settings, name), default_of(type(settings), name), info)


def checked(name: str, value: Any, default: SettingValue, info: SettingInfo) -> SettingValue:
    """Return `value` in the type of `default`, or raise `SettingsError` where type or range do not fit."""
    try:
        converted = _converted(value, default)
    except (TypeError, ValueError, OverflowError):
        raise _error(name, value, f"a value of type {_type_name(default)}{_hint(value, default)}", info) from None
    if info.choices and converted not in info.choices:
        raise _error(name, value, "", info)
    if info.length is not None and len(cast(Sequence[Any], converted)) != info.length:
        raise _error(name, value, "", info)
    numbers: Sequence[Any] = converted if isinstance(converted, tuple) else (converted,)
    for number in numbers:
        if not _is_number(number):
            continue
        # Not asked of whole numbers: they always are, and one of 400 digits is no float.
        if isinstance(number, float) and not math.isfinite(number):
            raise _error(name, value, "a finite number", info)
        if (info.minimum is not None and number < info.minimum) or (info.maximum is not None and number > info.maximum):
            raise _error(name, value, "", info)
    return converted


def from_text(settings_class: type, name: str, text: str) -> SettingValue:
    """The value of one setting as a person writes it on a command line: words as they stand, all else as in YAML.

    Beyond YAML, 1e-3 is a number, and a list needs no brackets: ``1, 2`` or ``1 2``.

    Raises
    ------
    SettingsError
        Where type or range do not fit.
    """
    default = default_of(settings_class, name)
    value: Any = text
    if isinstance(default, tuple) and not text.lstrip().startswith("["):
        value = [_from_yaml(word) for word in text.replace(",", " ").split()]
    elif not isinstance(default, str):
        value = _from_yaml(text)
    return checked(name, value, default, describe(settings_class)[name])


def _from_yaml(text: str) -> Any:
    try:
        value = yaml.load(text, YamlLoader)
    except (yaml.YAMLError, ValueError, RecursionError):
        # ValueError: a time stamp such as 2024-13-45, or see `YamlLoader`.
        return text
    if isinstance(value, str):
        with suppress(ValueError):
            return float(value)
    return value


def _converted(value: Any, default: SettingValue) -> SettingValue:
    """`value` in the type of `default`; raises TypeError, ValueError or OverflowError where it has no such value."""
    if isinstance(default, tuple):
        if isinstance(value, str) or not isinstance(value, Sequence):
            raise TypeError
        # A list of numbers is one of floats, also where the default holds whole ones, or none.
        of_each = "" if default and isinstance(default[0], str) else 0.0
        return tuple(cast(Any, _converted(item, of_each)) for item in value)
    if isinstance(default, (bool, str)):
        if not isinstance(value, bool if isinstance(default, bool) else str):
            raise TypeError
        return cast(SettingValue, value)
    if not _is_number(value) or (isinstance(default, int) and value != int(value)):
        raise TypeError
    return int(value) if isinstance(default, int) else float(value)


def _is_number(value: object) -> bool:
    """Whether it is one; Python takes a bool for a whole number, too."""
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _is_power(value: Any) -> bool:
    """Whether it is a text such as 1e-3, which YAML 1.1 does not take for a number."""
    return isinstance(value, str) and re.fullmatch(r"[-+]?\d+(\.\d*)?[eE][-+]?\d+", value) is not None


def _hint(value: Any, default: SettingValue) -> str:
    """How what was given is written in YAML so as to be taken for what was meant; empty where that is not known."""
    if isinstance(default, float) and _is_power(value):
        return f" ({POWER_RULE})"
    return f" ({TEXT_RULE})" if isinstance(default, str) and isinstance(value, (bool, int, float)) else ""


def _type_name(default: SettingValue) -> str:
    if isinstance(default, tuple):
        return "list of words" if default and isinstance(default[0], str) else "list of numbers"
    return {bool: "true/false", int: "whole number", float: "number", str: "text"}[type(default)]


def _error(name: str, value: Any, wanted: str, info: SettingInfo) -> SettingsError:
    allowed = ", ".join(part for part in (wanted, info.allowed) if part)
    return SettingsError(f"{name} = {value!r}: allowed is {allowed} ({info.description})")


def unknown_key_message(key: str, known: Sequence[str], where: str) -> str:
    """Words for a key that does not exist, with the nearest one that does."""
    near = difflib.get_close_matches(key, known, n=1)
    hint = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(known)}"
    return f"{where}: unknown key {key!r}; {hint}"


def is_given(text: str) -> bool:
    """Whether the text of a setting names a thing: an empty one does not, nor ``none``.

    Launch files write ``none``, because they cannot give an empty text.
    """
    return text not in ("", "none")


def from_mapping(settings_class: type[T], values: Mapping[str, Any], where: str = "settings") -> T:
    """Build a settings dataclass from a mapping; keys that are missing keep their defaults.

    Raises
    ------
    SettingsError
        For an unknown key (with the nearest known one), a wrong type or a value out of range.
    """
    infos = describe(settings_class)
    for key in values:
        if key not in infos:
            raise SettingsError(unknown_key_message(str(key), list(infos), where))
    arguments = {
        name: checked(name, values[name], default_of(settings_class, name), info)
        for name, info in infos.items()
        if name in values
    }
    return settings_class(**arguments)


def refuse_doubles(*settings_classes: type, common: type | None = None) -> None:
    """Refuse settings classes of which two have a setting of one name: one parameter would set both.

    Parameters
    ----------
    *settings_classes : type
        Dataclasses of `setting` fields.
    common : type or None
        Base class whose settings several of them may have.

    Raises
    ------
    SettingsError
        Naming the setting.
    """
    shared = describe(common) if common is not None else {}
    names = Counter(name for one in settings_classes for name in describe(one) if name not in shared)
    for name, number in names.items():
        if number > 1:
            raise SettingsError(f"parameter {name!r} is declared {number} times: begin it with the name of its thing")


def part_of(settings_class: type[T], settings: object) -> T:
    """A settings dataclass out of an object that has all its settings among others, as the parameters of a node."""
    return settings_class(**{name: getattr(settings, name) for name in describe(settings_class)})
