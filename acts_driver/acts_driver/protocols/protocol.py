# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the driver needs to know of a board's protocol."""

from __future__ import annotations

import typing
from collections.abc import Callable
from dataclasses import dataclass

from acts_core.frames import SampleFrame
from acts_core.wire import BoardMessage

OnMessage = Callable[[BoardMessage], None]
"""Takes what a board says besides frames, while its bytes are decoded."""


class Decoder(typing.Protocol):
    """Makes frames of bytes; `acts_core.wire.DelimitedDecoder` is one for packets that end in a delimiter.

    Used by the reader's thread alone; its counters may be read from any.

    Attributes
    ----------
    has_board_clock : bool
        Whether `SampleFrame.board_us` comes from a clock of the board, so that it can be mapped to the host's. Other
        frames are not published in the first 0.1 s after the port was opened: they may have waited in the board.
    frames, crc_errors, malformed, partial, bytes_discarded : int
        Counters, see `acts_core.wire.DelimitedDecoder`.
    last_error : str
        Why a packet was last rejected, for a person; empty as long as none was.
    """

    has_board_clock: bool
    frames: int
    crc_errors: int
    malformed: int
    partial: int
    bytes_discarded: int
    last_error: str

    def reset(self) -> None:
        """Tell that the stream was (re)opened: what is pending is dropped, and the first packet may be a cut one."""

    def feed(self, data: bytes) -> list[SampleFrame]:
        """Take the next bytes, cut anywhere, and return the frames that they complete, in order.

        Never raises for what the bytes hold: what is not valid is counted and dropped. Each frame takes the next
        sequence number of its board; numbers that are left out show as lost frames.
        """


@dataclass(frozen=True)
class Protocol:
    """A line of the registry.

    Attributes
    ----------
    of : str
        Who speaks it, for a person.
    decoder : callable
        Makes a decoder from the rows and columns that the array is said to have, and what takes messages.
    takes_commands : bool
        Whether the board takes the commands of docs/wire_protocol.md.
    """

    of: str
    decoder: Callable[[int, int, OnMessage], Decoder]
    takes_commands: bool = False
