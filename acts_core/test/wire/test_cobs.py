# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Byte stuffing: examples of the paper, and the compiled form against the plain one."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.errors import PacketError
from acts_core.wire import cobs
from acts_core.wire.cobs_kernels import decode_into, encode_into

RUNS = st.lists(
    st.one_of(st.binary(max_size=8), st.integers(250, 260).map(lambda n: b"\x01" * n), st.just(b"\x00")), max_size=8
).map(b"".join)


def compiled_encode(data: bytes) -> bytes:
    encoded = np.empty(cobs.encoded_size_max(len(data)), dtype=np.uint8)
    return encoded[: encode_into(data, encoded)].tobytes()


def compiled_decode(encoded: bytes) -> bytes | None:
    decoded = np.empty(len(encoded), dtype=np.uint8)
    size = decode_into(encoded, decoded)
    return None if size < 0 else decoded[:size].tobytes()


@pytest.mark.parametrize(
    ("data", "encoded"),
    [
        (b"", "01"),
        (b"\x00", "01 01"),
        (b"\x00\x00", "01 01 01"),
        (b"\x11\x22\x00\x33", "03 11 22 02 33"),
        (b"\x11\x22\x33\x44", "05 11 22 33 44"),
        (b"\x11\x00\x00\x00", "02 11 01 01 01"),
        (bytes(range(1, 255)), "ff" + bytes(range(1, 255)).hex()),
        (bytes(range(0, 255)), "01 ff" + bytes(range(1, 255)).hex()),
        (bytes(range(1, 256)), "ff" + bytes(range(1, 255)).hex() + "02 ff"),
        (bytes([*range(2, 256), 0]), "ff" + bytes(range(2, 256)).hex() + "01 01"),
        (bytes([*range(3, 256), 0, 1]), "fe" + bytes(range(3, 256)).hex() + "02 01"),
    ],
)
def test_known_encodings(data: bytes, encoded: str) -> None:
    assert cobs.encode(data) == bytes.fromhex(encoded)
    assert compiled_encode(data) == bytes.fromhex(encoded)
    assert cobs.decode(bytes.fromhex(encoded)) == data


@given(RUNS)
def test_round_trip_without_zeros_within_the_bound(data: bytes) -> None:
    encoded = cobs.encode(data)
    assert 0 not in encoded
    assert len(encoded) <= cobs.encoded_size_max(len(data))
    assert cobs.decode(encoded) == data
    assert compiled_encode(data) == encoded
    assert compiled_decode(encoded) == data


@given(st.one_of(st.binary(max_size=40), RUNS))
def test_compiled_and_plain_agree_on_anything(encoded: bytes) -> None:
    try:
        expected: bytes | None = cobs.decode(encoded)
    except PacketError:
        expected = None
    assert compiled_decode(encoded) == expected
