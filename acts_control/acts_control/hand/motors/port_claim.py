# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The claim of a hand's port: no second program opens it meanwhile, by whichever of its names."""

from __future__ import annotations

from pathlib import Path

from acts_control.claims import ClaimedError, MachineClaim
from acts_control.hand.motors.bus import HandError
from acts_control.hand.motors.port_words import held
from acts_core.runtime import leads_to


class PortClaim:
    """Keeps other programs from a port, also while nothing is there.

    A port has the name that was given, and the one where that leads to: a link in /dev/serial/by-id and /dev/ttyUSB0
    are one hand. While nothing is there the first alone is known.

    The number of a pseudo-terminal belongs to a port only as long as the terminal is there: the next that is made, as
    for another simulated hand, gets the same one.

    Parameters
    ----------
    port : str
    """

    def __init__(self, port: str) -> None:
        self._port = port
        self._claims: dict[str, MachineClaim] = {}

    def take(self) -> None:
        """Claim the names that the port has now; to be called whenever it is to be opened.

        Raises
        ------
        HandError
            When another program has one of them, which is named.
        """
        paths = dict.fromkeys((str(Path(self._port).absolute()), leads_to(self._port)))
        names = [name for name in map(_name_of, paths) if name is not None]
        # An adapter that was plugged in anew may have another number, and its old one be somebody else's.
        for name in self._claims.keys() - set(names):
            self._claims.pop(name).close()
        for name in names:
            if name not in self._claims:
                self._claims[name] = self._claim(name)

    def close(self) -> None:
        """Give it up. May be called again."""
        while self._claims:
            self._claims.popitem()[1].close()

    def _claim(self, name: str) -> MachineClaim:
        try:
            return MachineClaim("hand", name)
        except ClaimedError as error:
            raise HandError(held(self._port, str(error))) from error
        except OSError as error:
            raise HandError(f"{self._port} cannot be claimed ({error.strerror or error})") from error


def _name_of(path: str) -> str | None:
    """What stands for a path among the programs of this machine; None for a pseudo-terminal that is not there."""
    if not path.startswith("/dev/pts/"):
        return path
    try:
        # Linux sets this time when it makes the terminal, and not when somebody writes. It goes in steps of some
        # milliseconds, for which a hand is there at least.
        return f"{path} of {Path(path).stat().st_ctime_ns}"
    except OSError:
        return None
