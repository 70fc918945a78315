# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Which texts are addresses of this machine."""

from __future__ import annotations

import ipaddress

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from acts_core.runtime import is_loopback


@pytest.mark.parametrize("text", ["127.0.0.1", "127.0.6.5", "127.255.255.254", "::1", "0:0:0:0:0:0:0:1"])
def test_numeric_loopback_addresses(text: str) -> None:
    assert is_loopback(text)


@pytest.mark.parametrize(
    "text",
    [
        *("", "localhost", "127.evil.example.com", "127.0.0.1.example.com", "127.1", "127.0.0.1:80", "127.0.0.1/8"),
        *(" 127.0.0.1", "127.0.0.1\n", "127.0.0.01", "0x7f.0.0.1", "2130706433", "１２７.0.0.1", "127。0。0。1"),
        *("10.0.0.1", "192.168.1.10", "0.0.0.0", "128.0.0.1", "::", "::1%eth0", "::ffff:127.0.0.1", "::ffff:10.0.0.1"),
        *('127.0.0.1"', "127.0.0.1' or '", '127."[:4] == "127.', "__import__('os')", "$(eval 1)", "127.0.0.1\0x"),
    ],
)
def test_everything_else_is_somewhere_else(text: str) -> None:
    assert not is_loopback(text)


@given(st.ip_addresses(v=4))
def test_of_numeric_addresses_those_that_begin_with_127(address: ipaddress.IPv4Address) -> None:
    assert is_loopback(str(address)) == str(address).startswith("127.")


@given(st.text() | st.text("0123456789.１", max_size=12))
@example("0.0.1")
@example("１.0.1")
def test_any_text_is_decided_without_an_error(text: str) -> None:
    parts = text.split(".")
    is_numeric = len(parts) == 3 and all(part.isascii() and part.isdecimal() for part in parts)
    # A number is not written with zeros before it: some programs read it as an octal one.
    is_address = is_numeric and all(part == str(int(part)) and int(part) < 256 for part in parts)
    assert is_loopback("127." + text) == is_address
