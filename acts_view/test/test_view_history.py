# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The history of a stream: what is kept, what each reader gets of it."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from acts_view.skin.history import COLUMNS, History, Place

TIME, FRAMES, LOST, FORCE_MIN, FORCE_MAX, LATENCY_MIN, LATENCY_MAX = range(len(COLUMNS))
CLOSING_S = 1000.0
"""A frame this late closes every interval before it."""

FRAME = st.tuples(st.floats(0.0, 0.1), st.floats(0, 100), st.floats(0, 50) | st.just(math.nan), st.integers(0, 3))


@given(st.lists(FRAME, min_size=1, max_size=60))
def test_no_extreme_and_no_frame_is_lost(frames: list[tuple[float, float, float, int]]) -> None:
    history = History(interval_s=0.008, length_s=60.0)
    stamp_s = 0.0
    for step_s, force_n, latency_ms, lost in frames:
        stamp_s += step_s
        history.add(stamp_s, force_n, latency_ms, lost)
    history.add(stamp_s + CLOSING_S, 0.0, 0.0, 0)
    rows, _ = history.since(Place())
    forces, latencies = [frame[1] for frame in frames], [frame[2] for frame in frames]
    assert (rows[:, FORCE_MIN].min(), rows[:, FORCE_MAX].max()) == (min(forces), max(forces))
    assert rows[:, FRAMES].sum() == len(frames)
    assert rows[:, LOST].sum() == sum(frame[3] for frame in frames)
    if all(map(math.isnan, latencies)):
        assert np.isnan(rows[:, LATENCY_MIN:]).all()
    else:
        known = [latency for latency in latencies if not math.isnan(latency)]
        assert (np.nanmin(rows[:, LATENCY_MIN]), np.nanmax(rows[:, LATENCY_MAX])) == (min(known), max(known))
    assert (np.diff(rows[:, TIME]) > 0).all()


@given(st.lists(st.integers(0, 12), max_size=12))
def test_a_reader_gets_every_interval_once_and_after_an_absence_the_newest(pauses: list[int]) -> None:
    history = History(interval_s=1.0, length_s=8.0)
    place, got, number = Place(), [], 0
    for pause in pauses:
        for _ in range(pause):
            history.add(float(number), 0.0, 0.0, 0)
            number += 1
        rows, place = history.since(place)
        assert len(rows) <= 8
        got += rows[:, TIME].tolist()
        # What is not given was overwritten; the newest is always there.
        assert not len(rows) or rows[-1, TIME] == number - 2
    assert got == sorted(set(got))


def test_a_clock_that_goes_back_begins_anew_and_a_late_frame_does_not() -> None:
    history = History(interval_s=0.01, length_s=1.0)
    for stamp_s in (100.0, 100.05, 100.01, 100.06):
        history.add(stamp_s, stamp_s, 0.0, 0)
    rows, place = history.since(Place())
    assert rows[:, FRAMES].tolist() == [1, 2]
    history.add(50.0, 1.0, 0.0, 0)
    history.add(50.01, 1.0, 0.0, 0)
    rows, anew = history.since(place)
    assert rows[:, TIME].tolist() == [50.0]
    assert anew.life != place.life
