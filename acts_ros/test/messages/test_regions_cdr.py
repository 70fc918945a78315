# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Regions as bytes, compared with what rclpy itself makes of them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from message_values import DOUBLES, NAMES, NUMBERS, SINGLES, STAMPS_NS
from rclpy.serialization import deserialize_message, serialize_message

from acts_core.errors import PacketError
from acts_core.skin import RegionContact
from acts_msgs.msg import RegionContact as RegionMessage
from acts_msgs.msg import RegionContacts
from acts_ros.messages import RegionsFields, read_regions, write_regions

pytestmark = pytest.mark.slow

VECTORS = st.tuples(DOUBLES, DOUBLES, DOUBLES)
REGIONS = st.builds(
    RegionContact,
    name=NAMES,
    link=NAMES,
    active_taxels=st.integers(0, 2**16 - 1),
    force_n=SINGLES,
    centre_m=VECTORS,
    normal=VECTORS,
    area_m2=SINGLES,
    peak_n=SINGLES,
    spread_m=SINGLES,
    concentration=SINGLES,
    sharpness=SINGLES,
    motion_m_s=VECTORS,
    slip_m=SINGLES,
    slipping=st.booleans(),
)
SKINS = st.builds(
    RegionsFields,
    stamp_ns=STAMPS_NS,
    frame_id=NAMES,
    sequence=NUMBERS,
    regions=st.lists(REGIONS, max_size=4),
)


def message_of(skin: RegionsFields) -> RegionContacts:
    message = RegionContacts(sequence=skin.sequence)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(skin.stamp_ns, 10**9)
    message.header.frame_id = skin.frame_id
    for region in skin.regions:
        entry = RegionMessage(name=region.name, link=region.link, active_taxels=region.active_taxels)
        entry.force, entry.area, entry.peak = region.force_n, region.area_m2, region.peak_n
        entry.spread, entry.concentration = region.spread_m, region.concentration
        entry.sharpness = region.sharpness
        entry.slip, entry.slipping = region.slip_m, region.slipping
        entry.centre.x, entry.centre.y, entry.centre.z = region.centre_m
        entry.normal.x, entry.normal.y, entry.normal.z = region.normal
        entry.motion.x, entry.motion.y, entry.motion.z = region.motion_m_s
        message.regions = [*message.regions, entry]
    return message


@given(SKINS)
def test_regions_are_written_as_rclpy_writes_them(skin: RegionsFields) -> None:
    data, message = write_regions(skin), message_of(skin)
    assert len(data) == len(serialize_message(message))
    # As text, in which one NaN is like another. The bytes differ where fields are padded.
    assert repr(deserialize_message(data, RegionContacts)) == repr(message)


@given(SKINS)
def test_regions_of_rclpy_are_read(skin: RegionsFields) -> None:
    assert repr(read_regions(serialize_message(message_of(skin)))) == repr(skin)


@given(SKINS, st.data())
def test_what_was_cut_off_is_refused(skin: RegionsFields, data: st.DataObject) -> None:
    whole = write_regions(skin)
    with pytest.raises(PacketError, match=r"cannot be read|encoded as"):
        read_regions(whole[: data.draw(st.integers(0, len(whole) - 1))])


@given(st.binary(max_size=300))
def test_any_bytes_are_read_or_refused(data: bytes) -> None:
    for bytes_ in (data, b"\x00\x01\x00\x00" + data):
        try:
            read_regions(bytes_)
        except PacketError as error:
            assert str(error)  # noqa: PT017 - either way is right


def test_a_message_that_says_it_has_many_regions_is_refused_at_once() -> None:
    data = bytearray(write_regions(RegionsFields(0, "skin", 1, [])))
    data[-4:] = b"\xff\xff\xff\xff"
    with pytest.raises(PacketError, match="cannot be read"):
        read_regions(bytes(data))


@pytest.mark.parametrize("change", [{"force_n": 1e39}, {"active_taxels": 70000}])
def test_numbers_beyond_their_field_are_refused(change: dict[str, float]) -> None:
    region = RegionContact("palm", "palm_lower")._replace(**change)  # type: ignore[arg-type]
    with pytest.raises(PacketError, match="do not fit the message"):
        write_regions(RegionsFields(0, "skin", 0, [region]))
