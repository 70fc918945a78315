# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Opening a serial port, with errors that say what to do."""

from __future__ import annotations

import errno
import grp
import os
import pwd
import stat
import termios
from pathlib import Path

import serial
from serial.tools import list_ports

from acts_core.errors import PortError
from acts_core.runtime import holders, is_multiplexer, is_stale_link
from acts_driver.port.port_choice import Lister, ports_present


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
            f"port {_shown(path)} is not there: the link is older than that terminal, so its board is gone and another "
            "program has the terminal; start the board again"
        )
    if is_multiplexer(path):
        raise PortError(
            f"{_shown(path)} makes a new terminal each time it is opened and is no port. {ports_present(lister)}"
        )
    try:
        return serial.Serial(path, baudrate=baud, timeout=0, exclusive=True)
    except (serial.SerialException, OSError, termios.error, ValueError) as error:
        raise PortError(explain(path, _errno_of(error), str(error), lister)) from error


def explain(path: str, number: int | None, reason: str, lister: Lister = list_ports.comports) -> str:
    """Words for a port that cannot be opened.

    Parameters
    ----------
    path : str
        The port.
    number : int or None
        errno of the failure, if there is one.
    reason : str
        What the operating system or the serial library said, used where `number` has no explanation of its own.
    lister : callable
        Lists the ports that are present.
    """
    if number in (errno.ENOENT, errno.ENODEV, errno.ENXIO, errno.EIO):
        return f"port {_shown(path)} is not there; plug the board in or name another port. {ports_present(lister)}"
    if number in (errno.EBUSY, errno.EAGAIN):
        held_by = holders(path)
        who = f"by {', '.join(held_by)}" if held_by else f"by another program (`lsof {path}` tells which)"
        return f"port {_shown(path)} is held {who}; stop that program first"
    if number in (errno.EACCES, errno.EPERM):
        return f"port {_shown(path)}: permission denied; {_how_to_be_permitted(path)}"
    if number in (errno.ENOTTY, errno.EISDIR):
        return f"{_shown(path)} is no serial port. {ports_present(lister)}"
    return f"port {_shown(path)} cannot be opened: {reason}. {ports_present(lister)}"


def _how_to_be_permitted(path: str) -> str:
    rule = "install the udev rule of acts_driver (docs/driver.md) and plug the board in again"
    try:
        status = Path(path).stat()
        group = grp.getgrgid(status.st_gid).gr_name
        user = pwd.getpwuid(os.geteuid()).pw_name
        members = grp.getgrgid(status.st_gid).gr_mem
    except (OSError, KeyError):
        # What most machines have; the port may be gone by now.
        status, group, user, members = None, "dialout", "", []
    if status is not None and (group == "root" or status.st_mode & 0o060 != 0o060):
        return f"its mode is {stat.filemode(status.st_mode)}, its group {group}: {rule}"
    if user in members:
        return f"your user {user} has joined its group {group} after this session began: log out and in again"
    known = "" if status is not None else " (uucp on Arch Linux)"
    return (
        f"join its group {group}{known} with `sudo usermod -a -G {group} $USER`, then log out and in again, or {rule}"
    )


def _errno_of(error: BaseException | None) -> int | None:
    """errno of a failure; pyserial leaves that of the terminal's settings in the exception it replaces."""
    while error is not None:
        number = error.args[0] if isinstance(error, termios.error) else getattr(error, "errno", None)
        if isinstance(number, int):
            return number
        error = error.__context__
    return None


def _shown(path: str) -> str:
    target = os.path.realpath(path)
    return f"{path} (a link to {target})" if Path(path).is_symlink() else path
