# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The binary stream: layout byte by byte, and what any garbage does to it."""

import re
import struct
import zlib
from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_frames import frames

from acts_core.errors import PacketError
from acts_core.frames import SampleFrame, Scheme
from acts_core.wire import StreamDecoder, cobs, encode_frame
from acts_core.wire.cobs_kernels import decode_into
from acts_core.wire.sample_kernels import first_fault
from acts_core.wire.samples import PACKET_SIZE_MAX, sample_fault

pytestmark = pytest.mark.slow

GARBAGE = st.binary(max_size=300)


def example(sequence: int = 7, m: int = 3) -> SampleFrame:
    return SampleFrame(
        sequence=sequence,
        board_us=1_000_000 + 1000 * sequence,
        duration_us=970,
        scheme=Scheme.ADAPTIVE,
        rows=32,
        cols=32,
        overruns=2,
        indices=np.arange(m, dtype=np.uint16) * 7,
        counts=np.arange(m, dtype=np.uint16) + 500,
    )


def same(one: SampleFrame, other: SampleFrame) -> bool:
    pairs: Iterable[tuple[Any, Any]] = zip(one, other, strict=True)
    return all(np.array_equal(*values) for values in pairs)


def all_same(some: list[SampleFrame], others: list[SampleFrame]) -> bool:
    return len(some) == len(others) and all(map(same, some, others))


def rejected(decoder: StreamDecoder) -> int:
    return decoder.crc_errors + decoder.malformed


def packet_of(frame: SampleFrame, *, crc: bool = True, **changes: int) -> bytes:
    """A packet put together without the encoder under test; `changes` are header fields."""
    fields = {
        "type": 1,
        "version": 1,
        "length": 36 + 4 * len(frame.indices),
        "sequence": frame.sequence,
        "board_us": frame.board_us,
        "duration_us": frame.duration_us,
        "overruns": frame.overruns,
        "scheme": int(frame.scheme),
        "rows": frame.rows,
        "cols": frame.cols,
        "flags": 0,
        "m": len(frame.indices),
        "reserved": 0,
    }
    assert set(changes) <= set(fields)
    body = struct.pack("<BBHIQIIBBBBHH", *(fields | changes).values())
    body += b"".join(struct.pack("<H", value) for value in [*frame.indices.tolist(), *frame.counts.tolist()])
    return cobs.encode(body + struct.pack("<I", zlib.crc32(body) ^ (not crc))) + b"\x00"


def test_layout_byte_by_byte() -> None:
    encoded = encode_frame(example())
    assert encoded[-1] == 0
    assert encoded == packet_of(example())
    packet = cobs.decode(encoded[:-1])
    assert packet[:4] == b"\x01\x01\x30\x00"
    assert packet[4:8] == b"\x07\x00\x00\x00"
    assert int.from_bytes(packet[8:16], "little") == 1_007_000
    assert int.from_bytes(packet[16:20], "little") == 970
    assert int.from_bytes(packet[20:24], "little") == 2
    assert packet[24:32] == b"\x03\x20\x20\x00\x03\x00\x00\x00"
    assert packet[32:38] == b"\x00\x00\x07\x00\x0e\x00"
    assert packet[38:44] == b"\xf4\x01\xf5\x01\xf6\x01"
    assert packet[44:] == zlib.crc32(packet[:44]).to_bytes(4, "little")


def test_the_largest_frame_fits() -> None:
    size = 64 * 64
    frame = example()._replace(
        rows=64,
        cols=64,
        indices=np.arange(size, dtype=np.uint16)[::-1].copy(),
        counts=np.full(size, 1023, dtype=np.uint16),
    )
    encoded = encode_frame(frame)
    assert len(cobs.decode(encoded[:-1])) == PACKET_SIZE_MAX
    assert all_same(StreamDecoder().feed(encoded), [frame])


@given(st.lists(frames(80), max_size=4))
def test_round_trip(sent: list[SampleFrame]) -> None:
    decoder = StreamDecoder()
    assert all_same(decoder.feed(b"".join(map(encode_frame, sent))), sent)
    assert (decoder.frames, rejected(decoder), decoder.bytes_discarded) == (len(sent), 0, 0)


@given(st.lists(st.tuples(GARBAGE, frames(80)), max_size=4), GARBAGE)
def test_garbage_before_and_between_is_dropped(sent: list[tuple[bytes, SampleFrame]], end: bytes) -> None:
    decoder = StreamDecoder()
    stream = b"".join(garbage + b"\x00" + encode_frame(frame) for garbage, frame in sent) + end
    assert all_same(decoder.feed(stream), [frame for _, frame in sent])


@given(GARBAGE, st.lists(frames(80), min_size=1, max_size=3))
def test_after_garbage_without_a_delimiter_at_most_one_frame_is_lost(garbage: bytes, sent: list[SampleFrame]) -> None:
    decoder = StreamDecoder()
    received = decoder.feed(garbage + b"".join(map(encode_frame, sent)))
    assert all_same(received, sent) or all_same(received, sent[1:])
    if garbage.strip(b"\x00"):
        assert rejected(decoder) >= 1
        assert decoder.bytes_discarded >= 1


@given(st.lists(frames(80), min_size=1, max_size=3), st.lists(st.integers(0, 1200), max_size=12))
def test_any_split_into_chunks_gives_the_same_frames(sent: list[SampleFrame], cuts: list[int]) -> None:
    stream = b"garbage\x00" + b"".join(map(encode_frame, sent))
    decoder = StreamDecoder()
    edges = [0, *sorted(min(cut, len(stream)) for cut in cuts), len(stream)]
    received = [frame for start, end in pairwise(edges) for frame in decoder.feed(stream[start:end])]
    assert all_same(received, sent)
    assert rejected(decoder) == 1
    assert decoder.bytes_discarded == len("garbage")


@pytest.mark.parametrize("kind", [bytearray, memoryview, lambda stream: np.frombuffer(stream, dtype=np.uint8)])
def test_bytes_of_another_kind_are_decoded_and_no_kernel_is_compiled_for_them(kind: Callable[[bytes], Any]) -> None:
    decoder, stream = StreamDecoder(), b"garbage" + b"".join(encode_frame(example()) for _ in range(3))
    compiled = len(decode_into.signatures)  # type: ignore[attr-defined]
    received = [frame for part in (stream[:70], stream[70:]) for frame in decoder.feed(kind(part))]
    assert all_same(received, StreamDecoder().feed(stream))
    assert len(received) == 2
    assert len(decode_into.signatures) == compiled  # type: ignore[attr-defined]


@given(frames(80))
@settings(max_examples=20)
def test_byte_by_byte(sent: SampleFrame) -> None:
    decoder = StreamDecoder()
    received = [frame for byte in encode_frame(sent) * 2 for frame in decoder.feed(bytes([byte]))]
    assert all_same(received, [sent, sent])


@given(st.lists(frames(80), min_size=2, max_size=3), st.sets(st.integers(0, 2**14), min_size=1, max_size=20))
def test_flipped_bits_never_yield_a_wrong_frame(sent: list[SampleFrame], bits: set[int]) -> None:
    stream = bytearray(b"".join(map(encode_frame, sent)))
    flipped = {bit % (8 * len(stream)) for bit in bits}
    for bit in flipped:
        stream[bit // 8] ^= 1 << bit % 8
    decoder = StreamDecoder()
    received = decoder.feed(bytes(stream) + b"\x00")
    assert all(any(same(frame, other) for other in sent) for frame in received)
    assert len(received) < len(sent)
    assert rejected(decoder) >= 1
    # Whatever happened, the next frame comes through.
    assert all_same(decoder.feed(encode_frame(sent[0])), [sent[0]])


@given(frames(80), frames(80), st.data())
def test_a_truncated_frame_is_lost_alone(first: SampleFrame, second: SampleFrame, data: st.DataObject) -> None:
    encoded = encode_frame(first)
    kept = data.draw(st.integers(1, len(encoded) - 2))
    decoder = StreamDecoder()
    assert all_same(decoder.feed(encoded[:kept] + b"\x00" + encode_frame(second)), [second])
    assert rejected(decoder) == 1
    # Without its delimiter it takes the next one with it, and only that.
    assert all_same(decoder.feed(encoded[:kept] + encode_frame(second) + encode_frame(first)), [first])
    assert rejected(decoder) == 2


@given(frames(80), st.randoms(use_true_random=False))
def test_reordered_bytes_never_yield_a_wrong_frame(sent: SampleFrame, random: object) -> None:
    encoded = list(encode_frame(sent)[:-1])
    random.shuffle(encoded)  # type: ignore[attr-defined]
    decoder = StreamDecoder()
    received = decoder.feed(bytes(encoded) + b"\x00" + encode_frame(sent))
    assert all(same(frame, sent) for frame in received)
    assert received


@given(st.permutations(list(range(4))))
def test_reordered_frames_come_as_they_are_sent(order: list[int]) -> None:
    sent = [example(sequence) for sequence in order]
    assert all_same(StreamDecoder().feed(b"".join(map(encode_frame, sent))), sent)


def test_a_board_that_prints_text_is_told_from_one_of_ours() -> None:
    decoder = StreamDecoder()
    decoder.feed(b"0,0,3,118,402,29312\r\n" * 1000)
    assert decoder.last_error.endswith(
        "; a board that prints lines of text speaks another protocol (docs/own_array.md)"
    )


def test_endless_garbage_keeps_memory_bounded_and_counts_every_byte() -> None:
    decoder = StreamDecoder()
    chunk = b"\x55" * 4096
    for _ in range(500):
        assert decoder.feed(chunk) == []
    assert len(decoder._pending) <= cobs.encoded_size_max(PACKET_SIZE_MAX)
    assert decoder.malformed == 1
    assert decoder.feed(b"\x00" + encode_frame(example())) != []
    assert decoder.bytes_discarded == 500 * 4096


def test_a_packet_of_many_chunks_that_is_too_long_is_rejected() -> None:
    decoder = StreamDecoder()
    assert decoder.feed(b"\x55" * 100_000 + b"\x00") == []
    assert (decoder.malformed, decoder.bytes_discarded) == (1, 100_000)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"type": 2}, "reply of 40 bytes.*same release"),
        ({"type": 5}, "type 5.*same release"),
        ({"type": 17}, "type 17.*same release"),
        ({"type": 17}, "type 17, a command: what the host sends comes back"),
        ({"type": 23}, "type 23.*same release"),
        ({"version": 2}, "version 2.*same release"),
        ({"length": 47}, "48 bytes says it has 47"),
        ({"scheme": 99}, "scheme 99"),
        ({"flags": 1}, "flags 1"),
        ({"reserved": 1}, "reserved 1"),
        ({"rows": 0}, "0 x 32"),
        ({"rows": 65}, "65 x 32"),
        ({"cols": 0}, "32 x 0"),
        ({"cols": 65}, "32 x 65"),
        ({"rows": 1, "cols": 2}, "3 samples of an array of 1 x 2"),
        ({"rows": 2, "cols": 7}, "index 14 of sample 2 is outside of the array of 14"),
        ({"m": 0}, "0 samples of an array of 32 x 32; 1 to 1024 are allowed"),
        ({"m": 2}, "48 bytes with 2 samples"),
        ({"m": 4}, "48 bytes with 4 samples"),
    ],
)
def test_what_cannot_be_is_malformed_though_its_crc_is_right(changes: dict[str, Any], words: str) -> None:
    decoder = StreamDecoder()
    assert decoder.feed(packet_of(example(), **changes)) == []
    assert (decoder.malformed, decoder.crc_errors) == (1, 0)
    assert re.search(words, decoder.last_error), decoder.last_error


def test_a_frame_without_samples_is_neither_encoded_nor_decoded() -> None:
    nothing = example(m=0)
    with pytest.raises(PacketError, match="0 samples of an array of 32 x 32; 1 to 1024 are allowed"):
        encode_frame(nothing)
    decoder = StreamDecoder()
    assert len(decoder.feed(packet_of(nothing) + packet_of(example()))) == 1
    assert (decoder.frames, decoder.malformed) == (1, 1)


def test_a_wrong_crc_is_counted_as_such() -> None:
    decoder = StreamDecoder()
    assert decoder.feed(packet_of(example(), crc=False)) == []
    assert (decoder.malformed, decoder.crc_errors) == (0, 1)
    assert "CRC" in decoder.last_error


@pytest.mark.parametrize(
    ("indices", "counts", "words"),
    [
        ([0, 1, 1024], [1, 2, 3], "index 1024 of sample 2"),
        ([5, 6, 5], [1, 2, 3], "index 5 of sample 2 occurred before"),
        ([5, 6, 7], [1, 1024, 3], "count 1024 of sample 1"),
    ],
)
def test_bad_samples_are_malformed_and_not_encoded(indices: list[int], counts: list[int], words: str) -> None:
    frame = example()._replace(indices=np.array(indices, dtype=np.uint16), counts=np.array(counts, dtype=np.uint16))
    decoder = StreamDecoder()
    assert decoder.feed(packet_of(frame) + packet_of(example())) != []
    assert (decoder.frames, decoder.malformed) == (1, 1)
    assert words in decoder.last_error
    with pytest.raises(PacketError, match=words):
        encode_frame(frame)


def test_only_a_scheme_that_repeats_may_have_a_taxel_several_times() -> None:
    indices, counts = np.array([[5, 6, 5, 5], [1, 2, 3, 4]], dtype=np.uint16)
    again: dict[str, Any] = {"indices": indices, "counts": counts}
    frame = example()._replace(scheme=Scheme.FIXED, **again)
    (found,) = StreamDecoder().feed(encode_frame(frame))
    assert found.indices.tolist() == [5, 6, 5, 5]
    assert not StreamDecoder().feed(packet_of(example()._replace(scheme=Scheme.RASTER, **again)))


@given(st.lists(st.tuples(st.integers(0, 20), st.integers(1000, 1030)), max_size=8), st.booleans())
def test_compiled_and_plain_check_agree(samples: list[tuple[int, int]], may_repeat: bool) -> None:
    indices = np.array([index for index, _ in samples], dtype=np.uint16)
    counts = np.array([count for _, count in samples], dtype=np.uint16)
    fault, position = first_fault(indices, counts, 16, np.zeros(4096, dtype=np.uint32), 1, may_repeat)
    reason = sample_fault(indices, counts, 16, may_repeat=may_repeat)
    assert bool(fault) == bool(reason)
    if fault:
        assert f"sample {position}" in reason


@pytest.mark.parametrize(
    "changes",
    [{"rows": 65}, {"cols": 0}, {"rows": 1, "cols": 2}, {"board_us": -1}, {"counts": np.zeros(2, dtype=np.uint16)}],
)
def test_what_cannot_be_sent_is_refused(changes: dict[str, object]) -> None:
    with pytest.raises(PacketError):
        encode_frame(example()._replace(**changes))  # type: ignore[arg-type]


def test_a_stream_opened_within_a_packet_counts_it_apart() -> None:
    decoder = StreamDecoder()
    decoder.feed(encode_frame(example())[:30])
    decoder.reset()
    stream = encode_frame(example())
    assert len(decoder.feed(stream[20:] + stream)) == 1
    assert (decoder.frames, decoder.partial, rejected(decoder)) == (1, 1, 0)
    # The delimiter of the packet that was cut does not count.
    assert decoder.bytes_discarded == 30 + len(stream[20:]) - 1
    decoder.feed(stream[:9])
    decoder.reset()
    assert len(decoder.feed(stream)) == 1
    assert (decoder.frames, decoder.partial, rejected(decoder)) == (2, 1, 0)
    assert decoder.bytes_discarded == 30 + len(stream[20:]) - 1 + 9
