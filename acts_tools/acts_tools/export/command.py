# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts export`: export touch from bags as tables."""

from __future__ import annotations

import argparse
import signal
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

from acts_core.errors import RecordingError
from acts_tools.arguments import checked_later, refuse_unused

FORMATS = ("csv", "npz", "parquet", "lerobot")
_LAYOUT = "square"
_LEROBOT_HZ = 30.0
# The least is that of what reads a `rate_hz` of a file.
_RATE_MIN_HZ, _RATE_MAX_HZ = 1e-3, 10_000.0

_EPILOG = """\
examples:
  acts export touch --to csv                            the folder touch_csv with frames.csv and contacts.csv
  acts export touch --to npz --rate 100 -o frames.npz   100 rows a second, as `acts view --npz` reads them
  acts export touch --to csv --skin left_arm            one of the skins in the bag
  acts export grasp_1 grasp_2 --to lerobot -o grasps    two episodes
"""


def add_parser(subparsers: Any) -> None:
    """Add ``acts export`` to the acts command."""
    parser = subparsers.add_parser(
        "export",
        help="write touch of a bag as csv, npz, parquet or LeRobot dataset",
        description="Write images, contacts and joint states of bags as tables with one row per time. Images and "
        "contacts that were not recorded are recovered from the samples. docs/export.md lists the columns.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "bags", nargs="+", type=Path, metavar="BAG", help="bag; with several, each is a LeRobot episode"
    )
    parser.add_argument("--to", required=True, choices=FORMATS, dest="kind", help="format")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="PATH",
        help="folder to make, or with --to npz a file that ends in .npz "
        "(default: for the bag touch, touch_csv or touch.npz)",
    )
    parser.add_argument("--skin", default="", metavar="NAMESPACE", help="skin to export, if there are several")
    parser.add_argument(
        "--joints",
        default="",
        metavar="TOPIC",
        help="joint states to export, if there are several; none: leave them out",
    )
    parser.add_argument("--layout", default=_LAYOUT, help=f"layout of the skin, as in acts view (default: {_LAYOUT})")
    parser.add_argument(
        "--dead-taxels",
        default="",
        metavar="TAXELS",
        help="broken taxels, in quotes, as in acts view (default: none)",
    )
    parser.add_argument(
        "--rate",
        type=checked_later(float, f"0, or {_RATE_MIN_HZ:g} to {_RATE_MAX_HZ:.0f}"),
        metavar="HZ",
        help="rows a second, each with what was newest then; 0: one a frame "
        f"(default: 0, for lerobot {_LEROBOT_HZ:.0f})",
    )
    parser.add_argument(
        "--task", default="touch", metavar="WORDS", help="lerobot: what is done in the bags (default: touch)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Export the bags and return the exit code.

    Raises
    ------
    RecordingError
        A bag cannot be read, or the output exists, already or meanwhile, or has no name of its kind.
    """
    kind, bags = arguments.kind, arguments.bags
    rate_hz = _rate_hz(arguments)
    if len(bags) > 1 and kind != "lerobot":
        raise RecordingError(f"{len(bags)} bags: of several only a LeRobot dataset is made; export them one by one")
    if kind != "lerobot":
        refuse_unused(arguments, f"with --to {kind}", "task")
    if not _is_text(arguments.task):
        raise RecordingError(
            f"--task {arguments.task!r}: needed is UTF-8, as a LeRobot dataset has it; give other words"
        )
    output = _new_output(arguments)
    # Imported here, because they are slow to import and an invalid command line does not need them.
    from acts_tools.export.topics import Choice
    from acts_tools.export.writing import naming, write_bags

    # Learning has no use for a NaN: it would spread into the statistics of the dataset.
    choice = Choice(
        arguments.skin,
        arguments.joints,
        arguments.layout,
        arguments.dead_taxels,
        rate_hz,
        numbers_only=kind == "lerobot",
    )
    with ExitStack() as made:
        made.enter_context(_ended_as_by_ctrl_c())
        with naming(output):
            folder = made.enter_context(_folder_beside(output))
        begun = folder / output.name
        write_bags(bags, kind, choice, arguments.task, begun, output)
        # Somebody may have made it meanwhile; a file would be replaced.
        _refuse_existing(output)
        with naming(output):
            begun.rename(output)
    print(f"written to {output}")
    return 0


@contextmanager
def _ended_as_by_ctrl_c() -> Iterator[None]:
    """SIGTERM, and SIGHUP of a terminal that is closed, end the block in order; SIGHUP stays ignored under nohup."""
    taken = [one for one in (signal.SIGTERM, signal.SIGHUP) if signal.getsignal(one) is not signal.SIG_IGN]
    before = {one: signal.signal(one, signal.default_int_handler) for one in taken}
    try:
        yield
    finally:
        for one, handler in before.items():
            signal.signal(one, handler)


@contextmanager
def _folder_beside(output: Path) -> Iterator[Path]:
    """A folder beside the output; neither it nor one that was made for it stays, except around the finished output."""
    missing = [parent for parent in output.parents if not parent.exists()]
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        # What is not whole would be in the way of the next attempt.
        with tempfile.TemporaryDirectory(prefix=".acts_export_", dir=output.parent) as folder:
            yield Path(folder)
    finally:
        for parent in missing:
            # One in which there is something is kept by the system.
            with suppress(OSError):
                parent.rmdir()


def _is_text(words: str) -> bool:
    """Whether a word of the command line can be written in UTF-8; a terminal of another encoding gives other ones."""
    try:
        words.encode()
    except UnicodeEncodeError:
        return False
    return True


def _rate_hz(arguments: argparse.Namespace) -> float:
    """Rows a second; 0: one a frame."""
    kind = arguments.kind
    rate_hz = _LEROBOT_HZ if arguments.rate is None and kind == "lerobot" else arguments.rate or 0.0
    is_allowed = rate_hz == 0.0 or _RATE_MIN_HZ <= rate_hz <= _RATE_MAX_HZ
    if not is_allowed or (kind == "lerobot" and (rate_hz < 1.0 or rate_hz != int(rate_hz))):
        allowed = f"0, or {_RATE_MIN_HZ:g} to {_RATE_MAX_HZ:.0f}"
        if kind == "lerobot":
            allowed = f"a whole number from 1 to {_RATE_MAX_HZ:.0f}"
        raise RecordingError(f"--rate {rate_hz:g}: for {kind} allowed is {allowed}")
    return float(rate_hz)


def _new_output(arguments: argparse.Namespace) -> Path:
    """Where to write; nothing is there yet."""
    output: Path = arguments.output or _default_output(arguments.bags[0], arguments.kind)
    _refuse_existing(output)
    # What reads a recording tells an npz file by its name.
    if arguments.kind == "npz" and output.suffix != ".npz":
        raise RecordingError(f"'{output}': no name of an npz file; allowed are names that end in .npz")
    return output


def _refuse_existing(output: Path) -> None:
    # A link to nowhere is in the way of a folder, and would be replaced by a file.
    if output.is_symlink() or output.exists():
        raise RecordingError(f"'{output}' exists already and is not overwritten: choose another with -o")


def _default_output(bag: Path, kind: str) -> Path:
    name = bag.resolve().name.removesuffix(".mcap").removesuffix(".db3")
    return Path(f"{name}.npz" if kind == "npz" else f"{name}_{kind}")
