# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The core carries out the commands that `acts_core` encodes, and its replies say so."""

import dataclasses
import itertools
import struct
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path

import pytest
from core_firmware import BOARD_ID, CoreFirmware
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.errors import PacketError
from acts_core.frames import Scheme
from acts_core.sampling import BOARD_OWN_SETTINGS, SCHEME_NUMBERS
from acts_core.wire import (
    LEDS,
    BoardSettings,
    Reply,
    ReplyStatus,
    cobs,
    encode_configure,
    encode_query,
)
from acts_core.wire.board_settings import SETTINGS_SIZE
from acts_core.wire.commands import NO_MODEL, SettingField
from acts_core.wire.packets import PacketType, seal

pytestmark = pytest.mark.slow

FAST = settings(max_examples=60, deadline=None)
# Own settings of schemes beyond those that stand below by name.
FURTHER = [own for number, own in BOARD_OWN_SETTINGS.items() if number > 16]
LAYOUT = struct.Struct(f"<BBBBHHHHHBBIQHHH{len(FURTHER)}H")
# All but the seed have a range.
FIELDS = 15 + len(FURTHER)
LAST_SCHEME = max(SCHEME_NUMBERS.values())
OTHERS = BoardSettings(scheme="tracking", m=99, threshold_counts=7, search_quota=20, led="on", seed=5)


@st.composite
def raw_settings(draw: st.DrawFn) -> bytes:
    """Half of them allowed; of the others some fields are beyond their range."""
    odd = draw(st.just(set()) | st.sets(st.integers(0, FIELDS - 1), min_size=1, max_size=4))
    field = itertools.count()

    def number(first: int, last: int, largest: int) -> int:
        beyond = [
            value for value in (first - 1, last + 1, largest) if 0 <= value <= largest and not first <= value <= last
        ]
        if next(field) in odd and beyond:
            return draw(st.sampled_from(beyond))
        return draw(st.one_of(st.integers(first, last), st.integers(first, last), st.sampled_from((first, last))))

    rows, cols = number(1, 64, 255), number(1, 64, 255)
    scheme, order = number(1, LAST_SCHEME, 255), number(0, 1, 255)
    m = number(1, max(1, min(rows * cols, 4096)), 0xFFFF)
    return LAYOUT.pack(
        rows,
        cols,
        scheme,
        order,
        m,
        number(0, 1023, 0xFFFF),
        number(1, max(1, min(m, 4096)), 0xFFFF),
        number(1, max(1, min(m, 4096)), 0xFFFF),
        number(0, 1023, 0xFFFF),
        number(0, 2, 255),
        number(0, 3, 255),
        number(0, 1_000_000, 2**32 - 1),
        draw(st.integers(0, 2**64 - 1)),
        number(0, max(rows - 1, 0), 0xFFFF),
        number(0, max(cols - 1, 0), 0xFFFF),
        number(0, 4096, 0xFFFF),
        *(number(own.minimum, own.maximum, 0xFFFF) for own in FURTHER),
    )


def configure(raw: bytes) -> bytes:
    return seal(PacketType.CONFIGURE, struct.pack("<I", 1) + raw)


@settings(max_examples=300, deadline=None)
@given(raw_settings())
def test_core_and_reference_take_the_same_settings(raw: bytes) -> None:
    try:
        wanted = BoardSettings.from_bytes(raw)
    except PacketError:
        wanted = None
    with CoreFirmware() as firmware:
        before = firmware.ask(encode_query(0)).state.settings
        reply = firmware.ask(configure(raw))
        if wanted is None:
            assert reply.status is ReplyStatus.SETTING_REFUSED
            assert SettingField(reply.detail) in SettingField
            assert reply.state.settings == before
        else:
            assert (reply.status, reply.detail) == (ReplyStatus.OK, 0)
            assert reply.state.settings == wanted
            firmware.measure()
            (frame,) = firmware.read()
            assert (frame.rows, frame.cols, frame.scheme) == (wanted.rows, wanted.cols, SCHEME_NUMBERS[wanted.scheme])
            assert len(frame.indices) == wanted.frame_size


@pytest.mark.parametrize(
    ("field", "position", "value"),
    [
        (SettingField.ROWS, 0, 65),
        (SettingField.COLS, 1, 0),
        (SettingField.SCHEME, 2, LAST_SCHEME + 1),
        (SettingField.NEIGHBOUR_ORDER, 3, 2),
        (SettingField.M, 4, 1025),
        (SettingField.THRESHOLD_COUNTS, 5, 1024),
        (SettingField.SEARCH_QUOTA, 6, 4097),
        (SettingField.ADAPTIVE_QUOTA, 7, 4097),
        (SettingField.TOUCH_COUNTS, 8, 1024),
        (SettingField.OUTPUT, 9, 3),
        (SettingField.LED, 10, 4),
        (SettingField.FRAME_PERIOD_US, 11, 1_000_001),
        (SettingField.FIXED_ROW, 13, 64),
        (SettingField.FIXED_COL, 14, 64),
        (SettingField.FIXED_TAXELS, 15, 4097),
    ],
)
def test_a_refused_setting_is_named_and_changes_nothing(field: SettingField, position: int, value: int) -> None:
    values = list(LAYOUT.unpack(dataclasses.replace(OTHERS, output="image", m=77, frame_period_us=5).to_bytes()))
    values[position] = value
    with CoreFirmware() as firmware, CoreFirmware() as other:
        for one in (firmware, other):
            assert one.ask(encode_configure(1, OTHERS)).ok
            one.measure(500)
        reply = firmware.ask(configure(LAYOUT.pack(*values)))
        assert (reply.status, reply.detail) == (ReplyStatus.SETTING_REFUSED, field)
        assert field.name.lower() in reply.problem
        assert reply.state.settings == OTHERS
        # Tracking remembers what was pressed: it has not been disturbed either.
        for one in (firmware, other):
            one.read()
            one.measure(500)
        assert firmware.read()[0].indices.tolist() == other.read()[0].indices.tolist()


def test_a_quota_is_refused_by_its_scheme() -> None:
    for scheme, field in ((Scheme.TRACKING, SettingField.SEARCH_QUOTA), (Scheme.HYBRID, SettingField.ADAPTIVE_QUOTA)):
        values = list(LAYOUT.unpack(BoardSettings(m=20, search_quota=21, adaptive_quota=21).to_bytes()))
        values[2] = int(scheme)
        with CoreFirmware() as firmware:
            assert firmware.ask(configure(LAYOUT.pack(*values))).detail == field


def test_a_taxel_outside_of_the_array_is_refused_by_its_scheme() -> None:
    for field in (SettingField.FIXED_ROW, SettingField.FIXED_COL):
        values = list(LAYOUT.unpack(BoardSettings(rows=9, cols=9, m=5).to_bytes()))
        values[13 + field - SettingField.FIXED_ROW] = 9
        with CoreFirmware() as firmware:
            assert firmware.ask(configure(LAYOUT.pack(*values))).ok
            values[2] = int(Scheme.FIXED)
            assert firmware.ask(configure(LAYOUT.pack(*values))).detail == field


def test_an_array_larger_than_the_board_is_refused() -> None:
    with CoreFirmware(side=32) as firmware:
        assert firmware.ask(encode_configure(1, BoardSettings(rows=33))).detail == SettingField.ROWS
        assert firmware.ask(encode_configure(1, BoardSettings(cols=33))).detail == SettingField.COLS


def test_other_settings_leave_sampling_undisturbed() -> None:
    with CoreFirmware() as firmware, CoreFirmware() as other:
        for one in (firmware, other):
            one.ask(encode_configure(1, BoardSettings(scheme="random")))
            one.measure()
        firmware.ask(encode_configure(2, BoardSettings(scheme="random", led="on", frame_period_us=7)))
        other.read()
        for one in (firmware, other):
            one.measure()
        assert firmware.read()[0].indices.tolist() == other.read()[0].indices.tolist()


def test_a_reply_tells_the_whole_state() -> None:
    version = ElementTree.parse(Path(__file__).parents[2] / "package.xml").findtext("version")
    with CoreFirmware() as firmware:
        firmware.measure()
        reply = firmware.ask(encode_query(0xFFFFFFFF))
        state = reply.state
        assert (reply.request, reply.command, reply.status, reply.detail) == (0xFFFFFFFF, 16, ReplyStatus.OK, 0)
        assert ".".join(map(str, state.firmware_version)) == version
        assert state.board_id == BOARD_ID
        assert state.uptime_us == 550
        assert state.settings == BoardSettings()
        assert (state.model, state.model_capacity_bytes) == (NO_MODEL, 262_144)
        assert (state.samples_only, state.uploading, state.overruns, state.bad_commands) == (False, False, 0, 0)


def test_settings_outlive_a_reconnection() -> None:
    with CoreFirmware() as firmware:
        firmware.ask(encode_configure(1, OTHERS))
        firmware.receive(b"half a packet")
        firmware.stop_stream()
        firmware.start_stream()
        reply = firmware.ask(encode_query(2))
        assert (reply.state.settings, reply.state.bad_commands) == (OTHERS, 0)


def test_commands_count_though_nobody_reads() -> None:
    with CoreFirmware() as firmware:
        firmware.stop_stream()
        assert firmware.replies(encode_configure(1, OTHERS)) == []
        firmware.start_stream()
        assert firmware.ask(encode_query(2)).state.settings == OTHERS


@pytest.mark.parametrize(
    ("kind", "version", "body", "told", "status"),
    [
        (23, 1, b"", 0, ReplyStatus.UNKNOWN_COMMAND),
        (255, 1, b"anything", 0, ReplyStatus.UNKNOWN_COMMAND),
        (16, 2, b"", 0, ReplyStatus.WRONG_VERSION),
        (99, 2, b"", 0, ReplyStatus.WRONG_VERSION),
        (16, 1, b"x", 0, ReplyStatus.BAD_LENGTH),
        (17, 1, bytes(SETTINGS_SIZE - 1), 0, ReplyStatus.BAD_LENGTH),
        (17, 1, OTHERS.to_bytes(), 1, ReplyStatus.BAD_LENGTH),
        (18, 1, bytes(15), 0, ReplyStatus.BAD_LENGTH),
        (19, 1, bytes(4), 0, ReplyStatus.BAD_LENGTH),
        (20, 1, bytes(4), 0, ReplyStatus.BAD_LENGTH),
        (21, 1, bytes(2), 0, ReplyStatus.BAD_LENGTH),
        (22, 1, bytes(7), 0, ReplyStatus.BAD_LENGTH),
    ],
)
def test_commands_that_cannot_be(kind: int, version: int, body: bytes, told: int, status: ReplyStatus) -> None:
    packet = struct.pack("<BBHI", kind, version, 12 + len(body) + told, 77) + body
    with CoreFirmware() as firmware:
        reply = firmware.ask(cobs.encode(packet + struct.pack("<I", zlib.crc32(packet))) + b"\0")
        assert (reply.request, reply.command, reply.status, reply.detail) == (77, kind, status, 0)
        assert reply.state.settings == BoardSettings()
        assert reply.state.bad_commands == 0


def test_what_the_board_says_itself_is_no_command() -> None:
    # Else a terminal that echoes would keep the two talking for ever.
    with CoreFirmware() as firmware:
        echo = seal(PacketType.REPLY, bytes(84)) + seal(PacketType.SAMPLES, bytes(40))
        assert firmware.replies(echo) == []
        assert firmware.ask(encode_query(1)).state.bad_commands == 2


@FAST
@given(st.lists(st.binary(max_size=1500), max_size=6), st.data())
def test_garbage_changes_nothing(garbage: list[bytes], data: st.DataObject) -> None:
    with CoreFirmware() as firmware:
        assert firmware.ask(encode_configure(1, OTHERS)).ok
        for piece in garbage:
            assert firmware.replies(piece + b"\0" * data.draw(st.integers(0, 2))) == []
        firmware.receive(b"\0")
        reply = firmware.ask(encode_query(2))
        assert reply.state.settings == OTHERS
        assert reply.state.model == NO_MODEL
        assert firmware.ask(encode_configure(3, BoardSettings())).state.settings == BoardSettings()


@settings(max_examples=200, deadline=None)
@given(raw_settings(), st.sets(st.integers(0, 2**10), min_size=1, max_size=6), st.integers(0, 60))
def test_a_damaged_command_gets_no_reply_and_changes_nothing(raw: bytes, bits: set[int], cut: int) -> None:
    command = bytearray(configure(raw)[:-1])
    for bit in {bit % (8 * len(command)) for bit in bits}:
        command[bit // 8] ^= 1 << bit % 8
    with CoreFirmware() as firmware:
        before = firmware.ask(encode_query(0)).state
        # A cut anywhere makes no difference.
        assert firmware.replies(bytes(command[:cut])) == []
        assert firmware.replies(bytes(command[cut:]) + b"\0") == []
        reply = firmware.ask(encode_query(1))
        assert reply.state.settings == before.settings
        assert reply.state.bad_commands >= 1


def test_endless_packets_are_one_bad_command() -> None:
    with CoreFirmware() as firmware:
        firmware.receive(b"\x55" * 100_000 + b"\0")
        assert firmware.ask(encode_query(1)).state.bad_commands == 1


def test_replies_wait_where_the_queue_is_full_and_none_is_lost() -> None:
    with CoreFirmware() as firmware:
        firmware.ask(encode_configure(0, BoardSettings(scheme="raster")))
        for _ in range(40):
            firmware.measure()
        firmware.messages.clear()
        for request in range(20):
            firmware.receive(encode_configure(request, BoardSettings(m=request + 1)))
        frames = firmware.read()
        assert len(frames) < 40
        firmware.measure()
        (last,) = firmware.read()
        # Nothing says how many the little room behind the last frame took; all are there now, in order.
        replies = [message for message in firmware.messages if isinstance(message, Reply)]
        assert [reply.request for reply in replies] == list(range(20))
        assert replies[-1].state.settings.m == len(last.indices) == 20
        assert last.overruns == 40 - len(frames)


def test_commands_whose_replies_find_no_room_are_not_carried_out() -> None:
    with CoreFirmware() as firmware:
        firmware.ask(encode_configure(0, BoardSettings(scheme="raster")))
        while not firmware.decoder.frames:
            for _ in range(40):
                firmware.measure()
            firmware.messages.clear()
            for request in range(1, 1001):
                firmware.receive(encode_configure(request, BoardSettings(frame_period_us=request)))
            firmware.read()
        firmware.measure()
        firmware.read()
        replies = [message for message in firmware.messages if isinstance(message, Reply)]
        assert [reply.request for reply in replies] == list(range(1, len(replies) + 1))
        assert len(replies) < 1000
        state = firmware.ask(encode_query(0)).state
        assert state.settings.frame_period_us == len(replies)
        assert state.bad_commands == 1000 - len(replies)


def test_the_led_shows_what_it_is_told() -> None:
    with CoreFirmware() as firmware:
        shown = {}
        for led in LEDS:
            firmware.ask(encode_configure(1, BoardSettings(led=led, touch_counts=100)))
            states = []
            for counts in [100, 101] * 128:
                firmware.measure(counts)
                states.append(firmware.led)
            shown[led] = states
        assert set(shown["off"]) == {False}
        assert set(shown["on"]) == {True}
        assert shown["frames"] == [False] * 128 + [True] * 128
        assert shown["touch"] == [False, True] * 128
        firmware.ask(encode_configure(1, BoardSettings(led="off")))
        assert not firmware.led  # at once
