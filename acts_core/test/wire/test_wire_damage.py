# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Damaged packets are never taken for frames. ACTS_DAMAGED_PACKETS=N tries N of them instead of a few; -s prints."""

import os

import numpy as np

from acts_core.frames import SampleFrame, Scheme
from acts_core.wire import StreamDecoder, encode_frame

_DIFFERENT = 200


def random_frames(random: np.random.Generator) -> list[SampleFrame]:
    return [
        SampleFrame(
            sequence=int(random.integers(2**32)),
            board_us=int(random.integers(2**40)),
            duration_us=983,
            scheme=Scheme.ADAPTIVE,
            rows=32,
            cols=32,
            overruns=0,
            indices=random.permutation(1024)[:55].astype(np.uint16),
            counts=(random.integers(0, 1024, 55) * (random.random(55) < 0.5)).astype(np.uint16),
        )
        for _ in range(_DIFFERENT)
    ]


def damaged(packet: bytes, random: np.random.Generator) -> bytes:
    """A packet, delimiter included, with few or many bits turned over, bytes altered in a row, or a piece missing."""
    kind = random.integers(4)
    data = np.frombuffer(packet, dtype=np.uint8).copy()
    if kind <= 1:
        bits = random.integers(0, 8 * len(data), 1 + random.integers(8 if kind == 0 else 200))
        np.bitwise_xor.at(data, bits // 8, (1 << bits % 8).astype(np.uint8))
    else:
        start, end = np.sort(random.integers(0, len(data) + 1, 2))
        if kind == 3:
            return np.delete(data, slice(start, end)).tobytes()
        data[start:end] = random.integers(0, 256, end - start)
    return data.tobytes()


def test_no_damaged_packet_is_taken_for_a_frame() -> None:
    tries = int(os.environ.get("ACTS_DAMAGED_PACKETS", "20000"))
    random = np.random.default_rng(5)
    frames = random_frames(random)
    packets = [encode_frame(frame) for frame in frames]
    sent = {(frame.sequence, frame.board_us): frame for frame in frames}
    decoder = StreamDecoder()
    broken = taken = 0
    for k in range(tries):
        packet = packets[k % _DIFFERENT]
        data = damaged(packet, random)
        broken += data != packet
        for frame in decoder.feed(data):
            # What was not altered after all, or was whole already when its delimiter was hit, is what was sent.
            original = sent.get((frame.sequence, frame.board_us))
            same = (
                original is not None
                and np.array_equal(frame.indices, original.indices)
                and np.array_equal(frame.counts, original.counts)
            )
            taken += not same
    print(f"\n{broken} damaged packets of M = 55: {taken} taken for frames with a wrong value")
    print(f"stopped by the CRC {decoder.crc_errors}, by stuffing, length or fields {decoder.malformed}")
    assert broken > 0.9 * tries
    assert taken == 0
    # The stream goes on behind the damage.
    decoder.feed(b"\0")
    assert [frame.sequence for frame in decoder.feed(packets[0])] == [frames[0].sequence]
