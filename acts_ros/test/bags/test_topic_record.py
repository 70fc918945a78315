# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the recorder knows of one topic."""

from __future__ import annotations

import time
from types import SimpleNamespace

import pytest

from acts_ros.bags.recorder import Recorder, TopicRecord


@pytest.mark.parametrize(
    ("received", "last_s", "silent_s"),
    [(100, 10.0, None), (100, 8.5, 1.5), (9, 5.0, None), (11, 9.0, None), (11, 3.0, 7.0), (0, 0.0, None)],
)
def test_a_silence_is_measured_by_the_rate_before_it(received: int, last_s: float, silent_s: float | None) -> None:
    record = TopicRecord("/plate/contact", "acts_msgs/msg/Contact", received, first_s=last_s - 1.0, last_s=last_s)
    assert record.silent_s(10.0) == silent_s


def record_of(*times_s: float) -> TopicRecord:
    record = TopicRecord("/plate/contact", "acts_msgs/msg/Contact")
    for now_s in times_s:
        record.add(now_s)
    return record


def test_pauses_in_the_midst_of_a_regular_topic_are_found_the_longest_first() -> None:
    steps = [k / 64 for k in range(128)]
    record = record_of(*steps, *(5 + step for step in steps), *(8.5 + step for step in steps))
    assert (record.received, record.first_s, record.last_s) == (384, 0.0, 8.5 + 127 / 64)
    assert record.pauses() == [(127 / 64, 5 - 127 / 64), (5 + 127 / 64, 3.5 - 127 / 64)]


@pytest.mark.parametrize(
    "times_s",
    [
        (),
        (0.0, 9.0),
        (*range(60),),  # once a second
        (*range(20), *range(30, 50)),  # ten of its intervals
        (0.0, *(5 + k / 100 for k in range(8))),  # too few to be regular
        (*(k / 100 for k in range(50)), *(1.4 + k / 100 for k in range(50))),  # shorter than a second
    ],
)
def test_what_is_no_pause_is_not_told(times_s: tuple[float, ...]) -> None:
    assert record_of(*times_s).pauses() == []


def test_a_machine_that_sleeps_is_a_pause(monkeypatch: pytest.MonkeyPatch) -> None:
    # Of these, Linux lets only this one run meanwhile.
    clocks_s = {time.CLOCK_MONOTONIC: 100.0, time.CLOCK_BOOTTIME: 100.0}
    monkeypatch.setattr(time, "clock_gettime", lambda clock: clocks_s[clock])
    monkeypatch.setattr(time, "monotonic", lambda: clocks_s[time.CLOCK_MONOTONIC])
    record = TopicRecord("/plate/contact", "acts_msgs/msg/Contact")
    recorder = SimpleNamespace(_bag=SimpleNamespace(write=lambda *_: None))
    for number in range(100):
        if number == 50:
            clocks_s[time.CLOCK_BOOTTIME] += 600.0
        for clock in clocks_s:
            clocks_s[clock] += 1 / 64
        Recorder._on_message(recorder, record, None, b"")  # type: ignore[arg-type]
    assert record.pauses() == [(100.0 + 50 / 64, 600.0 + 1 / 64)]
