# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The page of one skin without a graph."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable
from queue import SimpleQueue

from acts_core.errors import ActsError
from acts_core.stop_signals import StopSignals
from acts_view.local.sources import LocalSource
from acts_view.settings import ViewSettings
from acts_view.web.requests import Answer, Request
from acts_view.web.server import ViewServer

_STATUS_PERIOD_S = 0.25


def show(
    source: LocalSource,
    name: str,
    *,
    host: str,
    port: int,
    signals: StopSignals,
    on_address: Callable[[str], None] | None = None,
) -> int:
    """Serve the page until told to stop; the exit code.

    Parameters
    ----------
    source : LocalSource
    name : str
        Of the skin, with a slash before.
    host, port : str, int
        As `ViewServer` takes them.
    signals : StopSignals
        Ends it.
    on_address : callable, optional
        Takes the page's address; without, it is printed.
    """
    stopped = threading.Event()
    signals.on_stop(stopped.set)
    # Of each page only a few wait at a time.
    asked: SimpleQueue[tuple[Request, Answer]] = SimpleQueue()
    server = ViewServer(
        host,
        port,
        on_clients=lambda _: None,
        log=log,
        on_request=lambda request, answer: asked.put((request, answer)),
        find_file=source.find_file,
    )
    try:
        (on_address or _print_address)(server.address.url)
        server.show_shape(name, source.skin.shape)
        source.start(lambda: server.forget(name))
        told_s = -_STATUS_PERIOD_S
        while not stopped.wait(1.0 / ViewSettings.rate_hz):
            while not asked.empty():
                _act(source, *asked.get())
            is_due = time.monotonic() - told_s >= _STATUS_PERIOD_S
            # Asked before what is newest: of frames that count as played there, none is shown later.
            status = source.status() if is_due else {}
            newest = source.skin.newest()
            if newest is not None:
                server.show_frame(name, *newest)
            if is_due:
                told_s = time.monotonic()
                server.show_status({"skins": [name], **status})
    finally:
        source.stop()
        server.close()
    return 0


def _act(source: LocalSource, request: Request, answer: Answer) -> None:
    try:
        answer(True, source.do(request))
    except ActsError as error:
        answer(False, str(error))


def log(level: str, sentence: str) -> None:
    """Tell the person at the terminal."""
    print(f"[view] {level}: {sentence}", file=sys.stderr, flush=True)


def _print_address(url: str) -> None:
    print(f"[view] open {url}   (Ctrl-C ends it)", flush=True)
