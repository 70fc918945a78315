# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""YAML files with the line of every key, so that an error can name the place; a key given twice is an error."""

from __future__ import annotations

import math
import reprlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from acts_core.errors import SettingsError
from acts_core.files.regular_file import read_text
from acts_core.names import RULE
from acts_core.settings import POWER_RULE, unknown_key_message
from acts_core.transforms import Quaternion, Transform, Vector
from acts_core.yaml_values import YamlLoader

# Deeper than any file that is read by this; what lies below goes by the line of what holds it.
_MAX_DEPTH = 5
# So much is parsed in a few seconds; a file of a hundred skins has a tenth of it.
_BYTES_MAX = 1 << 18
# A whole turn and a rounding of it. More is most likely meant in degrees.
_LARGEST_ANGLE_RAD = 2 * math.pi + 1e-3

Keys = tuple[object, ...]


@dataclass(frozen=True)
class Section:
    """A mapping in a YAML file, and where it stands.

    Attributes
    ----------
    path : Path
        The file.
    values : mapping
        As in the file.
    what : str
        What it is about, for error messages, such as ``skin left_arm``.
    """

    path: Path
    values: Mapping[str, Any]
    what: str
    _keys: Keys
    _lines: Mapping[Keys, int]

    def error(self, message: str, key: str | None = None) -> SettingsError:
        """An error that begins with file, line and what the section is about; `key`: the key whose line it is."""
        keys = self._keys if key is None else (*self._keys, key)
        # What an alias or a merge key brings has no line of its own: that of the mapping around it.
        around = (keys[:n] for n in range(len(keys), -1, -1))
        line = next((self._lines[place] for place in around if place in self._lines), 1)
        about = f"{self.what}: " if self.what else ""
        return SettingsError(f"{self.path}:{line}: {about}{message}")

    def check_keys(self, known: Sequence[str]) -> None:
        """Refuse keys that are not known, with the nearest one that is."""
        for key in self.values:
            if key not in known:
                raise self.error(unknown_key_message(str(key), list(known), "keys"), key)

    def section(self, key: str, what: str) -> Section:
        """The mapping below a key; empty where the key is missing or has no value."""
        values = self.values.get(key)
        inner = Section(self.path, {} if values is None else values, what, (*self._keys, key), self._lines)
        if not isinstance(inner.values, Mapping):
            raise self.error(f"{key} = {shown(values)}: needed is a mapping of names to values", key)
        return inner

    def sections(self, key: str, what: str) -> list[Section]:
        """The mappings below a key that holds one of them, or a list."""
        values = self.values.get(key)
        if not isinstance(values, list):
            return [self.section(key, what)]
        inner = [Section(self.path, value, what, (*self._keys, key, i), self._lines) for i, value in enumerate(values)]
        for section in inner:
            if not isinstance(section.values, Mapping):
                raise section.error(f"{key} has {shown(section.values)}: needed is a mapping of names to values")
        return inner

    def text(self, key: str, default: str | None = None) -> str | None:
        """The text at a key."""
        value = self.values.get(key)
        if value is None:
            return default
        if not isinstance(value, str):
            raise self.error(f"{key} = {shown(value)}: allowed is text; put it in quotes", key)
        if not value.strip():
            raise self.error(f"{key} = {shown(value)}: allowed is text that is not empty; or leave {key} out", key)
        return value.strip()

    def one_of(self, key: str, known: Iterable[str]) -> str:
        """The text at a key, which has to be given and one of those known."""
        text, allowed = self.text(key), list(known)
        if text is None:
            raise self.error(f"{key} is missing", key)
        if text not in allowed:
            raise self.error(f"{key} = {text!r}: allowed is one of {', '.join(sorted(allowed))}", key)
        return text

    def flag(self, key: str) -> bool | None:
        """What is at a key, true or false; None where it is missing."""
        value = self.values.get(key)
        if value is not None and not isinstance(value, bool):
            raise self.error(f"{key} = {shown(value)}: allowed is true or false", key)
        return value

    def whole(self, key: str, default: int | None = None) -> int:
        """The whole number at a key; without a default it has to be given."""
        value = self.values.get(key, default)
        if isinstance(value, bool) or not isinstance(value, int):
            raise self.error(f"{key} = {shown(value)}: needed is a whole number", key)
        return value

    def number(self, key: str, default: float | None = None, highest: float = math.inf, unit: str = "") -> float:
        """The finite number at a key; without a default it has to be given.

        Parameters
        ----------
        key : str
        default : float or None
        highest : float
            Where it is given, the number has to be above 0, too.
        unit : str
            For the message, such as ``" [m]"``.
        """
        value: Any = self.values.get(key, default)
        if not is_number(value):
            allowed = "needed is a finite number"
        elif highest < math.inf and not 0.0 < value <= highest:
            allowed = f"allowed is a number above 0 to {highest}"
        else:
            return float(value)
        raise self.error(f"{key} = {shown(value)}: {allowed}{unit}", key)

    def names(self, is_allowed: Callable[[object], bool], what: str) -> list[str]:
        """All keys, which are names of something, such as ``skin``; `is_allowed` is of `acts_core.names`."""
        for name in self.values:
            if not is_allowed(name):
                raise self.error(
                    f"{what} {shown(name)}: the name of a {what} {RULE} (no, yes, on and off in quotes)", str(name)
                )
        return list(self.values)

    def numbers(self, key: str, default: tuple[float, ...]) -> tuple[float, ...]:
        """As many finite numbers as `default` has."""
        given = self.values.get(key, default)
        if not isinstance(given, (list, tuple)) or len(given) != len(default) or not all(map(is_number, given)):
            raise self.error(
                f"{key} = {shown(given)}: allowed are {len(default)} finite numbers, such as [0.1, 0, -1.5e-3] "
                f"({POWER_RULE})",
                key,
            )
        return tuple(float(number) for number in given)

    def transform(self) -> Transform:
        """What the keys position_m and rpy_rad or quaternion_xyzw say."""
        if "rpy_rad" in self.values and "quaternion_xyzw" in self.values:
            raise self.error("rpy_rad and quaternion_xyzw: give one of them", "quaternion_xyzw")
        position_m: Vector = self.numbers("position_m", (0.0, 0.0, 0.0))  # type: ignore[assignment]
        rpy_rad: Vector = self.numbers("rpy_rad", (0.0, 0.0, 0.0))  # type: ignore[assignment]
        if any(abs(angle) > _LARGEST_ANGLE_RAD for angle in rpy_rad):
            raise self.error(
                f"rpy_rad = {shown(list(rpy_rad))}: allowed are angles up to a whole turn, -6.2832 to 6.2832; they are "
                "in radians, and 90 degrees are 1.5708",
                "rpy_rad",
            )
        quaternion: Quaternion = self.numbers("quaternion_xyzw", (0.0, 0.0, 0.0, 1.0))  # type: ignore[assignment]
        try:
            if "quaternion_xyzw" in self.values:
                return Transform(position_m, quaternion)
            return Transform.from_rpy(position_m, rpy_rad)
        except SettingsError as error:
            raise self.error(str(error), "quaternion_xyzw" if "quaternion_xyzw" in self.values else None) from None


def is_number(value: object) -> bool:
    """Whether a value of a YAML file is a finite number."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    # One of 400 digits is no float.
    return abs(value) < 1e300 and math.isfinite(value)


def shown(value: object) -> str:
    """A value of a YAML file for a message: shortened, for with aliases a short file can hold very long ones."""
    return reprlib.repr(value)


def read_yaml(path: Path) -> Section:
    """Read a YAML file whose top level is a mapping.

    Raises
    ------
    SettingsError
        When it cannot be read, is not YAML, gives a key twice, or is no mapping; with file and line.
    """
    text = read_text(path, error=SettingsError, hint="give an existing YAML file", limit_bytes=_BYTES_MAX)
    lines: dict[Keys, int] = {}
    try:
        loader = YamlLoader(text)
        try:
            node = loader.get_single_node()
            if node is not None:
                _note_lines(path, node, (), lines, set())
            values = None if node is None else loader.construct_document(node)
        finally:
            loader.dispose()
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        # ValueError: a time stamp such as 2024-13-45, or see `YamlLoader`.
        raise SettingsError(f"{path}: not valid YAML: {error}") from error
    if not isinstance(values, dict):
        raise SettingsError(f"{path}: the top level must be a mapping of names to values")
    return Section(path, values, "", (), lines)


def _note_lines(path: Path, node: yaml.Node, keys: Keys, lines: dict[Keys, int], seen: set[int]) -> None:
    lines.setdefault(keys, node.start_mark.line + 1)
    # What an alias repeats goes by the line of the alias: with aliases in aliases there is no end to it.
    if len(keys) >= _MAX_DEPTH or id(node) in seen:
        return
    seen.add(id(node))
    if isinstance(node, yaml.SequenceNode):
        for i, item in enumerate(node.value):
            _note_lines(path, item, (*keys, i), lines, seen)
    if not isinstance(node, yaml.MappingNode):
        return
    given: set[str] = set()
    for key_node, value_node in node.value:
        if not isinstance(key_node, yaml.ScalarNode):
            continue
        key, line = str(key_node.value), key_node.start_mark.line + 1
        if key in given:
            raise SettingsError(f"{path}:{line}: the key {key!r} is given twice")
        given.add(key)
        place = (*keys, key)
        lines[place] = line
        _note_lines(path, value_node, place, lines, seen)
