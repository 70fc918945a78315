# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Options of a simulated program's command line: one for each setting of a dataclass."""

from __future__ import annotations

import argparse
from typing import TypeVar

from acts_core.settings import default_of, describe, from_text

T = TypeVar("T")


def add_settings(parser: argparse._ActionsContainer, settings_class: type) -> None:
    """Add an option for each setting: ``--lead-ms`` for ``lead_ms``. `settings_from` reads them.

    Parameters
    ----------
    parser : argparse.ArgumentParser or a group of its options
    settings_class : type
        A dataclass of `acts_core.settings.setting` fields.
    """
    for name, info in describe(settings_class).items():
        allowed = f" ({info.allowed})" if info.allowed else ""
        default = default_of(settings_class, name)
        otherwise = "" if default == "" else f"; {default}"
        text = f"{info.description}{allowed}{otherwise}".replace("%", "%%")
        parser.add_argument(f"--{name.replace('_', '-')}", dest=name, metavar="VALUE", help=text)


def settings_from(options: argparse.Namespace, settings_class: type[T]) -> T:
    """The settings that were given, and the defaults of the others.

    Raises
    ------
    SettingsError
        Where type or range of one do not fit.
    """
    given = {name: getattr(options, name) for name in describe(settings_class)}
    return settings_class(
        **{name: from_text(settings_class, name, text) for name, text in given.items() if text is not None}
    )


def whole_number(word: str) -> int:
    """For argparse; `require_within` checks the range."""
    try:
        return int(word)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{word}: allowed is a whole number") from None


def number(word: str) -> float:
    """For argparse; `require_within` checks the range."""
    try:
        return float(word)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{word}: allowed is a number") from None


def require_within(parser: argparse.ArgumentParser, options: argparse.Namespace, **ranges: tuple[float, float]) -> None:
    """End the program with what is allowed where an option is out of its range.

    Parameters
    ----------
    parser : argparse.ArgumentParser
    options : argparse.Namespace
        What it has parsed.
    **ranges : (float, float)
        Least and largest value, by the option's name with _ between words.
    """
    for name, (low, high) in ranges.items():
        value = getattr(options, name)
        if not low <= value <= high:
            parser.error(f"--{name.replace('_', '-')} {value}: allowed is {low} to {high}")
