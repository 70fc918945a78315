# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Protocol 2.0: packets written and found again, whatever is in them and between them."""

from hypothesis import given
from hypothesis import strategies as st

from acts_sim.dynamixel.packets import (
    BROADCAST_ID,
    Instruction,
    Packet,
    PacketReader,
    crc16,
    encode,
    encode_fast_status,
    stuff,
    unstuff,
)

# Bytes that often make up a header, so that stuffing is needed.
_NASTY = st.binary(max_size=40) | st.lists(st.sampled_from([0xFF, 0xFD, 0x00, 0x55]), max_size=40).map(bytes)
_INSTRUCTIONS = st.sampled_from([one for one in Instruction if one is not Instruction.STATUS])


def test_the_crc_is_that_of_the_examples_in_the_manual() -> None:
    # Ping of motor 1, and the read of 4 bytes at 132 of motor 1.
    assert encode(1, Instruction.PING).hex(" ") == "ff ff fd 00 01 03 00 01 19 4e"
    read = encode(1, Instruction.READ, bytes([132, 0, 4, 0]))
    assert read.hex(" ") == "ff ff fd 00 01 07 00 02 84 00 04 00 1d 15"


@given(_NASTY)
def test_stuffing_is_undone_and_leaves_no_header(body: bytes) -> None:
    assert unstuff(stuff(body)) == body
    assert b"\xff\xff\xfd\x00" not in stuff(body)


@given(st.lists(st.tuples(st.integers(0, 0xFE), _INSTRUCTIONS, _NASTY), max_size=5), st.data())
def test_packets_are_found_however_the_stream_is_cut(
    sent: list[tuple[int, Instruction, bytes]], data: st.DataObject
) -> None:
    stream = b"".join(encode(*packet) for packet in sent)
    reader, found = PacketReader(), []
    while stream:
        size = data.draw(st.integers(1, len(stream)))
        found += reader.feed(stream[:size])
        stream = stream[size:]
    assert found == [Packet(*packet) for packet in sent]
    assert reader.damaged == 0


@given(st.binary(max_size=60), _NASTY)
def test_noise_before_a_packet_costs_at_most_the_noise(noise: bytes, parameters: bytes) -> None:
    reader = PacketReader()
    reader.feed(noise)
    reader.forget()
    assert reader.feed(encode(7, Instruction.WRITE, parameters)) == [Packet(7, Instruction.WRITE, parameters)]


def test_a_packet_that_was_cut_does_not_take_the_next_one_with_it() -> None:
    reader = PacketReader()
    whole = encode(3, Instruction.READ, bytes([132, 0, 4, 0]))
    found = reader.feed(whole[:9] + whole + whole)
    assert found == [Packet(3, Instruction.READ, bytes([132, 0, 4, 0]))] * 2
    assert reader.damaged == 1


@given(st.binary(max_size=20), st.integers(0, 500))
def test_a_damaged_packet_is_never_taken(parameters: bytes, bit: int) -> None:
    packet = bytearray(encode(3, Instruction.WRITE, parameters))
    bit %= 8 * len(packet)
    packet[bit // 8] ^= 1 << bit % 8
    assert PacketReader().feed(bytes(packet)) == []


def test_each_part_of_a_fast_reply_ends_with_the_crc_up_to_there() -> None:
    reply = encode_fast_status([(1, 0, b"\x01\x02"), (2, 0x80, b"\x03\x04")], 12)
    assert reply[4] == BROADCAST_ID
    assert reply[7] == Instruction.STATUS
    assert int.from_bytes(reply[5:7], "little") == len(reply) - 7
    assert reply[8:12] == b"\x00\x01\x01\x02"
    assert reply[12:14] == crc16(reply[:12]).to_bytes(2, "little")
    assert reply[14:18] == b"\x80\x02\x03\x04"
    assert reply[18:] == crc16(reply[:18]).to_bytes(2, "little")
