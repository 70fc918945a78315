# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts demo hand`: a simulated hand plays scenarios of the evaluation by touch; record, score and draw it."""

from __future__ import annotations

import time
from pathlib import Path

from acts_core.errors import ActsError
from acts_tools.demo.claims import claimed_folder
from acts_tools.demo.files import DemoFiles
from acts_tools.demo.hand.act import Act
from acts_tools.demo.hand.picture import draw
from acts_tools.demo.hand.score import score, table
from acts_tools.evaluate.hand.scenario import Run
from acts_tools.evaluate.hand.scenarios import SCENARIOS
from acts_tools.hand_rigs.collector import HandCollector
from acts_tools.hand_rigs.live import STATES
from acts_tools.hand_rigs.live_rigs import LiveRigs
from acts_tools.ros_domain import use_free_domain
from acts_tools.running.stopping import StopFlag

TITLES = {
    "sphere": "a sphere is brought to the palm's centre",
    "slip": "a cylinder is loaded until it slips",
    "sharp": "a finger is poked with a tip",
    "hand_to_hand": "another hand is shaken",
}
"""Titles of the acts in their order, by the names of their scenarios."""


def run(names: list[str], out: Path, seed: int) -> int:
    """Run the demo and return the exit code, 0 if every act met all that is asked of it.

    Parameters
    ----------
    names : list of str
        Acts to play, of `TITLES`; empty for all.
    out : Path
        Folder for the results.
    seed : int
        Seed of the simulated hands' variation.
    """
    unknown = [name for name in names if name not in TITLES]
    if unknown:
        raise ActsError(f"{', '.join(unknown)}: there is no such act; there are {', '.join(TITLES)}")
    # An act that is named twice is one act.
    chosen = list(dict.fromkeys(names)) or list(TITLES)
    files = DemoFiles.made(out, "hand")
    with claimed_folder(out), StopFlag() as stop:
        return _run(chosen, files, seed, stop)


def _run(names: list[str], files: DemoFiles, seed: int, stop: StopFlag) -> int:
    use_free_domain()
    print(
        f"The reflexes of a simulated LEAP hand with a skin of 1024 taxels: {'; '.join(TITLES[name] for name in names)}"
    )
    print("The same nodes run on the real hand; only launch arguments differ. Everything below is measured live.")
    begin_s = time.monotonic()
    with files.log_shown():
        acts = [play(name, seed, files.log, stop, begin_s) for name in names]
    results = score(acts)
    # Before what a full disk may not take.
    print(table(results, acts))
    files.write(results)
    draw(acts, files.picture)
    print(f"  wrote {files}")
    return 0 if results["ok"] else 1


def play(name: str, seed: int, log_path: Path, stop: StopFlag, begin_s: float) -> Act:
    """Play an act with a new hand.

    Raises
    ------
    LaunchError
        When the hand does not start, or ends early.
    """

    def line(collector: HandCollector) -> str:
        words = [f"{time.monotonic() - begin_s:5.1f} s", f"{TITLES[name]:<40}"]
        status = collector.status
        if status is None or not collector.fresh_s:
            return " | ".join([*words, "starting"])
        words.append(f"{STATES[status.state]:>8}: {status.reason}")
        felt = collector.recording.regions[-1][1] if collector.recording.regions else []
        words.append(f"{sum(one.force_n for one in felt):5.1f} N on {sum(one.in_contact for one in felt)} patches")
        return " | ".join([*words, *(f"{reflex} acts" for reflex in status.active)])

    with LiveRigs(log_path, stop, line) as rigs:
        outcome = SCENARIOS[name](Run(seed=seed, rig=rigs))
        rigs.close()
        return Act(name, TITLES[name], rigs.world, rigs.recording, outcome)
