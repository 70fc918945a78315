"""`acts view`: a page in the browser that shows what the skins feel."""

from __future__ import annotations

import argparse

_EPILOG = """\
examples:
  acts view                          every skin that is found, at http://127.0.0.1:8080/
  acts view plate --port 9000        this one
  acts view --host 0.0.0.0           also for other machines: the address that is printed has a token that lets them in

docs/view.md explains the page.
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``view`` to the acts command."""
    parser = subparsers.add_parser(
        "view",
        help="show touch on a page in the browser",
        description="Serve a page that shows what the skins feel: image, contacts, plots, diagnostics. It only "
        "listens. Ctrl-C ends it.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("skins", nargs="*", metavar="NAMESPACE", help="skins to show, such as plate; none: all found")
    parser.add_argument("--host", default="127.0.0.1", help="address to listen on (127.0.0.1: this machine only)")
    parser.add_argument("--port", type=int, default=8080, help="port to listen on; 0: any that is free (8080)")


def run(arguments: argparse.Namespace) -> int:
    """Show until told to stop; the exit code."""
    # Late: they take time that the other commands need not spend.
    from acts_core.stop_signals import StopSignals
    from acts_view.main import main

    given = {"skins": ",".join(arguments.skins), "host": arguments.host, "port": arguments.port}
    words = [word for name, value in given.items() for word in ("--set", f"view.{name}={value}")]
    return main(StopSignals(), ["acts view", *words])
