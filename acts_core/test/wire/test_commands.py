# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Commands, replies, images and objects: byte by byte, there and back, and what garbage does to them."""

import dataclasses
import struct
import zlib
from itertools import pairwise
from typing import TypeAlias

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.errors import ArrayError, PacketError, SettingsError
from acts_core.frames import SampleFrame, Scheme
from acts_core.sampling import BOARD_OWN_SETTINGS, SCHEME_NUMBERS, OwnSetting, SamplingConfig
from acts_core.settings import describe
from acts_core.wire import (
    LEDS,
    OUTPUTS,
    UPLOAD_PIECE_MAX,
    BoardImage,
    BoardMessage,
    BoardObject,
    BoardState,
    Reply,
    ReplyStatus,
    StreamDecoder,
    UnknownReply,
    cobs,
    encode_configure,
    encode_frame,
    encode_query,
    encode_upload_begin,
    encode_upload_data,
    encode_upload_end,
    object_library,
    patch_dictionary,
)
from acts_core.wire.board_models import MODEL_CAPACITY, ModelKind
from acts_core.wire.board_settings import SETTINGS_SIZE
from acts_core.wire.commands import NO_MODEL, BoardSettings, HeldModel, SettingField, encode_reply
from acts_core.wire.packets import PacketType, seal, stuffed

pytestmark = pytest.mark.slow

KnownMessage: TypeAlias = Reply | BoardImage | BoardObject

U8, U16, U32, U64 = (st.integers(0, 2**bits - 1) for bits in (8, 16, 32, 64))


def values_of(own: OwnSetting, rows: int, cols: int, m: int) -> st.SearchStrategy[int]:
    """What a board takes as a scheme's own setting, whatever the scheme."""
    if own.share:
        return st.integers(1, m)
    return st.integers(own.minimum, {"rows": rows - 1, "cols": cols - 1}.get(own.below, own.maximum))


@st.composite
def board_settings(draw: st.DrawFn) -> BoardSettings:
    rows, cols = draw(st.integers(1, 64)), draw(st.integers(1, 64))
    m = draw(st.integers(1, rows * cols))
    return BoardSettings(
        rows=rows,
        cols=cols,
        scheme=draw(st.sampled_from([scheme for scheme in SCHEME_NUMBERS if scheme != "uniform"])),
        neighbour_order=draw(st.sampled_from(["columns", "rows"])),
        m=m,
        threshold_counts=draw(st.integers(0, 1023)),
        touch_counts=draw(st.integers(0, 1023)),
        output=draw(st.sampled_from(OUTPUTS)),
        led=draw(st.sampled_from(LEDS)),
        frame_period_us=draw(st.integers(0, 1_000_000)),
        seed=draw(U64),
        **{own.name: draw(values_of(own, rows, cols, m)) for own in BOARD_OWN_SETTINGS.values()},
    )


KINDS = st.sampled_from([kind for kind in ModelKind if kind is not ModelKind.NONE])
HELD = st.just(NO_MODEL) | st.builds(HeldModel, KINDS, U16, U16, U8, U8, U8, U32)
STATES = st.builds(
    BoardState, st.tuples(U8, U8, U8), U64, U64, board_settings(), st.booleans(), st.booleans(), HELD, U32, U32, U32
)
REPLIES = st.builds(Reply, U32, U8, st.sampled_from(ReplyStatus), U32, STATES)


@st.composite
def images(draw: st.DrawFn) -> BoardImage:
    shape = draw(st.tuples(st.integers(1, 64), st.integers(1, 64)))
    random = np.random.default_rng(draw(U32))
    return BoardImage(draw(U32), draw(U64), draw(U32), random.integers(0, 1024, shape).astype(np.uint16))


@st.composite
def objects(draw: st.DrawFn) -> BoardObject:
    residuals = np.array(draw(st.lists(st.floats(0, 2.0**127, width=32), min_size=1, max_size=64)), dtype=np.float32)
    number = draw(st.none() | st.integers(0, len(residuals) - 1))
    return BoardObject(draw(U32), draw(U64), draw(U32), number, residuals)


MESSAGES = st.one_of(REPLIES, images(), objects())


def encoded(message: KnownMessage) -> bytes:
    """As a board sends it; images and objects are put together as docs/wire_protocol.md describes them."""
    if isinstance(message, Reply):
        return encode_reply(message)
    head = struct.pack("<IQI", message.sequence, message.board_us, message.duration_us)
    if isinstance(message, BoardImage):
        size = struct.pack("<BBH", *message.counts.shape, 0)
        return seal(PacketType.IMAGE, head + size + message.counts.astype("<u2").tobytes())
    number = 0xFF if message.number is None else message.number
    size = struct.pack("<BBH", number, len(message.residuals), 0)
    return seal(PacketType.OBJECT, head + size + message.residuals.astype("<f4").tobytes())


def same(one: BoardMessage, other: BoardMessage) -> bool:
    return type(one) is type(other) and all(
        np.array_equal(getattr(one, field.name), getattr(other, field.name)) for field in dataclasses.fields(one)
    )


def unstuffed(wire: bytes) -> bytes:
    assert wire.endswith(b"\0")
    assert wire.count(b"\0") == 1
    return cobs.decode(wire[:-1])


def command(kind: int, request: int, body: bytes) -> bytes:
    """A command put together without the encoder under test."""
    packet = struct.pack("<BBHI", kind, 1, 12 + len(body), request) + body
    return packet + struct.pack("<I", zlib.crc32(packet))


def example_reply(**changes: object) -> Reply:
    state = BoardState((1, 2, 3), 4, 5, BoardSettings(), False, False, HeldModel(ModelKind.NONE, *[0] * 6), 6, 7, 8)
    return dataclasses.replace(Reply(9, 16, ReplyStatus.OK, 0, state), **changes)  # type: ignore[arg-type]


def test_commands_byte_by_byte() -> None:
    settings = BoardSettings(
        rows=16,
        cols=64,
        scheme="tracking",
        neighbour_order="rows",
        m=0x0201,
        threshold_counts=0x0304,
        search_quota=0x0105,
        adaptive_quota=0x0106,
        touch_counts=0x0107,
        output="object",
        led="touch",
        frame_period_us=0x00010203,
        seed=0x1122334455667788,
        fixed_row=0x0008,
        fixed_col=0x0009,
        fixed_taxels=0x010A,
    )
    body = bytes.fromhex("10 40 06 01 01 02 04 03 05 01 06 01 07 01 02 03 03 02 01 00 88 77 66 55 44 33 22 11")
    body += bytes.fromhex("08 00 09 00 0A 01")
    body += b"".join(struct.pack("<H", own.default) for number, own in BOARD_OWN_SETTINGS.items() if number > 16)
    assert unstuffed(encode_query(0x01020304)) == command(16, 0x01020304, b"")
    assert unstuffed(encode_configure(1, settings)) == command(17, 1, body)
    model = patch_dictionary(np.arange(12).reshape(4, 3), patch_step=1)
    begin = struct.pack("<BBBBHHII", 1, 2, 1, 0, 4, 3, 48, zlib.crc32(model.payload))
    assert unstuffed(encode_upload_begin(2, model)) == command(18, 2, begin)
    assert unstuffed(encode_upload_data(3, 0x0400, b"abc")) == command(19, 3, b"\0\4\0\0abc")
    assert unstuffed(encode_upload_end(2**32 + 4)) == command(20, 4, b"")


@given(board_settings())
def test_settings_round_trip(settings: BoardSettings) -> None:
    assert BoardSettings.from_bytes(settings.to_bytes()) == settings


def with_bytes(settings: BoardSettings, changed: dict[int, int]) -> bytes:
    data = bytearray(settings.to_bytes())
    for place, value in changed.items():
        data[place] = value
    return bytes(data)


PLACES = st.integers(0, SETTINGS_SIZE - 1)
NEAR_SETTINGS = st.builds(with_bytes, board_settings(), st.dictionaries(PLACES, st.integers(0, 255), max_size=2))


@given(NEAR_SETTINGS | st.binary(min_size=SETTINGS_SIZE, max_size=SETTINGS_SIZE))
def test_settings_from_any_bytes_are_valid_or_refused(data: bytes) -> None:
    try:
        settings = BoardSettings.from_bytes(data)
    except PacketError:
        return
    assert settings.to_bytes() == data


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"m": 1025}, "m = 1025: an array of 32 x 32"),
        ({"scheme": "uniform", "m": 53}, "no uniform grid"),
        ({"scheme": "tracking", "search_quota": 56}, "search_quota = 56: allowed is 1 to m = 55"),
        ({"scheme": "hybrid", "adaptive_quota": 0}, "adaptive_quota = 0"),
        ({"scheme": "fixed", "fixed_row": 32}, "fixed_row = 32: allowed is 0 to 31 of a fixed frame of 32 x 32"),
        ({"scheme": "fixed", "cols": 9, "fixed_col": 9}, "fixed_col = 9: allowed is 0 to 8 "),
        ({"scheme": "spiral"}, "one of adaptive"),
        ({"output": "video"}, "one of samples, image, object"),
        ({"frame_period_us": 1_000_001}, "0 to 1000000 "),
        ({"seed": -1}, "seed"),
    ],
)
def test_settings_that_cannot_be_are_refused(values: dict[str, object], words: str) -> None:
    with pytest.raises(SettingsError, match=words):
        BoardSettings(**values)  # type: ignore[arg-type]


def test_settings_of_a_sampling_config() -> None:
    config = SamplingConfig("tracking", 16, 24, 100, 200, "rows", 7, search_share=0.5, adaptive_share=0.25)
    settings = BoardSettings.from_sampling(config)
    assert (settings.rows, settings.cols, settings.m, settings.threshold_counts) == (16, 24, 100, 200)
    assert (settings.search_quota, settings.adaptive_quota, settings.seed) == (50, 25, 7)
    assert (settings.scheme, settings.neighbour_order, settings.led) == ("tracking", "rows", "frames")
    assert BoardSettings.from_sampling(SamplingConfig()) == BoardSettings()


def test_every_setting_has_a_number() -> None:
    assert sorted(field.name.lower() for field in SettingField) == sorted(describe(BoardSettings))
    assert [int(field) for field in SettingField] == list(range(1, len(SettingField) + 1))


@given(st.lists(MESSAGES, max_size=4), st.lists(st.integers(0, 2000), max_size=6))
def test_messages_round_trip_between_frames(sent: list[KnownMessage], cuts: list[int]) -> None:
    frame = SampleFrame(1, 2, 3, Scheme.RASTER, 1, 1, 0, np.zeros(1, np.uint16), np.ones(1, np.uint16))
    received: list[BoardMessage] = []
    decoder = StreamDecoder(on_message=received.append)
    stream = b"".join(encode_frame(frame) + encoded(message) for message in sent)
    edges = [0, *sorted(min(cut, len(stream)) for cut in cuts), len(stream)]
    frames = [found for start, end in pairwise(edges) for found in decoder.feed(stream[start:end])]
    assert len(received) == len(sent)
    assert all(map(same, received, sent))
    assert len(frames) == decoder.frames == decoder.messages == len(sent)
    assert decoder.crc_errors == decoder.malformed == 0


@given(MESSAGES, st.sets(st.integers(0, 2**17), min_size=1, max_size=8))
def test_flipped_bits_never_yield_a_wrong_message(sent: KnownMessage, bits: set[int]) -> None:
    stream = bytearray(encoded(sent))
    for bit in {bit % (8 * len(stream)) for bit in bits}:
        stream[bit // 8] ^= 1 << bit % 8
    received: list[BoardMessage] = []
    decoder = StreamDecoder(on_message=received.append)
    assert decoder.feed(bytes(stream) + b"\0") == []
    assert received == []
    assert decoder.crc_errors + decoder.malformed >= 1
    decoder.feed(encoded(sent))
    assert len(received) == 1
    assert same(received[0], sent)


@given(st.sampled_from([PacketType.REPLY, PacketType.IMAGE, PacketType.OBJECT]), st.binary(max_size=120))
def test_any_content_is_decoded_or_malformed(kind: PacketType, content: bytes) -> None:
    decoder = StreamDecoder()
    assert decoder.feed(seal(kind, content)) == []
    assert decoder.messages + decoder.malformed == 1
    assert decoder.crc_errors == 0


def test_a_command_that_comes_back_is_told_as_such() -> None:
    """It was told to be of firmware of another release."""
    decoder = StreamDecoder()
    for command in (encode_query(1), encode_configure(2, BoardSettings())):
        decoder.feed(command)
        assert "what the host sends comes back" in decoder.last_error
    assert (decoder.malformed, decoder.messages) == (2, 0)


def test_messages_without_a_listener_are_counted() -> None:
    decoder = StreamDecoder()
    assert decoder.feed(encode_reply(example_reply())) == []
    assert (decoder.frames, decoder.messages, decoder.malformed) == (0, 1, 0)


@pytest.mark.parametrize(
    ("offset", "value", "words"),
    [
        (5, 99, "status 99"),
        (6, 1, "reserved 1"),
        (15, 4, "flags 4"),
        (34, 99, "scheme 99"),
        (36, 0, "m = 0"),
        (66, 99, "model of kind 99"),
    ],
)
def test_replies_of_another_release_are_malformed(offset: int, value: int, words: str) -> None:
    content = bytearray(unstuffed(encode_reply(example_reply()))[4:-4])
    content[offset] = value
    decoder = StreamDecoder()
    decoder.feed(seal(PacketType.REPLY, bytes(content)))
    assert decoder.malformed == 1
    assert words in decoder.last_error
    assert "same release" in decoder.last_error


@pytest.mark.parametrize("apart", [-1, 1])
def test_a_reply_that_says_that_it_has_another_length_is_malformed(apart: int) -> None:
    packet = bytearray(unstuffed(encode_reply(example_reply()))[:-4])
    packet[2:4] = struct.pack("<H", len(packet) + 4 + apart)
    decoder = StreamDecoder()
    decoder.feed(stuffed(bytes(packet)))
    assert (decoder.messages, decoder.malformed) == (0, 1)
    assert decoder.last_error == f"packet of {len(packet) + 4} bytes says it has {len(packet) + 4 + apart}"


def test_of_a_reply_of_another_release_is_known_who_answers_what() -> None:
    """Firmware that has a setting more, whatever comes of the rest."""
    content = unstuffed(encode_reply(example_reply()))[4:-4]
    received: list[BoardMessage] = []
    decoder = StreamDecoder(on_message=received.append)
    decoder.feed(seal(PacketType.REPLY, content[:66] + bytes(2) + content[66:]))
    assert received == [UnknownReply(9, (1, 2, 3), decoder.last_error)]
    assert f"reply of {len(content) + 2} bytes" in decoder.last_error
    assert (decoder.messages, decoder.malformed) == (0, 1)
    # Too short even for that.
    decoder.feed(seal(PacketType.REPLY, content[:31]))
    assert (len(received), decoder.malformed) == (1, 2)


def test_a_reply_with_two_settings_less_is_not_read_as_one_without_the_layout() -> None:
    """It has that length: of a board without a scheme of two settings that this host has."""
    state = dataclasses.replace(example_reply().state, map_crc32=5)
    content = unstuffed(encode_reply(example_reply(state=state)))[4:-4]
    end = 32 + SETTINGS_SIZE
    received: list[BoardMessage] = []
    decoder = StreamDecoder(on_message=received.append)
    decoder.feed(seal(PacketType.REPLY, content[: end - 4] + content[end:]))
    assert [type(message) for message in received] == [UnknownReply]
    assert "with the same schemes" in decoder.last_error


def test_replies_say_what_is_wrong() -> None:
    assert example_reply().ok
    assert example_reply().problem == ""
    refused = example_reply(status=ReplyStatus.SETTING_REFUSED, detail=7)
    assert not refused.ok
    assert "search_quota" in refused.problem
    assert "number 99" in example_reply(status=ReplyStatus.SETTING_REFUSED, detail=99).problem
    assert "byte 512" in example_reply(status=ReplyStatus.UPLOAD_OUT_OF_ORDER, detail=512).problem
    assert all(example_reply(status=status).problem for status in ReplyStatus if status is not ReplyStatus.OK)


def test_models() -> None:
    dictionary = patch_dictionary(np.ones((64, 1000)))
    assert (dictionary.kind, dictionary.rows, dictionary.columns) == (ModelKind.PATCH_DICTIONARY, 64, 1000)
    assert (dictionary.patch_side, dictionary.patch_step, len(dictionary.payload)) == (8, 4, 256_000)
    library = object_library(np.arange(12.0).reshape(4, 3), [0, 1, 0])
    assert library.payload == np.arange(12, dtype="<f4").tobytes() + b"\0\1\0"
    assert (library.n_objects, library.patch_side) == (2, 0)
    assert HeldModel.of(library).crc32 == zlib.crc32(library.payload)
    assert len(object_library(np.ones((1024, 60)), np.arange(60) % 30).payload) <= MODEL_CAPACITY


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: patch_dictionary(np.ones((63, 2))), "square"),
        (lambda: patch_dictionary(np.ones((81, 2))), "1 to 8 taxels a side"),
        (lambda: patch_dictionary(np.ones((64, 2)), patch_step=9), "patch_step = 9"),
        (lambda: patch_dictionary(np.full((4, 2), np.nan)), "not finite"),
        (lambda: patch_dictionary(np.full((4, 2), 1e300)), "not finite"),
        (lambda: patch_dictionary(np.ones((64, 1025))), "262400 bytes"),
        (lambda: patch_dictionary(np.ones(64)), "matrix"),
        (lambda: object_library(np.ones((4, 2)), [0]), "each of the 2 columns"),
        (lambda: object_library(np.ones((4, 2)), [0, 2]), "none left out"),
        (lambda: object_library(np.ones((4, 65)), np.arange(65)), "up to 63"),
        (lambda: object_library(np.ones((4097, 1)), [0]), "4097 taxels"),
    ],
)
def test_models_that_no_board_takes_are_refused(make: object, words: str) -> None:
    with pytest.raises(ArrayError, match=words):
        make()  # type: ignore[operator]


@pytest.mark.parametrize("piece", [b"", bytes(UPLOAD_PIECE_MAX + 1)])
def test_pieces_that_do_not_fit_a_packet_are_refused(piece: bytes) -> None:
    with pytest.raises(PacketError, match="1 to 1024"):
        encode_upload_data(1, 0, piece)
