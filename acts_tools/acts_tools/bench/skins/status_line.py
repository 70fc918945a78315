# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Progress of the measurement, in one line of a terminal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TextIO

_ERASE = "\r\033[K"


class StatusLine:
    """Writes the line; nothing if the stream is no terminal.

    Parameters
    ----------
    seconds : float
        Duration of the measurement [s].
    stream : TextIO
        Output.
    """

    def __init__(self, seconds: float, stream: TextIO) -> None:
        self._seconds = seconds
        self._stream = stream
        self._is_shown = stream.isatty()

    def show(self, passed_s: float, rates_hz: Mapping[str, float], lost: Mapping[str, int]) -> None:
        """Show the rate of each skin since the last line, and the contacts lost so far."""
        if not self._is_shown:
            return
        skins = ", ".join(f"{name} {rate_hz:.0f}/s" for name, rate_hz in rates_hz.items())
        self._stream.write(
            f"{_ERASE}[bench] {passed_s:.0f} of {self._seconds:.0f} s: {skins}; {sum(lost.values())} lost"
        )
        self._stream.flush()

    def clear(self) -> None:
        """Erase the line."""
        if self._is_shown:
            self._stream.write(_ERASE)
            self._stream.flush()
