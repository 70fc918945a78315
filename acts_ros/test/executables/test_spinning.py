# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How long callbacks are run, and what is called without an executor; without ROS."""

from __future__ import annotations

import threading
from types import SimpleNamespace
from typing import Any

from rclpy.task import Future
from waiting import wait_for

from acts_ros.executor import call_soon, spin_for


class MadeExecutor:
    """Runs callbacks until it is told that this is enough, or, where it is idle at times, until its time is over."""

    def __init__(self, *, is_busy: bool) -> None:
        self._is_busy = is_busy
        self.timeout_s: float | None = None
        self.ended_after_s: list[float] = []

    def spin_until_future_complete(self, future: Future[Any], timeout_sec: float | None) -> None:
        self.timeout_s = timeout_sec
        self.ended_after_s = [
            thread.interval for thread in threading.enumerate() if isinstance(thread, threading.Timer)
        ]
        if self._is_busy:
            wait_for(future.done, "the end of what never pauses", 30.0)


def timers() -> set[threading.Thread]:
    return {thread for thread in threading.enumerate() if isinstance(thread, threading.Timer)}


def test_an_executor_that_always_has_something_to_run_is_ended_soon_after_its_time() -> None:
    executor: Any = MadeExecutor(is_busy=True)
    spin_for(executor, 0.0)


def test_an_executor_that_pauses_ends_by_its_own_time_and_nothing_is_left_behind() -> None:
    before = timers()
    executor: Any = MadeExecutor(is_busy=False)
    spin_for(executor, 3600.0)
    assert executor.timeout_s == 3600.0
    # What ends it otherwise does so later.
    assert 3600.0 < max(executor.ended_after_s) < 3601.0
    wait_for(lambda: timers() <= before, "that the overtime is given up")


def test_a_node_that_no_executor_serves_any_more_calls_nothing() -> None:
    called: list[int] = []
    node: Any = SimpleNamespace(executor=None)
    call_soon(node, lambda: called.append(1))
    assert called == []
