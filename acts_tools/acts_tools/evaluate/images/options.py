# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Command-line options of the evaluations of recovered images."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from acts_core.array import COUNT_MAX
from acts_core.errors import SettingsError
from acts_core.sampling import OWN_SETTINGS, SCHEMES, SamplingConfig, check_frame
from acts_core.settings import SettingValue, checked, default_of, describe, from_text
from acts_recon.methods import METHODS
from acts_recon.sparse import Dictionary, shipped_dictionary_path
from acts_tools.arguments import add_settings, checked_later, name_and_value, refuse_unused, taxels, whole
from acts_tools.evaluate import report
from acts_tools.evaluate.estimators.dictionaries import dictionary_named
from acts_tools.evaluate.estimators.methods import ALIASES, method_names, report_name, settings_of
from acts_tools.evaluate.images.recovery import Task
from acts_tools.evaluate.options import add_seed_and_json
from acts_tools.evaluate.scene_frames import FOLLOW_COUNTS

METHOD = "acts"
"""Default method."""

_SCHEME, _M = "tracking", 55
_WITH_DICTIONARY = "paper"
_OPTIONS_OF_THEIR_OWN = ("dictionary", "patch_step")


def add_arguments(parser: argparse.ArgumentParser, **defaults: float) -> None:
    """Add options of sampling, recovery and scoring; `defaults` replace those of `Task`."""
    # Repeated options accumulate; `tasks` sets the defaults, which argparse would extend otherwise.
    parser.add_argument("--scheme", nargs="+", action="extend", choices=tuple(SCHEMES), help=f"default: {_SCHEME}")
    parser.add_argument("--m", nargs="+", action="extend", type=taxels, help=f"taxels per frame (default: {_M})")
    parser.add_argument("--method", nargs="+", action="extend", **method_argument())
    add_common_arguments(parser, **defaults)


def method_argument() -> dict[str, Any]:
    """What the options have in common by which a method is chosen; they give its name in reports."""
    same = ", ".join(f"{alias} = {name}" for alias, name in ALIASES.items())
    return {"choices": method_names(), "type": report_name, "help": f"default: {METHOD}; by the node's names: {same}"}


def add_common_arguments(parser: argparse.ArgumentParser, **defaults: float) -> None:
    """Add everything but schemes, M and methods; see `add_arguments`."""
    parser.add_argument(
        "--dictionary", metavar="FILE", help="dictionary, for methods that use one (default: the shipped one)"
    )
    add_settings(parser, Task, **defaults)
    parser.add_argument(
        "--search-counts",
        type=whole(0, COUNT_MAX),
        metavar="X",
        help="counts above which the sampling searches around or follows a taxel (default: "
        f"{FOLLOW_COUNTS} for tracking, as --touch-counts for the others)",
    )
    parser.add_argument(
        "--set",
        action="append",
        type=_method_setting,
        default=[],
        metavar="NAME=VALUE",
        help="set a parameter of a method (docs/reference.md, reconstruction)",
    )
    for own in OWN_SETTINGS:
        allowed = "above 0 to 1" if own.share else f"{own.minimum} to {own.maximum}"
        parser.add_argument(
            f"--{own.parameter.replace('_', '-')}",
            type=checked_later(type(own.parameter_default), allowed),
            default=own.parameter_default,
            metavar="X",
            help=f"{own.parameter_description} (default: %(default)s)",
        )
    add_seed_and_json(parser)


def _method_setting(word: str) -> tuple[str, SettingValue]:
    """``NAME=VALUE`` of a setting of a registered method, for argparse."""
    configs = {key: kind.Config for kind in METHODS.values() for key in describe(kind.Config)}
    known = [key for key in configs if key not in _OPTIONS_OF_THEIR_OWN]
    try:
        name, text = name_and_value(word, known, "settings of methods")
        return name, from_text(configs[name], name, text)
    except SettingsError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def dictionary(arguments: argparse.Namespace) -> Dictionary:
    """The chosen dictionary."""
    return dictionary_named(arguments.dictionary or str(shipped_dictionary_path()))


def task(arguments: argparse.Namespace, scheme: str, m: int, method: str, shape: tuple[int, ...] = (32, 32)) -> Task:
    """Task of one scheme, M and method on an array of `shape`.

    Raises
    ------
    SettingsError
        When something is out of range.
    """
    settings = {name: getattr(arguments, name) for name in describe(Task)}
    # First, because something else is made of one of them.
    for name, info in describe(Task).items():
        checked(name, settings[name], default_of(Task, name), info)
    threshold = arguments.search_counts
    if threshold is None:
        threshold = min(FOLLOW_COUNTS, arguments.touch_counts) if scheme == "tracking" else arguments.touch_counts
    rows, cols = shape
    sampling = SamplingConfig(
        scheme=scheme,
        rows=rows,
        cols=cols,
        m=rows * cols if SCHEMES[scheme].measures_all else m,
        threshold_counts=threshold,
        seed=arguments.seed,
        **{own.parameter: getattr(arguments, own.parameter) for own in OWN_SETTINGS},
    )
    # A board takes them, and measures all that it has.
    if scheme == "fixed" and arguments.fixed_taxels > rows * cols:
        raise SettingsError(
            f"fixed_taxels = {arguments.fixed_taxels}: allowed is 0 to {rows * cols} of a fixed frame of {rows} x "
            f"{cols} taxels"
        )
    return Task(sampling, method, **settings, settings=tuple(arguments.set))


def tasks(arguments: argparse.Namespace, shape: tuple[int, ...] = (32, 32)) -> list[Task]:
    """Tasks of every scheme with every M and every method, of `shape`.

    Raises
    ------
    SettingsError
        When something is out of range, or has no effect. It names each M that a scheme cannot have, not only the first.
    """
    schemes, ms, methods = arguments.scheme or [_SCHEME], arguments.m or [_M], arguments.method or [METHOD]
    require_frames([(scheme, m) for scheme in schemes for m in ms], shape)
    made = [task(arguments, scheme, m, method, shape) for scheme in schemes for m in ms for method in methods]
    # After their ranges: what is out of range is told first.
    require_used(arguments, schemes, methods)
    return made


def require_used(arguments: argparse.Namespace, schemes: Sequence[str], methods: Sequence[str]) -> None:
    """Refuse settings of a scheme or method, and a dictionary, that none of the chosen ones uses.

    Raises
    ------
    SettingsError
        It names the first of them.
    """
    used = {own for scheme in schemes for own in SCHEMES[scheme].own_settings}
    why = f"with the sampling of {', '.join(dict.fromkeys(schemes))}"
    refuse_unused(arguments, why, *(own.parameter for own in OWN_SETTINGS if own not in used))
    names = ", ".join(dict.fromkeys(methods))
    known = {name for method in methods for name in settings_of(method)}
    for name, value in arguments.set:
        if name not in known:
            raise SettingsError(f"--set {name}={value} has no effect with --method {names}; leave it out")
    if "patch_step" not in known:
        refuse_unused(arguments, f"with --method {names}", "patch_step")
    if not uses_dictionary(methods):
        refuse_unused(arguments, f"with --method {names}", "dictionary")


def uses_dictionary(methods: Sequence[str]) -> bool:
    """Whether one of the methods uses the dictionary of ``--dictionary``."""
    return _WITH_DICTIONARY in methods


def require_frames(pairs: Iterable[tuple[str, int]], shape: tuple[int, ...] = (32, 32)) -> None:
    """Refuse schemes and M that do not go together on an array of `shape`; all of them at once.

    Raises
    ------
    SettingsError
        It names the pairs, and what is allowed.
    """
    rows, cols = shape
    refused: dict[str, None] = {}
    for scheme, m in pairs:
        try:
            check_frame(scheme, rows, cols, m)
        except SettingsError as error:
            refused[f"{scheme}, {error}"] = None
    if refused:
        raise SettingsError(
            f"{'; '.join(refused)}. Every scheme is scored with every M of --m: leave these out, or give each scheme a "
            "command of its own"
        )


def results(arguments: argparse.Namespace, **about: object) -> report.Results:
    """The report, which begins with `about` and the arguments.

    Raises
    ------
    RecordingError
        When its file cannot be written, or is the recording or the dictionary.
    """
    own = (setting.parameter for setting in OWN_SETTINGS)
    used = {name: getattr(arguments, name) for name in (*describe(Task), *own, "search_counts", "seed")}
    about = {**about, **used, "dictionary": arguments.dictionary or "shipped", "set": dict(arguments.set)}
    reads = [Path(name) for name in (getattr(arguments, "frames", None), arguments.dictionary) if name]
    return report.Results(arguments.json, about, reads=reads)
