# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The core takes a layout piece by piece, keeps it, gives it up, and refuses what is none."""

import dataclasses

import numpy as np
import pytest
from core_firmware import CoreFirmware
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.sampling import SkinMap
from acts_core.skin import layout
from acts_core.wire import (
    MAP_PIECE_MAX,
    BoardSettings,
    Reply,
    ReplyStatus,
    encode_configure,
    encode_map_data,
    encode_map_end,
    encode_query,
)
from acts_core.wire.packets import PacketType, seal

pytestmark = pytest.mark.slow

FAST = settings(max_examples=60, deadline=None)
OTHERS = BoardSettings(scheme="tracking", m=99, threshold_counts=7, search_quota=20, led="on", seed=5)


def arrange(firmware: CoreFirmware, skin_map: SkinMap) -> Reply:
    for first in range(0, len(skin_map.taxels), MAP_PIECE_MAX):
        assert firmware.ask(encode_map_data(1, skin_map, first)).ok
    return firmware.ask(encode_map_end(2, skin_map))


@pytest.mark.parametrize("name", ["insole", "glove", "leap_right"])
def test_a_layout_is_taken_kept_and_given_up(name: str) -> None:
    skin_map = SkinMap.of(layout(name))
    with CoreFirmware() as firmware:
        assert firmware.ask(encode_query(1)).state.map_crc32 == 0
        assert arrange(firmware, skin_map).ok
        assert firmware.ask(encode_query(1)).state.map_crc32 == skin_map.crc32
        assert firmware.ask(encode_configure(1, OTHERS)).state.map_crc32 == skin_map.crc32
        # For another matrix it is none.
        assert firmware.ask(encode_configure(1, BoardSettings(rows=30))).state.map_crc32 == 0
        assert firmware.ask(encode_configure(1, OTHERS)).state.map_crc32 == 0
        assert arrange(firmware, skin_map).state.map_crc32 == skin_map.crc32
        assert firmware.ask(encode_map_end(3, None)).state.map_crc32 == 0


def test_the_largest_layout_of_sixteen_patches_fits() -> None:
    patches = tuple((np.arange(4096) // 256).tolist())
    largest = SkinMap(64, 64, tuple(np.random.default_rng(3).permutation(4096).tolist()), patches)
    with CoreFirmware() as firmware:
        assert firmware.ask(encode_configure(1, BoardSettings(rows=64, cols=64))).ok
        assert arrange(firmware, largest).state.map_crc32 == largest.crc32


def test_a_layout_said_twice_disturbs_no_sampling() -> None:
    skin_map, said = SkinMap.of(layout("insole")), BoardSettings(scheme="random", seed=3)
    with CoreFirmware() as firmware, CoreFirmware() as other:
        for one in (firmware, other):
            assert one.ask(encode_configure(1, said)).ok
            assert arrange(one, skin_map).ok
            one.measure()
            one.read()
        assert firmware.ask(encode_map_end(9, skin_map)).ok
        assert firmware.ask(encode_configure(9, said)).ok
        firmware.measure()
        other.measure()
        assert np.array_equal(firmware.read()[0].indices, other.read()[0].indices)


@pytest.mark.parametrize("scheme", ["uniform", "random", "adaptive", "hybrid", "tracking"])
def test_sampling_begins_anew_with_a_layout(scheme: str) -> None:
    skin_map = SkinMap.of(layout("insole"))
    with CoreFirmware() as firmware, CoreFirmware() as other:
        for one in (firmware, other):
            assert one.ask(encode_configure(1, BoardSettings(scheme=scheme, seed=3))).ok
        for _ in range(3):
            firmware.measure()
            firmware.read()
        for one in (firmware, other):
            assert arrange(one, skin_map).ok
            one.measure()
        assert np.array_equal(firmware.read()[0].indices, other.read()[0].indices)


def test_a_picture_with_a_side_that_no_skin_has_is_refused() -> None:
    tall = SkinMap(128, 32, tuple(range(4096)), (0,) * 4096)
    with CoreFirmware() as firmware:
        assert firmware.ask(encode_configure(1, BoardSettings(rows=64, cols=64))).ok
        for one in (tall, dataclasses.replace(tall, rows=32, cols=128)):
            reply = arrange(firmware, one)
            assert (reply.status, reply.state.map_crc32) == (ReplyStatus.MAP_IMPOSSIBLE, 0)


def test_layouts_that_are_none_are_refused_and_leave_the_matrix() -> None:
    skin_map = SkinMap.of(layout("glove"))
    twice = dataclasses.replace(skin_map, taxels=(*skin_map.taxels[:-1], skin_map.taxels[0]))
    beyond = dataclasses.replace(skin_map, taxels=(*skin_map.taxels[:-1], 1024))
    odd = dataclasses.replace(skin_map, no_skin=16)
    small = SkinMap.of_matrix(16, 16)
    with CoreFirmware() as firmware:
        for wrong in (twice, beyond, odd, small):
            reply = arrange(firmware, wrong)
            assert (reply.status, reply.state.map_crc32) == (ReplyStatus.MAP_IMPOSSIBLE, 0)
            assert "layout" in reply.problem
        # Of another map than was sent.
        assert firmware.ask(encode_map_data(1, SkinMap.of(layout("insole")), 0)).ok
        assert firmware.ask(encode_map_end(1, skin_map)).status is ReplyStatus.MAP_IMPOSSIBLE
        for body, status in ((b"\0\0\0", ReplyStatus.BAD_LENGTH), (b"\xff\xff\0\0", ReplyStatus.MAP_IMPOSSIBLE)):
            assert firmware.ask(seal(PacketType.MAP_DATA, bytes(4) + body)).status is status
        assert firmware.ask(seal(PacketType.MAP_DATA, bytes(4) + bytes(5))).status is ReplyStatus.BAD_LENGTH
        firmware.measure()
        assert len(firmware.read()) == 1


@FAST
@given(st.sampled_from([PacketType.MAP_DATA, PacketType.MAP_END]), st.binary(max_size=40))
def test_any_bytes_about_a_layout_get_one_reply(kind: PacketType, body: bytes) -> None:
    with CoreFirmware() as firmware:
        assert isinstance(firmware.ask(seal(kind, bytes(4) + body)), Reply)
        firmware.measure()
        assert len(firmware.read()) == 1
