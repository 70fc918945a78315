"""A board's bytes recorded in the pieces in which the port gave them."""

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
    """Anything that makes frames of bytes."""

    def reset(self) -> None:
        """Tell that the stream was opened."""

    def feed(self, data: bytes) -> list[SampleFrame]:
        """Frames that the next bytes complete."""


def record(port: Path, decoder: Decoder, frames: int, workbench: Workbench) -> list[bytes]:
    """Read a port until so many frames were in it.

    Parameters
    ----------
    port : Path
        The port.
    decoder : Decoder
        Tells how many frames there were.
    frames : int
        How many are wanted.
    workbench : Workbench
        Stops the recording.

    Returns
    -------
    list of bytes
        What each read returned; every frame is whole.

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
