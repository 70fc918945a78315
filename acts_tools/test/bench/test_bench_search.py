# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The plain parts of `acts bench`: search for the highest rate, judgement of a run, true time of a frame."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.errors import PacketError
from acts_core.frames import SampleFrame, Scheme
from acts_tools.bench.rigs.trial import Status, Trial, observe
from acts_tools.bench.rigs.true_time import TrueTime
from acts_tools.bench.search import Search

pytestmark = pytest.mark.slow

NOTHING = np.zeros(0, dtype=np.uint16)


def highest(holds: Callable[[float], bool], maximum: float = 64_000, resolution: float = 0.1) -> float | None:
    search = Search(1000, 100, maximum, resolution, tries=2)
    for _ in range(1000):
        if search.done:
            return search.good
        search.answer(holds(search.value))
    raise AssertionError("the search does not end")


@given(st.floats(101, 63_000), st.floats(0.02, 0.5))
def test_the_search_comes_within_its_resolution(true_limit: float, resolution: float) -> None:
    found = highest(lambda value: value <= true_limit, resolution=resolution)
    assert found is not None
    assert found <= true_limit <= found * (1 + resolution)


def test_the_search_ends_at_its_limits() -> None:
    assert highest(lambda value: True, maximum=5000) == 5000
    assert highest(lambda value: False) is None
    assert highest(lambda value: value <= 100) == pytest.approx(100, rel=0.2)


def test_a_single_failure_does_not_decide() -> None:
    asked: list[float] = []

    def holds(value: float) -> bool:
        asked.append(value)
        return value <= 4000 and asked.count(value) > 1

    assert highest(holds, resolution=0.6) == 4000


@given(st.lists(st.booleans(), min_size=60, max_size=60))
def test_contradicting_answers_end_the_search_too(answers: list[bool]) -> None:
    search = Search(1000, 100, 64_000, 0.1, tries=2)
    for answer in answers:
        if search.done:
            break
        search.answer(answer)
    assert search.done
    assert search.good is None or search.bad is None or search.good < search.bad


def test_what_gave_out_is_named() -> None:
    trial = Trial(1000, 900, 900, 10, 10, {"driver": 97.0, "virtual_board": 20.0}, 120.0)
    assert trial.bottleneck == "driver fills a core"
    trial = Trial(1000, 900, 900, 10, 10, {"driver": 30.0, "virtual_board": 20.0}, 1e6)
    assert trial.bottleneck.startswith("all cores are busy, others take 999950 %")
    trial = Trial(1000, 900, 900, 10, 10, {"driver": 30.0, "virtual_board": 20.0}, 50.0)
    assert trial.bottleneck == "stalls (driver at 30 % of a core)"


@pytest.mark.parametrize(
    ("trial", "holds"),
    [
        (Trial(1000, 1000.3, 3000, 0, 0), True),
        (Trial(1000, 1000, 3000, 1, 0), False),
        (Trial(1000, 1000, 3000, 0, 1), False),
        (Trial(1000, 970, 3000, 0, 0), False),
    ],
)
def test_a_run_holds_when_nothing_is_lost_and_the_rate_is_kept(trial: Trial, holds: bool) -> None:
    assert trial.holds is holds


def reports(rate_hz: int, lost_from: int) -> Iterator[Status]:
    """One a second; the first hold no frames, and losses of the start that do not count."""
    yield Status(0.0, 0, 0, 0)
    for second in range(1, 1000):
        lost = 5 + max(0, second - lost_from + 1)
        yield Status(float(second), second * rate_hz, lost, lost)


def test_a_run_is_counted_from_a_second_after_its_first_frames() -> None:
    trial = observe(reports(1000, lost_from=999), 1000, 4.0)
    assert (trial.frames, trial.rate_hz, trial.lost, trial.overruns) == (4000, 1000.0, 0, 0)
    assert trial.holds
    assert "bench" in trial.cpu_percent


def test_the_first_loss_ends_a_run() -> None:
    trial = observe(reports(1000, lost_from=4), 1000, 60.0)
    assert (trial.frames, trial.lost) == (2000, 1)
    assert not trial.holds


def frame(sequence: int, board_us: int) -> SampleFrame:
    return SampleFrame(sequence, board_us, 983, Scheme.ADAPTIVE, 32, 32, 0, NOTHING, NOTHING)


def test_the_true_time_follows_from_the_number_of_a_frame() -> None:
    epoch_ns = time.monotonic_ns()
    truth = TrueTime([frame(n, 983 + 1000 * n) for n in range(5, 9)], 1000, epoch_ns, 100.0)
    # Before the clocks are compared again: of two comparisons the differences count, too.
    assert (np.diff(truth.at([0, 1_000_000])) - 1e12 / 1.0001)[0] == pytest.approx(0, abs=2)
    truth.observe_host()
    real_minus_monotonic = time.time_ns() - time.monotonic_ns()
    # The board's clock is fast by 100 millionths, so that its hundred seconds are 10 ms less.
    expected = epoch_ns + np.array([983_000, 100_000_983_000 / 1.0001]) + real_minus_monotonic
    # The host's clocks are read one after the other; a test machine may stop in between.
    assert np.abs(truth.at([0, 100_000]) - expected).max() < 1e8


def test_frames_that_are_not_even_have_no_true_time() -> None:
    with pytest.raises(PacketError, match="not 1000 us apart"):
        TrueTime([frame(0, 983), frame(1, 1984)], 1000, 0, 0.0)
