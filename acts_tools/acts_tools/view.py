# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts view`: a page in the browser that shows the skins."""

from __future__ import annotations

import argparse
from pathlib import Path

from acts_core.array import MAX_SIDE
from acts_core.errors import SettingsError
from acts_core.names import full_name
from acts_core.skin import LAYOUTS, TAXELS_RULE
from acts_core.stop_signals import StopSignals
from acts_tools.arguments import checked_later, refuse_unused, whole

_EPILOG = """\
examples:
  acts view                          every skin in the graph, at http://127.0.0.1:8080/
  acts view plate --port 9000        this skin
  acts view --bag touch              a bag with samples, with pause and seek, without ROS nodes
  acts view --npz FILE.npz           the same for frames in an npz file
  acts view --board auto             the connected board, without a driver
  acts view --control                the page can tare, set the sampling, record, start and stop balancing and grasps
  acts view --host 0.0.0.0           also for other machines: the printed address contains a token for access

docs/view.md explains the page.
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``view`` to the acts command."""
    parser = subparsers.add_parser(
        "view",
        help="show touch on a page in the browser",
        description="Serve a page that shows image, contacts, plots and diagnostics of the skins, of a recording or of "
        "a board. It only listens, unless --control is given. Ctrl-C ends it.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("skins", nargs="*", metavar="NAMESPACE", help="skins to show, such as plate; none: all found")
    source = parser.add_mutually_exclusive_group()
    source.add_argument("--bag", type=Path, metavar="BAG", help="show the samples of a bag (folder, .mcap or .db3)")
    source.add_argument("--npz", type=Path, metavar="FILE", help="show samples or full frames of an npz file")
    source.add_argument("--board", metavar="PORT", help="show the board at a port: a path, auto, or serial:NUMBER")
    parser.add_argument(
        "--layout",
        default="square",
        help=f"layout of a recording or board: {', '.join(LAYOUTS)}, or a file (default: square)",
    )
    parser.add_argument(
        "--dead-taxels",
        default="",
        metavar="TAXELS",
        help=f"broken taxels of a recording or board, in quotes: {TAXELS_RULE} (default: none)",
    )
    parser.add_argument(
        "--size",
        type=whole(1, MAX_SIDE),
        nargs=2,
        default=[32, 32],
        metavar=("ROWS", "COLS"),
        help="size of a board (default: 32 32)",
    )
    parser.add_argument(
        "--protocol", default="binary", help="protocol of a board: binary, raster_ascii or your own (default: binary)"
    )
    parser.add_argument(
        "--baud",
        type=checked_later(int, "2400 to 12000000"),
        default=115200,
        help="bits per second of a board; no effect on USB boards (default: 115200)",
    )
    parser.add_argument(
        "--control",
        action="store_true",
        help="let the page tare, calibrate, set the sampling, record, start and stop balancing and grasps: "
        "this moves robots",
    )
    parser.add_argument("--outlines", action="store_true", help="show outlines of contacts, which costs CPU")
    parser.add_argument(
        "--host", default="127.0.0.1", help="address to listen on (default: 127.0.0.1, this machine only)"
    )
    parser.add_argument(
        "--port",
        type=checked_later(int, "0 to 65535"),
        default=8080,
        help="port to listen on; 0: any that is free (default: 8080)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Show until told to stop, and return the exit code."""
    if arguments.board is None:
        refuse_unused(arguments, "without --board", "size", "protocol", "baud")
    if arguments.bag or arguments.npz:
        refuse_unused(arguments, "on a recording", "control")
    elif arguments.board is None:
        refuse_unused(arguments, "without --bag, --npz or --board: nodes tell theirs", "layout", "dead_taxels")
    if arguments.board is not None and len(arguments.skins) > 1:
        raise SettingsError(f"a board is one skin; {', '.join(arguments.skins)} are {len(arguments.skins)}")
    signals = StopSignals()
    if arguments.bag or arguments.npz or arguments.board is not None:
        return _show_local(arguments, signals)
    for name in arguments.skins:
        if name and Path(name).exists():
            print(f"[view] {name} is taken for a namespace; the recording of that name: --bag {name}", flush=True)
    # Imported here, because it is slow to import and other commands do not need it. Ctrl-C meanwhile is not lost in a
    # module written in C.
    with signals.interrupting():
        from acts_view.main import main

    given = {"skins": ",".join(arguments.skins), "host": arguments.host, "port": arguments.port}
    given |= {name: str(getattr(arguments, name)).lower() for name in ("control", "outlines")}
    words = [word for name, value in given.items() for word in ("--set", f"view.{name}={value}")]
    return main(signals, ["acts view", *words])


def _show_local(arguments: argparse.Namespace, signals: StopSignals) -> int:
    """Show a recording or a board, and return the exit code."""
    with signals.interrupting():
        from acts_driver.settings import DriverSettings
        from acts_view.local.show import log, show
        from acts_view.local.sources import BoardSource, LocalSource, open_recorded
        from acts_view.settings import ViewSettings

    # Refused as by the node, and before a long recording is read.
    settings = ViewSettings(host=arguments.host, port=arguments.port)
    source: LocalSource
    shown = {"dead_taxels": arguments.dead_taxels, "with_outlines": arguments.outlines}
    if arguments.board is not None:
        rows, cols = arguments.size
        driver = DriverSettings(
            port=arguments.board, baud=arguments.baud, protocol=arguments.protocol, rows=rows, cols=cols
        )
        (given,) = arguments.skins or ["board"]
        # That of the root is empty, before the slash of its topics.
        name = "" if given == "/" else full_name(given, "namespace", has_names_below=True)
        record_dir = settings.record_folder if arguments.control else None
        source = BoardSource(name, driver, arguments.layout, log, **shown, record_dir=record_dir)
    else:
        source, name = open_recorded(arguments.bag or arguments.npz, arguments.skins, arguments.layout, **shown)
    return show(source, name, host=settings.host, port=settings.port, signals=signals)
