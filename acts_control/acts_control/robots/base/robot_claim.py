# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The claim of a robot: no second program of this machine controls it meanwhile, whoever runs that."""

from __future__ import annotations

import socket

from acts_control.claims import ClaimedError, MachineClaim
from acts_core.errors import RobotError


class RobotTakenError(RobotError):
    """Another program of this machine controls the robot; a person has to end it."""


class RobotClaim:
    """The claim of one robot, held from its construction until `close`; see `MachineClaim`.

    The robot itself refuses a second program too, but cannot say who the first one is, and takes the second as soon as
    the first has gone.

    Parameters
    ----------
    address : str
        Of the robot.

    Raises
    ------
    RobotTakenError
        With the process that has it.
    """

    def __init__(self, address: str) -> None:
        try:
            self._claim = MachineClaim("robot", _numeric(address))
        except ClaimedError as error:
            raise RobotTakenError(
                f"robot {address} is controlled by {error}; end that program, then call start"
            ) from error
        except OSError as error:
            raise RobotError(f"robot {address} cannot be claimed ({error.strerror or error})") from error

    def close(self) -> None:
        """Give it up. May be called again."""
        self._claim.close()


def _numeric(address: str) -> str:
    """One name for a robot, whichever of its names was given."""
    try:
        return socket.gethostbyname(address)
    except (OSError, UnicodeError):
        # Not known, or nothing that could be a name: whoever connects says so.
        return address
