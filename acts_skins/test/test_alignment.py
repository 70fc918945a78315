# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames of several skins at one common time: slow, late, lost and returning skins, and wrong clocks."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.errors import SettingsError
from acts_skins.contacts.alignment import Aligned, AlignedSkin, Aligner, AlignmentConfig, SkinState

MS = 1_000_000
NOW = 1_000_000 * MS
CONFIG = AlignmentConfig(align_s=0.02, stale_after_s=0.1, lost_after_s=0.5, future_s=0.05)


def make() -> Aligner[str]:
    return Aligner(["left", "right"], CONFIG)


def by_name(aligned: Aligned[str]) -> dict[str, AlignedSkin[str]]:
    return {skin.name: skin for skin in aligned.skins}


def stream(aligner: Aligner[str], name: str, first_ms: int, end_ms: int, step_ms: int = 1) -> None:
    """Frames by their time after NOW [ms], all of them taken at the end."""
    for time_ms in range(first_ms, end_ms, step_ms):
        aligner.take(name, NOW + time_ms * MS, f"{name} {time_ms}", NOW + end_ms * MS)


def test_skins_of_one_rate_meet_at_the_newest_time_that_all_have() -> None:
    aligner = make()
    stream(aligner, "left", 0, 10)
    stream(aligner, "right", 0, 8)
    aligned = aligner.step(NOW + 10 * MS)
    assert aligned.time_ns == NOW + 7 * MS
    skins = by_name(aligned)
    assert skins["left"].frame == "left 7"
    assert skins["right"].frame == "right 7"
    assert skins["left"].age_s == pytest.approx(0.003)
    # What was newer waits for its time.
    stream(aligner, "right", 8, 12)
    assert by_name(aligner.step(NOW + 12 * MS))["left"].frame == "left 9"


def test_a_skin_is_silent_since_its_newest_frame_whatever_is_given_of_it() -> None:
    aligner = make()
    stream(aligner, "left", 0, 21, 20)
    stream(aligner, "right", 0, 10)
    aligned = aligner.step(NOW + 25 * MS)
    assert aligned.time_ns == NOW + 9 * MS
    skin = by_name(aligned)["left"]
    assert skin.frame == "left 0"
    assert [skin.age_s, skin.silent_s] == pytest.approx([0.025, 0.005])


def test_a_slow_skin_holds_the_others_up_by_no_more_than_is_allowed() -> None:
    aligner = make()
    stream(aligner, "left", 0, 60)
    stream(aligner, "right", 0, 60, 50)
    aligned = aligner.step(NOW + 60 * MS)
    assert by_name(aligned)["left"].stamp_ns == aligned.time_ns == NOW + 50 * MS
    stream(aligner, "left", 60, 90)
    aligned = aligner.step(NOW + 90 * MS)
    assert aligned.time_ns == NOW + (89 - 20) * MS
    skins = by_name(aligned)
    assert skins["right"].frame == "right 50"
    assert skins["right"].state is SkinState.FRESH
    assert skins["right"].age_s == pytest.approx(0.040)


def test_a_slow_skin_holds_a_quick_one_up_by_no_more_than_is_allowed() -> None:
    """Of 2000 frames a second those of half a second were kept: the contacts before them were published for on."""
    config = AlignmentConfig(align_s=1.0, stale_after_s=3.0, lost_after_s=3.0)
    aligner: Aligner[int] = Aligner(["left", "right"], config)
    aligner.take("right", NOW, 0, NOW)
    ages_s = []
    for half_ms in range(5000):
        now_ns = NOW + half_ms * MS // 2
        aligner.take("left", now_ns, half_ms, now_ns)
        if half_ms % 20 == 0:
            left, right = aligner.step(now_ns).skins
            assert (left.state, right.state) == (SkinState.FRESH, SkinState.FRESH)
            ages_s.append(left.age_s)
    assert max(ages_s) == pytest.approx(1.0, abs=0.001)


def test_a_silent_skin_is_first_stale_then_lost_and_the_other_goes_on() -> None:
    aligner = make()
    stream(aligner, "right", 0, 10)
    states = []
    for before_ms, time_ms in ((0, 50), (50, 200), (200, 700)):
        stream(aligner, "left", before_ms, time_ms)
        aligned = aligner.step(NOW + time_ms * MS)
        skin = by_name(aligned)["right"]
        states.append((skin.state, skin.frame))
    assert states == [(SkinState.FRESH, "right 9"), (SkinState.STALE, "right 9"), (SkinState.LOST, None)]
    assert by_name(aligned)["left"].frame == "left 699"
    # It comes again.
    stream(aligner, "right", 1000, 1003)
    stream(aligner, "left", 1000, 1003)
    skin = by_name(aligner.step(NOW + 1003 * MS))["right"]
    assert (skin.state, skin.frame) == (SkinState.FRESH, "right 1002")


def test_of_a_slow_skin_the_limits_follow_its_rate() -> None:
    aligner = make()
    states = []
    for time_ms in range(2000, 2000 + 5 * 200, 10):
        if time_ms % 200 == 0:
            stream(aligner, "right", time_ms, time_ms + 1)
        stream(aligner, "left", time_ms - 10, time_ms)
        states.append(by_name(aligner.step(NOW + time_ms * MS))["right"].state)
    # Its second frame tells its rate.
    assert set(states[21:]) == {SkinState.FRESH}
    for after_ms, state in ((490, SkinState.FRESH), (510, SkinState.STALE), (1010, SkinState.LOST)):
        stream(aligner, "left", 2800 + after_ms - 10, 2800 + after_ms)
        skin = by_name(aligner.step(NOW + (2800 + after_ms) * MS))["right"]
        assert skin.state is state
    assert skin.stale_after_s == pytest.approx(0.5)


def test_no_frame_waits_for_the_next_one_of_a_slow_skin() -> None:
    aligner = make()
    ages_s = []
    for time_ms in range(0, 4000, 10):
        for name, step_ms in (("left", 200), ("right", 1000)):
            if time_ms % step_ms == 0:
                stream(aligner, name, time_ms, time_ms + 1)
        skin = by_name(aligner.step(NOW + time_ms * MS))["left"]
        if time_ms > 1000:
            ages_s.append(skin.age_s)
    # As old as the next one is away, and what it waits for the other skin.
    assert max(ages_s) <= 0.2 + CONFIG.align_s + 0.01


def test_a_skin_that_never_came_is_lost() -> None:
    aligner = make()
    stream(aligner, "left", 0, 3)
    skin = by_name(aligner.step(NOW + 3 * MS))["right"]
    assert (skin.state, skin.frame, skin.stamp_ns, skin.silent_s) == (SkinState.LOST, None, None, None)


def test_a_skin_that_comes_is_fresh_once_it_has_contacts_of_the_common_time() -> None:
    aligner = make()
    stream(aligner, "left", 0, 100)
    # Its first frame is newer than what the slower skin lets be merged: nobody knows yet what touched it then.
    aligner.take("right", NOW + 100 * MS, "right 100", NOW + 100 * MS)
    aligned = aligner.step(NOW + 100 * MS)
    assert aligned.time_ns == NOW + 99 * MS
    skin = by_name(aligned)["right"]
    assert (skin.state, skin.frame, skin.silent_s) == (SkinState.LOST, None, None)
    stream(aligner, "left", 100, 102)
    skin = by_name(aligner.step(NOW + 102 * MS))["right"]
    assert (skin.state, skin.frame) == (SkinState.FRESH, "right 100")


def test_with_nothing_there_time_is_the_present() -> None:
    assert make().step(NOW).time_ns == NOW


def test_stamps_of_the_future_are_dropped_and_disturb_nobody() -> None:
    aligner = make()
    for time_ms in range(10):
        aligner.take("right", NOW + (time_ms + 5000) * MS, "future", NOW + time_ms * MS)
    stream(aligner, "left", 0, 10)
    aligned = aligner.step(NOW + 10 * MS)
    assert aligned.time_ns == NOW + 9 * MS
    assert by_name(aligned)["right"].state is SkinState.LOST
    assert (aligner.counters["right"].future, aligner.counters["right"].ahead_s) == (10, 5.0)


def test_how_old_frames_come_is_counted_whatever_becomes_of_them() -> None:
    aligner = make()
    stream(aligner, "left", 0, 10)
    assert aligner.counters["left"].late_s == pytest.approx(0.001)
    # The clock of its machine is set back.
    aligner.take("left", NOW - 3000 * MS, "early", NOW + 10 * MS)
    assert aligner.counters["left"].late_s == pytest.approx(3.01)
    assert (aligner.counters["left"].frames, aligner.counters["left"].out_of_order) == (11, 1)


def test_a_frame_that_comes_twice_or_late_is_dropped() -> None:
    aligner = make()
    stream(aligner, "left", 0, 5)
    stream(aligner, "left", 3, 5)
    assert aligner.counters["left"].out_of_order == 2
    assert by_name(aligner.step(NOW + 5 * MS))["left"].frame == "left 4"


def test_after_the_clock_was_set_back_everything_begins_anew() -> None:
    aligner = make()
    stream(aligner, "left", 0, 10)
    stream(aligner, "right", 0, 10)
    assert aligner.step(NOW + 10 * MS).time_ns == NOW + 9 * MS
    stream(aligner, "left", -60_000, -59_990)
    aligned = aligner.step(NOW - 59_990 * MS)
    assert aligner.clock_resets == 1
    assert aligned.time_ns == NOW - 59_991 * MS
    assert by_name(aligned)["left"].frame == "left -59991"
    assert by_name(aligned)["right"].state is SkinState.LOST


def test_a_clock_that_was_set_back_is_noticed_before_the_next_frame() -> None:
    aligner = make()
    stream(aligner, "left", 0, 10)
    aligned = aligner.step(NOW - 60_000 * MS)
    assert (aligner.clock_resets, aligned.time_ns) == (1, NOW - 60_000 * MS)
    assert [(skin.state, skin.frame) for skin in aligned.skins] == [(SkinState.LOST, None)] * 2


def test_limits_in_the_wrong_order_are_refused() -> None:
    with pytest.raises(SettingsError, match="lost_after_s"):
        AlignmentConfig(stale_after_s=1.0, lost_after_s=0.5)


EVENTS = st.lists(
    st.tuples(
        st.sampled_from(["left", "right"]),
        st.integers(-700, 200),  # stamp relative to the present [ms]
        st.integers(-200, 700),  # how the clock goes on [ms]
        st.booleans(),
    ),
    max_size=60,
)


@given(EVENTS)
def test_whatever_comes_nothing_old_or_from_after_the_common_time_is_given(
    events: list[tuple[str, int, int, bool]],
) -> None:
    aligner, now_ns, before_ns, resets = make(), NOW, 0, 0
    for name, offset_ms, passed_ms, is_step in events:
        now_ns += passed_ms * MS
        aligner.take(name, now_ns + offset_ms * MS, "x", now_ns)
        if not is_step:
            continue
        aligned = aligner.step(now_ns)
        assert aligned.time_ns <= now_ns + 50 * MS + 50 * MS  # a stamp may be ahead, and the clock go back unnoticed
        if aligner.clock_resets == resets:
            assert aligned.time_ns >= before_ns
        before_ns, resets = aligned.time_ns, aligner.clock_resets
        for skin in aligned.skins:
            assert (skin.frame is None) == (skin.stamp_ns is None) == (skin.state is SkinState.LOST)
            if skin.stamp_ns is not None:
                assert skin.stamp_ns <= aligned.time_ns
                assert skin.state is not SkinState.LOST
                assert skin.age_s >= 0.0


def test_a_skin_that_comes_again_is_fresh_with_its_first_frame_at_the_common_time() -> None:
    """Before, what is given of it is as old as its silence, and others may be held up by a slow skin."""
    aligner: Aligner[str] = Aligner(["left", "right", "slow"], CONFIG)
    for time_ms in range(0, 500):
        now_ns = NOW + time_ms * MS
        if not 100 <= time_ms < 412:
            aligner.take("right", now_ns, f"right {time_ms}", now_ns)
        aligner.take("left", now_ns, "left", now_ns)
        if time_ms % 40 == 0:
            aligner.take("slow", now_ns, "slow", now_ns)
        right = by_name(aligner.step(now_ns))["right"]
        if right.state is SkinState.FRESH:
            assert right.age_s <= CONFIG.stale_after_s, time_ms
        elif time_ms >= 412:
            assert right.state is SkinState.STALE
            assert right.frame == "right 99"
            assert right.silent_s == right.age_s
    assert right.state is SkinState.FRESH
