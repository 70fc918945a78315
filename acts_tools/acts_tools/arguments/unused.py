# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Options that have no effect beside others: refused, so that nobody takes them for in force."""

from __future__ import annotations

import argparse

from acts_core.errors import SettingsError


def refuse_unused(arguments: argparse.Namespace, why: str, *names: str) -> None:
    """Refuse options that were given and have no effect.

    Parameters
    ----------
    arguments : argparse.Namespace
        Of a parser of the acts command.
    why : str
        When they have none, such as "without --board".
    names : str
        Of attributes of `arguments`, such as "noise_counts" of ``--noise-counts``.

    Raises
    ------
    SettingsError
        One differs from its default.
    """
    for name in names:
        value = getattr(arguments, name)
        if value != arguments.default_of(name):
            option = f"--{name.replace('_', '-')}"
            given = [] if value is True else value if isinstance(value, list) else [value]
            raise SettingsError(f"{' '.join([option, *map(str, given)])} has no effect {why}; leave it out")
