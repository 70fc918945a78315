# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""All sampling schemes: the classes in the modules of ``acts_core.sampling.schemes``."""

from __future__ import annotations

import inspect
import pkgutil
from collections.abc import Iterable, Mapping
from importlib import import_module

from acts_core.errors import SettingsError
from acts_core.sampling import schemes
from acts_core.sampling.basis import CommonSettings, SamplingScheme
from acts_core.settings import describe, validate

_NUMBER_MAX = 255


def _find() -> dict[str, type[SamplingScheme]]:
    found: dict[str, type[SamplingScheme]] = {}
    for info in pkgutil.iter_modules(schemes.__path__):
        module = import_module(f"{schemes.__name__}.{info.name}")
        for scheme in vars(module).values():
            # Not `isinstance(scheme, type)`: on Python 3.10 that holds for `list[int]`, which is no class.
            is_class = issubclass(type(scheme), type)
            if is_class and issubclass(scheme, SamplingScheme) and scheme.__module__ == module.__name__:
                if inspect.isabstract(scheme):
                    continue  # what several schemes of the module share
                check_words(scheme)
                if scheme.name in found:
                    first = found[scheme.name].__module__
                    raise SettingsError(f"name = {scheme.name!r} of {module.__name__}: {first} has it already")
                found[scheme.name] = scheme
    check_names(found.values())
    check_numbers(found.values())
    return dict(sorted(found.items()))


def check_words(scheme: type[SamplingScheme]) -> None:
    """Check that a scheme says what it is called, and what its frames are.

    Raises
    ------
    SettingsError
    """
    for word in ("name", "description"):
        if not isinstance(getattr(scheme, word, None), str):
            raise SettingsError(f"scheme {scheme.__module__}.{scheme.__name__}: it has no {word}; give the class one")


def check_names(schemes: Iterable[type[SamplingScheme]], others: Mapping[str, str] | None = None) -> None:
    """Check the names of own settings: no other scheme has a setting of that name, nor have all schemes together.

    Parameters
    ----------
    schemes : iterable of type
    others : mapping of str to str, optional
        Further names that are taken, and who has them, such as `the board`.

    Raises
    ------
    SettingsError
        It names the scheme, the setting and who has it already.
    """
    owners = {**(others or {}), **dict.fromkeys(("scheme", *describe(CommonSettings)), "every scheme")}
    for scheme in schemes:
        for own in scheme.own_settings:
            for name in dict.fromkeys((own.name, own.parameter)):
                if name in owners:
                    raise SettingsError(
                        f"own setting {name!r} of scheme {scheme.name!r}: {owners[name]} has one of that name; "
                        "begin it with the name of its scheme"
                    )
                owners[name] = f"scheme {scheme.name!r}"


def check_numbers(schemes: Iterable[type[SamplingScheme]]) -> None:
    """Check the numbers on the wire: each fits in its byte and is given once, and those of own settings have no gap.

    Raises
    ------
    SettingsError
        It names what is allowed, or the next free number.
    """
    on_board = [scheme for scheme in schemes if scheme.number is not None]
    numbers = {scheme.name: scheme.number or 0 for scheme in on_board}
    for name, number in numbers.items():
        if not 1 <= number <= _NUMBER_MAX:
            raise SettingsError(f"number = {number} of scheme {name!r}: allowed is 1 to {_NUMBER_MAX}, one byte")
        others = [other for other in numbers if numbers[other] == number and other != name]
        if others:
            raise SettingsError(
                f"number = {number} of scheme {name!r}: {others[0]!r} has it; the next free one is "
                f"{max(numbers.values()) + 1}"
            )
    settings = {own.name: own.number for scheme in on_board for own in scheme.own_settings}
    needed = [7, 8, *range(14, 14 + len(settings))][: len(settings)]
    if sorted(number or 0 for number in settings.values()) != needed:
        raise SettingsError(f"numbers of own settings = {settings}: allowed is each of {needed} once, without a gap")


SCHEMES = _find()
"""Every sampling scheme by its name."""

SCHEME_NUMBERS = {name: scheme.number for name, scheme in SCHEMES.items() if scheme.number is not None}
"""Numbers on the wire of the schemes that a board has; the others exist in Python only."""

REPEATING = frozenset(scheme.number for scheme in SCHEMES.values() if scheme.repeats and scheme.number is not None)
"""Numbers of the schemes whose frames may have a taxel several times."""

OWN_SETTINGS = tuple(own for scheme in SCHEMES.values() for own in scheme.own_settings)
"""The schemes' own settings."""

BOARD_OWN_SETTINGS = {
    own.number: own
    for own in sorted(
        (own for name in SCHEME_NUMBERS for own in SCHEMES[name].own_settings), key=lambda own: own.number or 0
    )
    if own.number is not None
}
"""Those that a board has, by their number on the wire and in that order."""


def check_frame(name: str, rows: int, cols: int, m: int) -> None:
    """Check that a scheme has frames of `m` taxels of an array.

    Raises
    ------
    SettingsError
    """
    scheme = SCHEMES[name]
    if m > rows * cols and not scheme.measures_all:
        raise SettingsError(f"m = {m}: an array of {rows} x {cols} has {rows * cols} taxels")
    scheme.check_m(rows, cols, m)


def check_sampling(scheme: str, config: CommonSettings) -> None:
    """Check settings of sampling: each for itself, and all of them together for a frame of their scheme.

    Parameters
    ----------
    scheme : str
        Which is one of the settings, too.
    config : CommonSettings

    Raises
    ------
    SettingsError
        Naming the setting, what was given and what is allowed.
    """
    validate(config)
    check_frame(scheme, config.rows, config.cols, config.m)
    for own in SCHEMES[scheme].own_settings:
        own.check(config.own(own), config.rows, config.cols, config.m, scheme)


def frame_size(name: str, rows: int, cols: int, m: int) -> int:
    """Taxels that a frame of a scheme holds."""
    return rows * cols if SCHEMES[name].measures_all else m
