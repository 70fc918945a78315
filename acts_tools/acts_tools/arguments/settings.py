# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings given as options of their own, and as words ``NAME=VALUE``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any

from acts_core.errors import SettingsError
from acts_core.settings import SettingValue, default_of, describe, from_text, unknown_key_message
from acts_tools.arguments.numbers import checked_later


def add_settings(parser: argparse.ArgumentParser, settings_class: type, *names: str, **defaults: SettingValue) -> None:
    """Add an option for each setting of a class; `acts_core.settings.part_of` makes the settings of the arguments.

    Parameters
    ----------
    parser : argparse.ArgumentParser
    settings_class : type
        Dataclass of settings, which checks their ranges.
    *names : str
        Only these settings; all without any.
    **defaults
        In place of those of the class.
    """
    for name, info in describe(settings_class).items():
        if names and name not in names:
            continue
        default = defaults.get(name, default_of(settings_class, name))
        parser.add_argument(
            f"--{name.replace('_', '-')}",
            type=checked_later(type(default), info.allowed),
            default=default,
            metavar="X",
            help=f"{info.description} (default: {'none' if default == '' else '%(default)s'})",
        )


def name_and_value(word: str, known: Sequence[str], where: str) -> tuple[str, str]:
    """The parts of a word ``NAME=VALUE``, whose name is one of those that are `known`.

    Raises
    ------
    SettingsError
        It is another one, or a part is missing; `where` says what the settings are of.
    """
    name, equals, text = word.partition("=")
    if name and name not in known:
        raise SettingsError(unknown_key_message(name, list(known), where))
    if not (name and equals):
        raise SettingsError(f"'{word}': needed is NAME=VALUE")
    return name, text


def given_settings(settings_class: type, words: Sequence[str], where: str) -> dict[str, Any]:
    """Read settings of a class; the last of a name counts.

    Parameters
    ----------
    settings_class : type
        Dataclass of settings.
    words : sequence of str
        Each ``NAME=VALUE``.
    where : str
        What the settings are of, for the message, such as "settings of the hand".

    Raises
    ------
    SettingsError
        For a word that is none of these, a name that there is not, or a value out of range.
    """
    given: dict[str, Any] = {}
    for word in words:
        name, text = name_and_value(word, list(describe(settings_class)), where)
        given[name] = from_text(settings_class, name, text)
    return given
