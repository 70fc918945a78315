# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Opening a serial port, with errors that say what to do."""

from __future__ import annotations

import termios

import serial
from serial.tools import list_ports

from acts_core.errors import PortError
from acts_core.runtime import errno_of, is_multiplexer, is_stale_link, not_opened, path_shown, ports_present
from acts_driver.port.port_choice import Lister


def open_port(path: str, baud: int, lister: Lister = list_ports.comports) -> serial.Serial:
    """Open a port for this process alone.

    Parameters
    ----------
    path : str
        Device file, or a link to one.
    baud : int
        Bits per second; of no effect on USB boards and pseudo-terminals.
    lister : callable
        Lists the ports that are present, for the error.

    Raises
    ------
    PortError
        With the ports that are present where `path` is missing, who may hold it where it is busy, and what to do where
        the permission is missing.
    """
    if is_stale_link(path):
        raise PortError(
            f"port {path_shown(path)} is not there: the link is older than that terminal, so its board is gone and "
            "another program has the terminal; start the board again"
        )
    if is_multiplexer(path):
        raise PortError(
            f"{path_shown(path)} makes a new terminal each time it is opened and is no port. {ports_present(lister())}"
        )
    try:
        return serial.Serial(path, baudrate=baud, timeout=0, exclusive=True)
    except (serial.SerialException, OSError, termios.error, ValueError) as error:
        raise PortError(explain(path, errno_of(error), str(error), lister)) from error


def explain(path: str, number: int | None, reason: str, lister: Lister = list_ports.comports) -> str:
    """Words for a board's port that cannot be opened; see `acts_core.runtime.not_opened`."""
    rule = "install the udev rule of acts_driver (docs/driver.md) and plug the board in again"
    return not_opened(path, number, reason, what="board", present=ports_present(lister()), rule=rule)
