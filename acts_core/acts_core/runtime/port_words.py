# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Words for a person about serial ports: which there are, and why one cannot be opened and what to do.

Nothing here needs a library for serial ports; the caller lists them.
"""

from __future__ import annotations

import errno
import grp
import os
import pwd
import stat
import termios
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from acts_core.runtime.terminals import holders, leads_to


def ports_present(ports: Iterable[Any]) -> str:
    """A sentence that lists serial ports with what is known of them.

    Parameters
    ----------
    ports : iterable of serial.tools.list_ports_common.ListPortInfo
    """
    named = [port_shown(port) for port in sorted(ports, key=lambda port: str(port.device))]
    return f"Ports present: {', '.join(named)}." if named else "No serial ports are present."


def port_shown(port: Any) -> str:
    """A port: path, description, USB numbers and serial number, as far as it has them.

    Parameters
    ----------
    port : serial.tools.list_ports_common.ListPortInfo
    """
    known = [] if port.description in (None, "", "n/a") else [str(port.description)]
    if port.vid is not None and port.pid is not None:
        known.append(f"USB {port.vid:04X}:{port.pid:04X}")
    if port.serial_number:
        known.append(f"serial number {port.serial_number}")
    return f"{port.device} ({', '.join(known)})" if known else str(port.device)


def path_shown(path: str) -> str:
    """A path, and where it leads to if it is a link."""
    try:
        is_link = Path(path).is_symlink()
    except OSError:
        # In a folder that is not ours to look into, for instance.
        is_link = False
    return f"{path} (a link to {leads_to(path)})" if is_link else path


def not_opened(path: str, number: int | None, reason: str, *, what: str, present: str, rule: str = "") -> str:
    """Words for a port that cannot be opened.

    Parameters
    ----------
    path : str
        The port.
    number : int or None
        errno of the failure, if there is one.
    reason : str
        What the operating system or the serial library said, used where `number` has no explanation of its own.
    what : str
        What is at the port: board or hand.
    present : str
        A sentence that lists the ports, see `ports_present`.
    rule : str
        What else gives the permission, such as a udev rule; empty for nothing.
    """
    shown = path_shown(path)
    if number in (errno.ENOENT, errno.ENODEV, errno.ENXIO, errno.EIO):
        advice = f"port {shown} is not there; plug the {what} in or name another port. {present}"
        if path.startswith("/dev/") and not path.startswith("/dev/shm/"):
            return advice
        return f"{advice} A simulated {what} makes its port when it is ready, on its first start after up to a minute."
    if number in (errno.EBUSY, errno.EAGAIN):
        held_by = holders(path)
        who = f"by {', '.join(held_by)}" if held_by else f"by another program (`lsof {path}` tells which)"
        return f"port {shown} is held {who}; stop that program first"
    if number in (errno.EACCES, errno.EPERM):
        return f"port {shown}: permission denied; {_how_to_be_permitted(path, rule)}"
    if number in (errno.ENOTTY, errno.EISDIR):
        return f"{shown} is no serial port. {present}"
    return f"port {shown} cannot be opened: {reason}. {present}"


def errno_of(error: BaseException | None) -> int | None:
    """errno of a failure; pyserial leaves that of the terminal's settings in the exception it replaces."""
    while error is not None:
        number = error.args[0] if isinstance(error, termios.error) else getattr(error, "errno", None)
        if isinstance(number, int):
            return number
        error = error.__context__
    return None


def _how_to_be_permitted(path: str, rule: str) -> str:
    try:
        status = Path(path).stat()
        group = grp.getgrgid(status.st_gid).gr_name
        user = pwd.getpwuid(os.geteuid()).pw_name
        members = grp.getgrgid(status.st_gid).gr_mem
    except PermissionError:
        return "a folder on the way to it is somebody else's: start this program as that user, or name another port"
    except (OSError, KeyError):
        # What most machines have; the port may be gone by now.
        status, group, user, members = None, "dialout", "", []
    if status is not None and (group == "root" or status.st_mode & 0o060 != 0o060):
        return f"its mode is {stat.filemode(status.st_mode)}, its group {group}: {rule or 'its owner may open it'}"
    if user in members:
        return f"your user {user} has joined its group {group} after this session began: log out and in again"
    known = "" if status is not None else " (uucp on Arch Linux)"
    join = f"join its group {group}{known} with `sudo usermod -a -G {group} $USER`, then log out and in again"
    return f"{join}, or {rule}" if rule else join
