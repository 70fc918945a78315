# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Clients of the page's server, in a process of their own: some read what they are sent, one never does.

    python3 -m acts_tools.bench.rigs.view_clients PORT CLIENTS SECONDS FILE

At the end it writes an object of JSON to the file, the fields of `Watched`.
"""

from __future__ import annotations

import json
import socket
import sys
import threading
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

from websockets import Origin
from websockets.sync.client import ClientConnection, connect

_OPEN_S = 20.0
# Longer than the server waits for it.
_STALL_S = 7.0


@dataclass
class Watched:
    """What one or several clients got.

    Attributes
    ----------
    first_s : list of float
        Of each client, from its connection to its first image [s].
    images_hz : list of float
        Of each client, images a second.
    age_ms : list of float
        Of each image, from its stamp to its reception [ms].
    """

    first_s: list[float] = field(default_factory=list)
    images_hz: list[float] = field(default_factory=list)
    age_ms: list[float] = field(default_factory=list)


def watch(port: int, clients: int, seconds: float) -> Watched:
    """Read with so many clients at once for a while, beside one that takes nothing."""
    watched = Watched()
    threads = [threading.Thread(target=_read, args=(port, seconds, watched)) for _ in range(clients)]
    threads.append(threading.Thread(target=_stall, args=(port, seconds)))
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return watched


def _connect(port: int, own: socket.socket | None = None, queue: int = 16) -> ClientConnection:
    place = f"127.0.0.1:{port}"
    return connect(
        f"ws://{place}/stream",
        sock=own,
        origin=Origin(f"http://{place}"),
        compression=None,
        open_timeout=_OPEN_S,
        max_queue=queue,
    )


def _stall(port: int, seconds: float) -> None:
    """Take nothing, and come again when the server has given up."""
    end_s = time.monotonic() + seconds
    while (left_s := end_s - time.monotonic()) > 0:
        small = socket.socket()
        # What it does not take has to wait in the server.
        small.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        small.connect(("127.0.0.1", port))
        with _connect(port, small, 1) as client:
            time.sleep(min(_STALL_S, left_s))
            client.close_socket()


def _read(port: int, seconds: float, watched: Watched) -> None:
    began_s = time.monotonic()
    images = 0
    with _connect(port) as client:
        first_s: float | None = None
        while (now_s := time.monotonic()) < began_s + seconds:
            try:
                message = client.recv(timeout=1.0)
            except TimeoutError:
                continue
            assert isinstance(message, bytes)
            header = json.loads(message[4 : 4 + int.from_bytes(message[:4], "little")])
            if header["type"] != "frame" or not any(name == "image" for name, _, _ in header["arrays"]):
                continue
            watched.age_ms.append(1e3 * (time.time() - header["stamp_s"]))
            if first_s is None:
                first_s = now_s
                watched.first_s.append(first_s - began_s)
            images += 1
        if first_s is not None:
            watched.images_hz.append(images / (time.monotonic() - first_s))


def main(words: Sequence[str]) -> int:
    """Watch, write what was got, and return 0."""
    port, clients, seconds = int(words[0]), int(words[1]), float(words[2])
    Path(words[3]).write_text(json.dumps(asdict(watch(port, clients, seconds))))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
