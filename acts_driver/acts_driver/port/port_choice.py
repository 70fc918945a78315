# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Which serial port is meant: a path, the only Teensy there is, or the board of a USB serial number."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from serial.tools import list_ports
from serial.tools.list_ports_common import ListPortInfo

from acts_core.errors import PortError, SettingsError
from acts_core.runtime import port_shown, ports_present

AUTO = "auto"
SERIAL_PREFIX = "serial:"

TEENSY_SERIAL = (0x16C0, 0x0483)
"""USB vendor and product of a Teensy whose sketch has a serial port (PJRC's USB type "Serial")."""

Lister = Callable[[], Iterable[ListPortInfo]]
"""Lists the serial ports of this machine, as `serial.tools.list_ports.comports` does."""


def check_port(port: str) -> None:
    """Refuse words that can be no port.

    Raises
    ------
    SettingsError
        Empty, or `serial:` without a number.
    """
    if not port.strip() or port.strip() == SERIAL_PREFIX:
        raise SettingsError(
            f"port = {port!r}: allowed are a path such as /dev/ttyACM0, {AUTO}, or {SERIAL_PREFIX}NUMBER with the "
            "USB serial number of a board"
        )


def resolve(port: str, lister: Lister = list_ports.comports) -> str:
    """Path of the port that is meant, among the ports that are present now.

    Ask anew at every opening: a board that was unplugged may come back under another name.

    Parameters
    ----------
    port : str
        A path, which is returned as it is; `auto` for the only Teensy; `serial:NUMBER` for the board of that USB
        serial number.
    lister : callable
        See `Lister`.

    Raises
    ------
    PortError
        None or several of the ports fit; names all that are present.
    """
    if port != AUTO and not port.startswith(SERIAL_PREFIX):
        return port
    present = _sorted(lister())
    if port == AUTO:
        wanted = "no Teensy (USB {:04X}:{:04X}) is".format(*TEENSY_SERIAL)
        found = [one for one in present if (one.vid, one.pid) == TEENSY_SERIAL]
    else:
        number = port.removeprefix(SERIAL_PREFIX).strip()
        wanted = f"no board with USB serial number {number} is"
        found = [one for one in present if one.serial_number == number]
    if not found:
        raise PortError(
            f"port {port}: {wanted} plugged in; plug it in, wait until it has started, or name another port. "
            f"{ports_present(present)}"
        )
    if len(found) > 1:
        choices = ", ".join(
            f"{SERIAL_PREFIX}{one.serial_number}" if port == AUTO and one.serial_number else one.device for one in found
        )
        raise PortError(
            f"port {port}: {len(found)} boards fit: {', '.join(map(port_shown, found))}; name one of them as the port: "
            f"{choices}"
        )
    return str(found[0].device)


def _sorted(ports: Iterable[ListPortInfo]) -> list[ListPortInfo]:
    return sorted(ports, key=lambda port: str(port.device))
