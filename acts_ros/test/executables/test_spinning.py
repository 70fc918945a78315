# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How long callbacks are run, what is called without an executor, and in which order all ends; without ROS."""

from __future__ import annotations

import threading
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
import rclpy
from rclpy.task import Future
from waiting import wait_for

from acts_core.errors import ActsError
from acts_ros import executor
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
    made: Any = MadeExecutor(is_busy=True)
    spin_for(made, 0.0)


def test_an_executor_that_pauses_ends_by_its_own_time_and_nothing_is_left_behind() -> None:
    before = timers()
    made: Any = MadeExecutor(is_busy=False)
    spin_for(made, 3600.0)
    assert made.timeout_s == 3600.0
    # What ends it otherwise does so later.
    assert 3600.0 < max(made.ended_after_s) < 3601.0
    wait_for(lambda: timers() <= before, "that the overtime is given up")


def test_a_node_that_no_executor_serves_any_more_calls_nothing() -> None:
    called: list[int] = []
    node: Any = SimpleNamespace(executor=None)
    call_soon(node, lambda: called.append(1))
    assert called == []


def test_an_error_of_what_was_to_be_called_is_raised_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that ends nothing, as of an answer that was not sent, would come again and again."""
    made: list[Callable[[], object]] = []
    destroyed: list[object] = []

    def make(_node: object, period_s: float, callback: Callable[[], object]) -> str:
        assert period_s == 0.0
        made.append(callback)
        return "the timer"

    def fail() -> None:
        raise ActsError("it has gone")

    monkeypatch.setattr(executor, "steady_timer", make)
    node: Any = SimpleNamespace(destroy_timer=destroyed.append)
    executor._call_safely(node, fail)
    (callback,) = made
    with pytest.raises(ActsError, match="it has gone"):
        callback()
    assert destroyed == ["the timer"]


@pytest.mark.parametrize("has_failed", [False, True])
def test_nodes_end_the_last_one_first_and_then_what_they_run_on(
    monkeypatch: pytest.MonkeyPatch, has_failed: bool
) -> None:
    done: list[str] = []

    def doing(what: str, error: Exception | None = None) -> Callable[[], None]:
        def do() -> None:
            done.append(what)
            if error is not None:
                raise error

        return do

    def made(name: str, error: Exception | None = None) -> Any:
        methods = {"failed": doing(f"{name} failed"), "close": doing(f"{name} closes", error)}
        return SimpleNamespace(**methods, destroy_node=doing(f"{name} is destroyed"))

    monkeypatch.setattr(rclpy, "try_shutdown", doing("context"))
    runs: Any = SimpleNamespace(shutdown=doing("executor"))
    signals: Any = SimpleNamespace(ended=doing("signals"))
    # What has none of the methods has nothing to do.
    bare: Any = SimpleNamespace(destroy_node=doing("third is destroyed"))
    nodes = [made("first"), made("second", ActsError("cannot be closed")), bare]
    with pytest.raises(ActsError, match="cannot be closed"):
        executor._end(runs, nodes, signals, has_failed=has_failed)
    of_two = [[f"{name} failed", f"{name} closes", f"{name} is destroyed"] for name in ("second", "first")]
    expected = ["third is destroyed", *of_two[0], *of_two[1], "executor", "context", "signals"]
    assert done == [what for what in expected if has_failed or not what.endswith("failed")]
