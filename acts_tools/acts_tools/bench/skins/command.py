# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts bench skins`: measure and report."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import Any

from acts_tools.bench import runner
from acts_tools.bench.rigs import realtime
from acts_tools.bench.rigs.processes import M
from acts_tools.bench.skins import judgement
from acts_tools.bench.skins.measurement import SETTLE_S, measure
from acts_tools.bench.skins.options import NAME, SECONDS, SUMMARY, options_from
from acts_tools.bench.skins.processes import RATE_HZ
from acts_tools.bench.workbench import Workbench
from acts_tools.output_file import write_json
from acts_tools.ros_domain import use_free_domain
from acts_tools.run_folder import run_folder
from acts_tools.running.stopping import StopFlag


def run(arguments: argparse.Namespace, path: Path) -> dict[str, Any]:
    """Measure and write the report.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of `acts bench`.
    path : Path
        Path of the report.

    Returns
    -------
    dict
        The report, in the layout of ``docs/benchmarks.md``.

    Raises
    ------
    ActsError
        When a process did not run to the end.
    """
    options = options_from(arguments)
    seconds = SECONDS if arguments.seconds is None else arguments.seconds
    use_free_domain()
    print(f"[bench] {NAME}: {SUMMARY}", file=sys.stderr, flush=True)
    report: dict[str, Any] = {
        **runner.begin_report(),
        "settings": {
            "skins": options.skins,
            "asked_seconds": seconds,
            "rate_hz": RATE_HZ,
            "m": M,
            "settle_s": min(SETTLE_S, seconds),
            "middleware": os.environ.get("RMW_IMPLEMENTATION", "default"),
            "ros_domain_id": os.environ["ROS_DOMAIN_ID"],
            "realtime_priorities": {
                "virtual_board": realtime.BOARD_PRIORITY,
                "tactile": realtime.SKIN_PRIORITY,
                "bench": realtime.SUBSCRIBER_PRIORITY,
            },
        },
        "load": options.load,
        "realtime": "on" if options.realtime else "off",
    }
    with StopFlag() as stop, run_folder("acts_bench_") as folder:
        report |= measure(Workbench(seconds, Path(folder), stop), options)
    report["load_average_after"] = runner.load_average()
    report["cpu_percent_total"] = judgement.total_percent(report)
    report["verdict"] = judgement.verdict(report)
    report["problems"] = judgement.problems(report)
    report["warnings"] = judgement.warnings(report)
    write_json(path, report)
    return report
