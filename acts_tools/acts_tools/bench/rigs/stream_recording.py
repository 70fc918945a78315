# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Record a board's bytes in the pieces that the port returned."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Protocol

from acts_core.errors import PortError
from acts_core.frames import SampleFrame
from acts_driver.port import SerialSource
from acts_tools.bench.workbench import Workbench

_TIMEOUT_S = 30.0


class Decoder(Protocol):
    """Decodes bytes to frames."""

    def reset(self) -> None:
        """Reset for a stream that was opened."""

    def feed(self, data: bytes) -> list[SampleFrame]:
        """Frames that the next bytes complete."""


def record(port: Path, decoder: Decoder, frames: int, workbench: Workbench) -> list[bytes]:
    """Read a port until it has sent a number of frames.

    Parameters
    ----------
    port : Path
        The port.
    decoder : Decoder
        Counts the frames.
    frames : int
        Number of frames.
    workbench : Workbench
        Stop flag.

    Returns
    -------
    list of bytes
        Result of each read; the last frame is complete.

    Raises
    ------
    PortError
        When the port cannot be read, or is too slow.
    """
    source = SerialSource(str(port))
    source.open()
    pieces: list[bytes] = []
    decoder.reset()
    deadline_s = time.monotonic() + _TIMEOUT_S
    try:
        while frames > 0:
            workbench.check_stop()
            if time.monotonic() > deadline_s:
                raise PortError(f"port {port} gave too few frames within {_TIMEOUT_S:g} s")
            pieces.append(source.read())
            frames -= len(decoder.feed(pieces[-1]))
    finally:
        source.close()
    return [piece for piece in pieces if piece]
