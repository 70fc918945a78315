# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate hand`: the reflexes of the simulated hand, scenario by scenario, in one process or live."""

from __future__ import annotations

import argparse
import statistics
import tempfile
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from acts_core.errors import LaunchError
from acts_core.settings import SettingValue
from acts_core.words import counted
from acts_tools.arguments import given_settings, random_seed, real, whole
from acts_tools.evaluate import report
from acts_tools.evaluate.options import add_json
from acts_tools.evaluate.statistics import wilson

if TYPE_CHECKING:
    from acts_tools.evaluate.hand.scenario import Outcome, Run

_NUMBERS = ("noticed_ms", "stopped_ms", "penetration_mm", "offset_mm")
_NAMES = ("slip", "hold", "sharp", "blunt", "sphere", "small_sphere", "hand_to_hand")


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate hand``."""
    parser = commands.add_parser(
        "hand",
        help="score the reflexes of the simulated hand, scenario by scenario",
        description="Run the simulated hand, its skin and its reflexes in one process, faster than real time; the same "
        "seed gives the same bits. With --live, run them as processes, as on a real hand. docs/reflexes.md explains "
        "the numbers.",
    )
    parser.add_argument("--scenario", required=True, choices=_NAMES, help="scenario to run")
    parser.add_argument(
        "--seed", type=random_seed, default=1, metavar="S", help="seed of the first run (default: %(default)s)"
    )
    parser.add_argument(
        "--seeds", type=whole(1, 10_000), default=1, metavar="N", help="number of runs (default: %(default)s)"
    )
    parser.add_argument(
        "--reflex", choices=("on", "off"), default="on", help="whether the reflex of the scenario is on (default: on)"
    )
    parser.add_argument(
        "--rate-hz",
        type=real(10.0, 500.0),
        default=250.0,
        metavar="R",
        help="rate of the reflexes [Hz] (default: %(default)g)",
    )
    parser.add_argument(
        "--also",
        nargs="+",
        default=[],
        metavar="REFLEX",
        help="further reflexes that act, such as one of your own (docs/reflexes.md); how often each was set off is "
        "printed at the end",
    )
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="set a parameter of the hand's behaviour or of a reflex (docs/reference.md, hand_reflexes)",
    )
    parser.add_argument(
        "--live",
        action="store_true",
        help="use all real interfaces: each run launches the simulated hand, its board and the nodes, in real time",
    )
    add_json(parser)
    parser.set_defaults(evaluate=_run)


def _run(arguments: argparse.Namespace) -> int:
    # Imported here, because MuJoCo and the kernels are slow to import.
    from acts_tools.evaluate.hand.scenario import Run

    also, settings = tuple(arguments.also), _settings(arguments.set, arguments.also)
    setup = {"scenario": arguments.scenario, "reflex": arguments.reflex, "rate_hz": arguments.rate_hz}
    results = report.Results(arguments.json, {**setup, "also": also, "set": settings})
    print("| seed | ok | kept | noticed [ms] | stopped [ms] | penetration [mm] | offset [mm] |")
    print("|---|---|---|---|---|---|---|")
    outcomes: list[Outcome] = []
    events: Counter[str] = Counter()
    for seed in range(arguments.seed, arguments.seed + arguments.seeds):
        one = Run(seed, arguments.reflex == "on", arguments.rate_hz, also, settings)
        outcome, further = (_live if arguments.live else _counted)(arguments.scenario, one)
        outcomes.append(outcome)
        events.update(further["events"])
        numbers = " | ".join(_shown(getattr(outcome, name)) for name in _NUMBERS)
        line = f"| {seed} | {_shown(outcome.ok)} | {_shown(outcome.kept)} | {numbers} |"
        results.add({"seed": seed, **vars(outcome), **further}, line)
    results.add(_summary(outcomes))
    for name in also:
        print(f"{name}: set off {counted(events[name], 'time')} in {counted(len(outcomes), 'run')}")
    return 0


def _settings(words: Sequence[str], also: Sequence[str]) -> dict[str, SettingValue]:
    """The settings of ``--set``, by name.

    Raises
    ------
    SettingsError
        For one that there is not, or that its reflex refuses, and for a reflex of ``--also`` that there is not.
    """
    from acts_control.hand.control import SupervisorConfig
    from acts_control.hand.reflexes import make_reflexes, with_reflexes

    kind = with_reflexes(SupervisorConfig)
    given = given_settings(kind, words, "settings of the hand")
    make_reflexes(" ".join(also), kind(**given))
    return given


def _counted(scenario: str, one: Run) -> tuple[Outcome, dict[str, Any]]:
    """A run, with the number of times that each reflex was set off."""
    from acts_tools.evaluate.hand.scenarios import SCENARIOS

    made: list[Any] = []

    def rig(*options: Any) -> Any:
        made.append(one.rig(*options))
        return made[-1]

    outcome = SCENARIOS[scenario](replace(one, rig=rig))
    return outcome, {"events": {name: reflex.events for rig in made for name, reflex in rig.reflexes.items()}}


def _live(scenario: str, one: Run) -> tuple[Outcome, dict[str, Any]]:
    """The same over the real interfaces, also with durations of cycles and the latency from measurement to goals."""
    from acts_tools.hand_rigs.live_rigs import LiveRigs
    from acts_tools.ros_domain import use_free_domain
    from acts_tools.running.stopping import StopFlag

    use_free_domain()
    with tempfile.TemporaryDirectory(prefix="acts_evaluate_") as folder, StopFlag() as stop:
        log = Path(folder) / "launch.log"
        try:
            with LiveRigs(log, stop) as rigs:
                outcome, events = _counted(scenario, replace(one, rig=rigs))
        except LaunchError as error:
            said = "\n".join(log.read_text(errors="replace").splitlines()[-30:])
            raise LaunchError(f"{error}; the launch said:\n{said}") from error
    return outcome, {**events, **rigs.recording.timing_ms()}


def _summary(outcomes: Sequence[Any]) -> dict[str, object]:
    """Shares over the seeds with their intervals, and medians; also prints them."""
    summary: dict[str, object] = {"seed": "all", "runs": len(outcomes)}
    for name in ("ok", "kept"):
        known = [getattr(one, name) for one in outcomes if getattr(one, name) is not None]
        low, high = wilson(sum(known), len(known))
        summary[name] = {"share": sum(known) / len(known) if known else None, "low": low, "high": high}
        print(f"{name}: {sum(known)} of {len(known)} (95 %: {100 * low:.0f} to {100 * high:.0f} %)")
    for name in _NUMBERS:
        values = sorted(value for one in outcomes if (value := getattr(one, name)) is not None)
        if values:
            summary[name] = {"median": statistics.median(values), "largest": values[-1], "runs": len(values)}
            runs = counted(len(values), "run")
            print(f"{name}: median {statistics.median(values):.1f}, largest {values[-1]:.1f}, in {runs}")
    held = [one.details for one in outcomes if "held_s" in one.details]
    if held:
        minutes = sum(details["held_s"] for details in held) / 60.0
        told, before = (sum(details[name] for details in held) for name in ("false_slips", "slips_before"))
        summary["false_slips"] = {"per_minute": told / minutes, "minutes": minutes, "while_grasping": before}
        print(
            f"false slips: {told} in {minutes:.1f} min of holding, {told / minutes:.2f} a minute; before that {before} "
            f"in {counted(len(held), 'grasp')}"
        )
    return summary


def _shown(value: float | bool | None) -> str:
    if value is None:
        return ""
    return ("yes" if value else "no") if isinstance(value, bool) else f"{value:.1f}"
