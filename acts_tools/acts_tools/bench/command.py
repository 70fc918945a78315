# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts bench [NAME...]`: measure the performance of the sensing."""

from __future__ import annotations

import argparse
import json
from functools import partial
from pathlib import Path
from typing import Any

from acts_core.errors import ActsError
from acts_tools.arguments import real, refuse_unused


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``bench`` to the acts command."""
    from acts_tools.bench.registry import MEASUREMENTS
    from acts_tools.bench.skins import options as skins

    parser = subparsers.add_parser(
        "bench",
        help="measure throughput, CPU and latency",
        description="Measure the performance of the sensing on this machine; all hardware is simulated. The report is "
        "written after each measurement, so Ctrl-C keeps those that are finished.",
        epilog="examples:\n"
        "  acts bench                        the short measurements, one after the other\n"
        "  acts bench latency --seconds 10   one of them, shorter\n"
        "  acts bench skins --skins 2\n"
        "\nmeasurements:\n"
        + "".join(
            f"  {name:<14} {entry.summary}, {entry.seconds:g} s{' (only by name)' if entry.only_by_name else ''}\n"
            for name, entry in MEASUREMENTS.items()
        )
        + f"  {skins.NAME:<14} {skins.SUMMARY}, {skins.SECONDS:g} s (only by name)\n",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help="measurements to make (default: the short ones)")
    parser.add_argument("--seconds", type=real(0.2, 3600), help="how long each measures (default: its own time)")
    parser.add_argument(
        "--out", type=Path, default=Path("out"), help="folder for bench.json or bench_skins.json (default: out)"
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the report to this file instead")
    parser.add_argument("--markdown", action="store_true", help="print the table in Markdown")
    parser.add_argument("--show", type=Path, metavar="FILE", help="print the table of an earlier bench.json again")
    skins.add_options(parser)


def run(arguments: argparse.Namespace) -> int:
    """Measure, write and print; return 1 if something failed or could not be measured, but 0 if it was only slow."""
    from acts_tools.bench import report as reports
    from acts_tools.bench.skins import options as skins
    from acts_tools.bench.skins import table as skins_table

    if arguments.show is not None:
        refuse_unused(arguments, "with --show", "seconds", "out", "json", "skins", "load", "realtime")
        if arguments.names:
            raise ActsError(f"{' '.join(arguments.names)}: nothing is measured with --show; leave one of them out")
        report = _read(arguments.show)
    elif skins.is_chosen(arguments):
        from acts_tools.bench.skins import command

        report = command.run(arguments, _file(arguments, "bench_skins.json"))
    else:
        report = _measure(arguments)
    form = skins_table if "skins" in report else reports
    try:
        text = form.markdown(report) if arguments.markdown else form.table(report)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        # What was measured just now has all that a table needs.
        raise ActsError(f"--show {arguments.show}: not a report of `acts bench` of this version ({error!r})") from error
    print(text)
    return 1 if report["problems"] else 0


def _measure(arguments: argparse.Namespace) -> dict[str, Any]:
    from acts_tools.bench import runner
    from acts_tools.output_file import write_json
    from acts_tools.ros_domain import use_free_domain
    from acts_tools.running.stopping import StopFlag

    names = runner.choose(arguments.names)
    path = _file(arguments, "bench.json")
    use_free_domain()
    with StopFlag() as stop:
        # After each measurement, so that Ctrl-C keeps those that are finished.
        return runner.run(names, arguments.seconds, stop, partial(write_json, path))


def _file(arguments: argparse.Namespace, name: str) -> Path:
    """Path of the report; its folder is made before the measurement, to find errors early."""
    from acts_tools.output_file import make_folder, require_writable

    path = Path(arguments.out / name if arguments.json is None else arguments.json)
    make_folder(path.parent, "--out" if arguments.json is None else "--json")
    require_writable(path)
    return path


def _read(path: Path) -> dict[str, Any]:
    try:
        report = json.loads(path.read_text())
    except OSError as error:
        raise ActsError(f"--show {path}: cannot be read ({error.strerror})") from error
    except ValueError as error:
        raise ActsError(f"--show {path}: not a report of `acts bench` ({error})") from error
    if not isinstance(report, dict):
        raise ActsError(f"--show {path}: not a report of `acts bench`")
    return report
