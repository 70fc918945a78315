# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Serial ports: finding and opening them, and the thread that reads them.

In comes the name of a port or of a board; out come decoded frames and messages, handed on by `Reader`. A port that is
lost is opened again.
"""

from acts_driver.port.port_choice import AUTO, SERIAL_PREFIX, check_port
from acts_driver.port.reader import Reader
from acts_driver.port.source import READ_TIMEOUT_S, SerialSource, Source
from acts_driver.port.stale_frames import HeldBack, StaleFrames

__all__ = [
    "AUTO",
    "READ_TIMEOUT_S",
    "SERIAL_PREFIX",
    "HeldBack",
    "Reader",
    "SerialSource",
    "Source",
    "StaleFrames",
    "check_port",
]
