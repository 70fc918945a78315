# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What people type after a command: numbers within a range, settings by name, and options that have no
effect beside others.

Words come in; numbers that can be used go out, or an error that says what is allowed.
"""

from acts_tools.arguments.numbers import (
    at_least_one,
    checked_later,
    random_seed,
    real,
    seconds,
    simulated_taxels,
    taxels,
    whole,
)
from acts_tools.arguments.settings import add_settings, given_settings, name_and_value
from acts_tools.arguments.unused import refuse_unused

__all__ = [
    "add_settings",
    "at_least_one",
    "checked_later",
    "given_settings",
    "name_and_value",
    "random_seed",
    "real",
    "refuse_unused",
    "seconds",
    "simulated_taxels",
    "taxels",
    "whole",
]
