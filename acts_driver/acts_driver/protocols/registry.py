# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""All protocols by name: a new one is a module beside this and a line here (docs/extending.md)."""

from __future__ import annotations

from acts_core.registry import named
from acts_core.wire import RasterDecoder, StreamDecoder
from acts_driver.protocols.protocol import Protocol

PROTOCOLS: dict[str, Protocol] = {
    "binary": Protocol("ACTS", lambda rows, cols, on_message: StreamDecoder(on_message), takes_commands=True),
    "raster_ascii": Protocol("the published raster sketch", lambda rows, cols, _: RasterDecoder(rows, cols)),
}


def protocol_named(name: str) -> Protocol:
    """Look a protocol up.

    Raises
    ------
    SettingsError
        Naming those that exist.
    """
    return named(name, PROTOCOLS, "protocol")
