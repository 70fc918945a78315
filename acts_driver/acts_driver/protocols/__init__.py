# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What boards speak, by name: a protocol is a module here and a line in `registry`.

In come the bytes of a board, cut anywhere; out come frames of samples, and counts of what was not good.
"""

from acts_driver.protocols.protocol import Decoder, OnMessage, Protocol
from acts_driver.protocols.registry import PROTOCOLS, protocol_named

__all__ = ["PROTOCOLS", "Decoder", "OnMessage", "Protocol", "protocol_named"]
