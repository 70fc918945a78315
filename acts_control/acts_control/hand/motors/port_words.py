# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Words for a person about the port of a hand."""

from __future__ import annotations

import errno
from pathlib import Path

from serial.tools import list_ports

from acts_core.runtime import errno_of, holders, leads_to, not_opened, ports_present


def why_not(port: str, error: Exception) -> str:
    """Words for a port that cannot be opened."""
    number = errno_of(error)
    if number in (errno.EBUSY, errno.EAGAIN):
        held_by = ", ".join(holders(port)) or f"another program (`lsof {port}` tells which)"
        return held(port, held_by)
    words = not_opened(port, number, str(error), what="hand", present=ports_present(list_ports.comports()))
    return words.removesuffix(".")  # it becomes a part of other sentences


def held(port: str, held_by: str) -> str:
    """Words for a port that another program has."""
    return f"{port} is held by {held_by}; a hand obeys one program: stop that first"


def usb_latency(port: Path) -> list[str]:
    """What to do where the USB adapter waits before it passes on what has come."""
    file = Path("/sys/bus/usb-serial/devices") / Path(leads_to(str(port))).name / "latency_timer"
    try:
        waits_ms = int(file.read_text())
    except (OSError, ValueError):
        return []  # no USB adapter, or one without such a setting
    if waits_ms <= 1:
        return []
    return [f"the USB adapter waits {waits_ms} ms for more bytes: echo 1 | sudo tee {file}"]
