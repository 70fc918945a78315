# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The text lines of the published raster sketch."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.frames import Scheme
from acts_core.wire import RasterDecoder


def line(counts: list[int], duration_us: int = 17509) -> bytes:
    return "".join(f"{count}," for count in counts).encode() + f"{duration_us}\r\n".encode()


def opened(rows: int = 2, cols: int = 3) -> RasterDecoder:
    """A decoder that has seen its first line."""
    decoder = RasterDecoder(rows, cols)
    assert decoder.feed(b"77,8,120\r\n") == []
    assert (decoder.partial, decoder.malformed, decoder.frames) == (1, 0, 0)
    return decoder


def test_a_whole_scan() -> None:
    counts = np.random.default_rng(3).integers(0, 1024, 1024)
    decoder = RasterDecoder()
    stream = line(counts.tolist())
    first, second = decoder.feed(stream[100:] + stream + stream)
    assert first.scheme is Scheme.RASTER
    assert (first.rows, first.cols, first.duration_us, first.overruns) == (32, 32, 17509, 0)
    assert first.indices.dtype == first.counts.dtype == np.uint16
    np.testing.assert_array_equal(first.indices, np.arange(1024))
    np.testing.assert_array_equal(first.counts, counts)
    assert [first.sequence, second.sequence] == [0, 1]
    assert [first.board_us, second.board_us] == [17509, 2 * 17509]
    assert (decoder.frames, decoder.partial, decoder.malformed) == (2, 1, 0)


def test_the_first_line_is_never_used_since_it_may_be_cut_within_a_number() -> None:
    decoder = RasterDecoder(1, 2)
    assert decoder.feed(line([123, 5])[1:]) == []
    decoder.feed(line([123, 5]))
    decoder.reset()
    assert decoder.feed(line([123, 5])[2:]) == []
    assert (decoder.frames, decoder.partial, decoder.malformed) == (1, 2, 0)


@pytest.mark.parametrize(
    ("bad", "words"),
    [
        (line([1, 2, 3, 4, 5]), "6 numbers"),
        (line([1, 2, 3, 4, 5, 6, 7]), "8 numbers"),
        (line([1, 2, 3, 4, 5, 1024]), "count 1024 of taxel 5"),
        (b"1,2,3,4,5,-6,100\r\n", "something else"),
        (b"1,2,3,4,5,6.0,100\r\n", "something else than numbers and commas, '.' as character 12: "),
        (b"1,2,3,4,5,x,100\r\n", "something else"),
        (b"1,2,3,4,5, 6,100\r\n", "something else"),
        (b"1,2,3,4,5,\xff\x00,100\r\n", "something else"),
        (b"1,2,3,4,,6,100\r\n", "empty value, number 5"),
        (b"1,2,3,4,5,6,\r\n", "line of 6 numbers that ends with a comma; after the 6 counts of an array of 2 x 3"),
        (b"1,2,3,4,5,6,100,\r\n", "line of 7 numbers that ends with a comma"),
        (b"1,2,3,4,5,6,4294967296\r\n", "4294967296 us"),
        (b"1,2,3,4,5,6,00000000100\r\n", "of 11 digits"),
        (b"100\r\n", "line of 1 number; an array of 2 x 3"),
        (b"bin dur: 12\r\n", "something else"),
        (b"1" * 200 + b"\r\n", "line longer than 41 bytes, the most that an array of 2 x 3 takes; is that its size"),
    ],
)
def test_a_bad_line_is_counted_and_leaves_a_gap(bad: bytes, words: str) -> None:
    decoder = opened()
    good = line([1, 2, 3, 4, 5, 6])
    received = decoder.feed(good + bad + good)
    assert [frame.sequence for frame in received] == [0, 2]
    assert (decoder.frames, decoder.malformed, decoder.crc_errors) == (2, 1, 0)
    assert words in decoder.last_error


@pytest.mark.parametrize(
    ("bad", "words"),
    [
        (b"1,2,100\r\n", "line of 3 numbers; an array of 1 x 1 has 1 count and a duration"),
        (b"1,\r\n", "line of 1 number that ends with a comma; after the 1 count of an array of 1 x 1"),
    ],
)
def test_a_bad_line_of_a_single_taxel_is_told_in_the_singular(bad: bytes, words: str) -> None:
    decoder = opened(1, 1)
    assert decoder.feed(bad) == []
    assert words in decoder.last_error


@pytest.mark.parametrize("empty", [b"\n", b"\r\n", b"\r\n\n\r\n"])
def test_an_empty_line_is_no_frame_and_leaves_no_gap(empty: bytes) -> None:
    decoder = opened()
    good = line([1, 2, 3, 4, 5, 6])
    received = decoder.feed(good + empty + good)
    assert [frame.sequence for frame in received] == [0, 1]
    assert (decoder.frames, decoder.malformed, decoder.bytes_discarded, decoder.last_error) == (2, 0, 9, "")


def test_what_is_wrong_in_a_long_line_is_shown() -> None:
    decoder = RasterDecoder(16, 16)
    good = line([7] * 256)
    decoder.feed(good + b"7," * 250 + b"1.5," + b"7," * 5 + b"100\r\n")
    assert decoder.last_error.endswith(", '.' as character 502: ...',7,7,7,7,7,7,7,7,7,7,7,1.5,7,7,7,7,7,100'")


def test_a_number_of_thousands_of_digits_is_malformed() -> None:
    decoder = RasterDecoder(64, 64)
    good = line([7] * 4096)
    decoder.feed(good)
    assert len(decoder.feed(b"1," * 4096 + b"9" * 6000 + b"\r\n" + good)) == 1
    assert decoder.malformed == 1
    assert "of 6000 digits" in decoder.last_error


@given(st.binary(max_size=200), st.lists(st.integers(0, 1023), min_size=6, max_size=6))
def test_after_any_garbage_the_next_line_is_right(garbage: bytes, counts: list[int]) -> None:
    decoder = opened()
    received = decoder.feed(garbage + b"\n" + line(counts))
    assert received[-1].counts.tolist() == counts


@given(st.lists(st.integers(0, 120), max_size=8))
def test_any_split_into_chunks_gives_the_same_frames(cuts: list[int]) -> None:
    stream = b"".join(line([k, 2, 3, 4, 5, 1023]) for k in range(4))
    decoder = opened()
    edges = [0, *sorted(min(cut, len(stream)) for cut in cuts), len(stream)]
    received = [frame for start, end in pairwise(edges) for frame in decoder.feed(stream[start:end])]
    assert [frame.counts[0] for frame in received] == [0, 1, 2, 3]
    assert decoder.malformed == 0


def test_endless_garbage_keeps_memory_bounded() -> None:
    decoder = RasterDecoder()
    for _ in range(100):
        decoder.feed(b"9" * 4096)
    assert len(decoder._pending) < 6000
    assert decoder.malformed == 1
