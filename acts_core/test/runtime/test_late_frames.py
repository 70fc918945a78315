# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

from collections import Counter

from acts_core.runtime import LateFrames, Use

MS = 1_000_000


def stall(late: LateFrames, length_ms: int) -> Counter[Use]:
    """What becomes of the frames that a stall has held up, of a stream at 1 kHz."""
    return Counter(late.use((length_ms - k) * MS) for k in range(length_ms))


def test_what_a_few_stalls_have_held_up_is_published() -> None:
    late = LateFrames()
    # Each of them takes 18 of the 100 tokens: 20 frames are late, and 20 are not.
    for _ in range(4):
        assert stall(late, 40) == {Use.PUBLISH: 40}
    assert stall(late, 90) == {Use.PUBLISH: 48, Use.RECOVER: 40, Use.NOTHING: 2}


def test_where_all_are_late_none_is_published_after_a_tenth_of_a_second() -> None:
    late = LateFrames()
    uses = [late.use(30 * MS) for _ in range(1000)]
    assert uses == [Use.PUBLISH] * 100 + [Use.RECOVER] * 900
    assert {late.use(61 * MS) for _ in range(100)} == {Use.NOTHING}


def test_punctual_frames_earn_the_publishing_of_late_ones() -> None:
    late = LateFrames()
    for _ in range(200):
        late.use(30 * MS)
    for _ in range(505):
        assert late.use(2 * MS) is Use.PUBLISH
    assert [late.use(30 * MS) for _ in range(100)] == [Use.PUBLISH] * 50 + [Use.RECOVER] * 50


def test_what_is_older_than_a_tenth_of_a_second_is_left_out() -> None:
    late = LateFrames()
    assert late.use(100 * MS) is Use.PUBLISH
    assert late.use(100 * MS + 1) is Use.NOTHING
