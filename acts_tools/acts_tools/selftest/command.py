# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts selftest`: test a board, its wiring and its skin."""

from __future__ import annotations

import argparse
import errno
import os
import sys
import time
from contextlib import AbstractContextManager, ExitStack, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

from acts_core.array import MAX_SIDE
from acts_core.errors import ActsError
from acts_core.words import counted
from acts_tools.arguments import real, refuse_unused, whole
from acts_tools.output_file import require_picture, require_writable, write_json

if TYPE_CHECKING:
    from acts_driver.selftest import FrameRecord
    from acts_tools.selftest.result import SelfTest
    from acts_tools.selftest.session import BoardReader
    from acts_tools.selftest.simulation import SimulatedSkin

_EPILOG = """\
examples:
  acts selftest                                          the only connected Teensy
  acts selftest /dev/ttyACM0 --touch-s 30
  acts selftest --sim --hardware-fault open-row=5        what a broken row looks like

The exit code is 1 if something is faulty, and 0 if there are only warnings. Stop the driver first: only one process
can use a port. docs/selftest.md explains every item.
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``selftest`` to the acts command."""
    parser = subparsers.add_parser(
        "selftest",
        help="test a board, its wiring and its skin",
        description="Test a board, its wiring and its skin: first untouched, then while a hand is rolled over it.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    side, seconds = whole(1, MAX_SIDE), real(0.5, 3600)
    parser.add_argument(
        "port", nargs="?", default="auto", metavar="PORT", help="a path, auto or serial:NUMBER (default: auto)"
    )
    parser.add_argument(
        "--protocol", default="binary", help="protocol of the board: binary, raster_ascii or your own (default: binary)"
    )
    parser.add_argument(
        "--rows", type=side, default=32, help="rows of the array, with raster_ascii, your own and --sim (default: 32)"
    )
    parser.add_argument(
        "--cols",
        type=side,
        default=32,
        help="columns of the array, with raster_ascii, your own and --sim (default: 32)",
    )
    parser.add_argument(
        "--baud",
        type=whole(2400, 12_000_000),
        default=115200,
        help="bits per second; no effect on USB boards (default: 115200)",
    )
    parser.add_argument("--untouched-s", type=seconds, default=4.0, metavar="S", help="time untouched [s] (default: 4)")
    parser.add_argument(
        "--touch-s", type=seconds, metavar="S", help="time to roll a hand over the skin [s] (default: 20, with --sim 6)"
    )
    parser.add_argument("--no-touch", action="store_true", help="skip the touch: the wiring is not tested")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the report, with all maps, as JSON")
    parser.add_argument(
        "--picture",
        type=Path,
        metavar="FILE",
        default=Path("out/selftest.png"),
        help="PNG to draw (default: out/selftest.png)",
    )
    parser.add_argument("--sim", action="store_true", help="test a virtual board, pressed by a simulated roller")
    parser.add_argument(
        "--hardware-fault",
        action="append",
        default=[],
        metavar="FAULT",
        help="fault of its wiring; see virtual_board --help",
    )


def run(arguments: argparse.Namespace) -> int:
    """Test and report; return 1 if something is faulty."""
    if arguments.hardware_fault and not arguments.sim:
        raise ActsError("--hardware-fault breaks the wiring of a virtual board: give --sim as well")
    if arguments.sim:
        refuse_unused(arguments, "with --sim", "baud")
        if arguments.port != "auto":
            raise ActsError(f"{arguments.port}: with --sim the board is a virtual one; leave one of them out")
    elif arguments.protocol == "binary":
        refuse_unused(arguments, "on a board that speaks binary: it tells its own size", "rows", "cols")
    if arguments.no_touch:
        refuse_unused(arguments, "with --no-touch", "touch_s")
    require_writable(arguments.json, makes_folder=True)
    require_picture(arguments.picture, makes_folder=True, report=arguments.json)
    with ExitStack() as stack:
        skin = _simulated(arguments, stack) if arguments.sim else None
        test = _test(arguments, skin)
    # Imported here, because matplotlib takes a second.
    from acts_driver.selftest import Level
    from acts_tools.selftest.picture import draw

    print(test.text())
    write_json(arguments.json, test.as_json())
    draw(test, arguments.picture)
    print(f"picture: {arguments.picture}")
    return 1 if test.level is Level.FAIL else 0


def _simulated(arguments: argparse.Namespace, stack: ExitStack) -> SimulatedSkin:
    from acts_tools.run_folder import run_folder
    from acts_tools.selftest.simulation import simulated_skin

    folder = Path(stack.enter_context(run_folder("acts_selftest_")))
    return stack.enter_context(
        simulated_skin(folder, arguments.rows, arguments.cols, arguments.protocol, arguments.hardware_fault)
    )


def _test(arguments: argparse.Namespace, skin: SimulatedSkin | None) -> SelfTest:
    from acts_driver.board import version_in_words
    from acts_tools.selftest.session import BoardReader

    port = arguments.port if skin is None else skin.port
    _require_possible(port)
    with BoardReader(port, arguments.protocol, arguments.rows, arguments.cols, arguments.baud) as board:
        state = board.query()
        if state is None:
            print("the board takes no commands: it is tested with the frames that it sends", file=sys.stderr)
            return _phases(arguments, skin, board, "", 0.0)
        who = f", board {state.board_id}, firmware {version_in_words(state)}"
        with board.full_frames(state.settings) as settings:
            return _phases(arguments, skin, board, who, float(settings.frame_period_us))


def _require_possible(port: str) -> None:
    """Let a name that no file can have be told as it is of other commands (acts_tools.cli)."""
    try:
        os.lstat(port)
    except OSError as error:
        if error.errno == errno.ENAMETOOLONG:
            raise


def _phases(
    arguments: argparse.Namespace, skin: SimulatedSkin | None, board: BoardReader, who: str, frame_period_us: float
) -> SelfTest:
    from acts_driver.selftest import (
        Thresholds,
        judge_high,
        judge_timing,
        judge_touched,
        judge_untouched,
        measure_timing,
        measure_touched,
        measure_untouched,
    )
    from acts_tools.selftest.result import SelfTest

    thresholds = Thresholds()
    first = board.first_frame()
    rows, cols = first.rows, first.cols
    _tell(f"leave the skin alone for {arguments.untouched_s:g} s")
    record = board.record(rows, cols, arguments.untouched_s, lambda record: None)
    _require_two_frames(record, arguments.untouched_s, "--untouched-s")
    untouched = measure_untouched(record)
    timing = measure_timing(record, has_board_clock=board.has_board_clock, frame_period_us=frame_period_us)
    findings = [*judge_timing(timing, thresholds), *judge_untouched(untouched, thresholds)]
    touch = None
    if arguments.no_touch:
        findings.append(judge_high(untouched, thresholds))
    else:
        seconds = arguments.touch_s or (20.0 if skin is None else 6.0)
        _tell(f"now roll a hand over the whole skin, slowly and to the edges, for {seconds:g} s")
        pressing: AbstractContextManager[None] = nullcontext() if skin is None else skin.rolled(rows, cols, seconds)
        with pressing:
            touched = board.record(rows, cols, seconds, _Countdown(seconds))
        _require_two_frames(touched, seconds, "--touch-s")
        touch = measure_touched(touched, untouched, thresholds)
        findings += judge_touched(touch, untouched, thresholds)
    name = (board.name if skin is None else "the virtual board") + who
    return SelfTest(name, rows, cols, first.scheme.name.lower(), thresholds, findings, untouched, timing, touch)


def _require_two_frames(record: FrameRecord, seconds: float, option: str) -> None:
    n = len(record.frames)
    if n < 2:
        raise ActsError(
            f"{counted(n, 'frame')} in {seconds:g} s: give a longer {option}; a board that sends more often has fallen "
            "silent: start it anew"
        )


def _tell(words: str) -> None:
    print(words, file=sys.stderr, flush=True)


class _Countdown:
    """Prints the remaining seconds on a terminal."""

    def __init__(self, seconds: float) -> None:
        self._end_s = time.monotonic() + seconds
        self._told = -1
        self._is_watched = sys.stderr.isatty()

    def __call__(self, record: FrameRecord) -> None:
        left = int(self._end_s - time.monotonic())
        if self._is_watched and left != self._told:
            self._told = left
            print(f"\r{left:3d} s ", end="" if left > 0 else "\r", file=sys.stderr, flush=True)
