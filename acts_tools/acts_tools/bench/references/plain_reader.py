# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A reader of the board without ROS in a process of its own, to compare the driver with.

    python3 -m acts_tools.bench.references.plain_reader PORT stream|naive

It opens the port, decodes, counts and stamps as the driver does, and prints a line of JSON four times a second.
"""

from __future__ import annotations

import json
import select
import sys
import time
from collections.abc import Iterator, Sequence

from acts_core.errors import ActsError, LaunchError
from acts_core.wire import StreamDecoder
from acts_driver.port import SerialSource
from acts_driver.stream import FrameStream
from acts_tools.bench.references.naive_decoder import NaiveDecoder
from acts_tools.bench.rigs.processes import START_TIMEOUT_S, check_alive, python_module, virtual_board
from acts_tools.bench.rigs.stream_recording import Decoder
from acts_tools.bench.rigs.trial import Status, Trial, observe
from acts_tools.bench.workbench import Workbench

DECODERS = {"stream": StreamDecoder, "naive": NaiveDecoder}
_PERIOD_NS = 250_000_000


def reader_trial(
    workbench: Workbench, decoder: str, asked_hz: float, seconds: float, board_options: Sequence[str]
) -> Trial:
    """Run a plain reader at a frame rate.

    Parameters
    ----------
    workbench : Workbench
        Folder and stop flag.
    decoder : str
        One of `DECODERS`.
    asked_hz : float
        Frame rate of the board.
    seconds : float
        How long to measure [s].
    board_options : sequence of str
        More options of the virtual board.
    """
    with (
        virtual_board(workbench.folder, "--rate-hz", str(asked_hz), *board_options) as board,
        python_module(workbench.folder, __name__, [str(board.link), decoder]) as process,
    ):
        output = process.stdout
        assert output is not None

        def statuses() -> Iterator[Status]:
            while True:
                deadline_s = time.monotonic() + START_TIMEOUT_S
                while not select.select([output], [], [], 0.1)[0]:
                    workbench.check_stop()
                    if time.monotonic() > deadline_s:
                        raise LaunchError(f"the plain reader said nothing for {START_TIMEOUT_S:g} s")
                line = output.readline()
                if not line:
                    process.wait()
                    check_alive(process, workbench.folder / f"{__name__}.log")
                yield Status(**json.loads(line))

        return observe(statuses(), asked_hz, seconds)


def main(words: Sequence[str]) -> int:
    """Read a port until a signal asks to stop."""
    path, name = words
    source = SerialSource(path)
    decoder: Decoder = DECODERS[name]()
    stream = FrameStream(32, 32)
    try:
        source.open()
        decoder.reset()
        next_ns = time.time_ns() + _PERIOD_NS
        while True:
            data = source.read()
            now_ns = time.time_ns()
            stream.accept(decoder.feed(data), now_ns)
            if now_ns >= next_ns:
                next_ns += _PERIOD_NS
                counts = stream.statistics
                status = {"frames": counts.frames, "lost": counts.lost, "overruns": counts.overruns}
                print(json.dumps({"time_s": now_ns * 1e-9, **status}), flush=True)
    except ActsError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
