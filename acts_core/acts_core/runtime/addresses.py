# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Network addresses."""

from __future__ import annotations

from ipaddress import IPv4Address, IPv6Address, ip_address


def is_loopback(text: str) -> bool:
    """Whether a text is a numeric address of this very machine: of 127.0.0.0/8, or ::1.

    A name never is: what it stands for may be anywhere.
    """
    try:
        address = ip_address(text)
    except ValueError:
        return False
    return address.is_loopback if isinstance(address, IPv4Address) else address == IPv6Address("::1")
