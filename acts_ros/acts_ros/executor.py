# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Run nodes until the process is told to stop, on an executor that is fast enough for 1 kHz, and clean up."""

from __future__ import annotations

import gc
import os
import sys
import threading
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from typing import Any

import rclpy
from rclpy.exceptions import InvalidParameterTypeException, ParameterUninitializedException
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.logging import get_logger
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.subscription import Subscription
from rclpy.task import Future

from acts_core.errors import REFUSED_EXIT_CODE, ActsError, SettingsError, exit_code
from acts_core.stop_signals import StopSignals
from acts_ros import middleware
from acts_ros.clocks import steady_timer
from acts_ros.executables.middleware_watch import watch_middleware

try:  # ROS 2 Kilted and newer; half the latency and a third of the CPU of the other at 1 kHz
    from rclpy.experimental import EventsExecutor as EventsExecutor
except ImportError:  # Humble and Jazzy
    EventsExecutor = None

_SPIN_S = 3600.0
_OVERTIME_S = 0.2

# A thread that wakes for a frame waits at most this long for another one that is busy in Python [s].
_SWITCH_INTERVAL_S = 2e-4


def make_executor() -> Executor:
    """Create the fastest executor of this ROS distribution that keeps the order of callbacks (single-threaded)."""
    return SingleThreadedExecutor() if EventsExecutor is None else EventsExecutor()


def settle() -> None:
    """Prepare a process for work at 1 kHz: exempt present objects from garbage collection, switch threads sooner."""
    # Imports and the compiler leave some 100,000 objects; a full collection of them would stop the stream for 30 ms.
    gc.collect()
    gc.freeze()
    gc.enable()
    sys.setswitchinterval(_SWITCH_INTERVAL_S)


def run(
    factories: Sequence[Callable[[], Node]], args: Sequence[str] | None = None, signals: StopSignals | None = None
) -> int:
    """The `main` of every ACTS node: start, spin, shut down, and print an `ActsError` in one line.

    The first SIGINT, SIGTERM or SIGHUP ends it; further ones have no effect. The ROS context lives until every node has
    been destroyed, so that nodes can still publish, log and end motion while they are closed.

    Parameters
    ----------
    factories : sequence of callables
        Each makes one node; all of them run in this process on one executor. A node may define ``begin()``, called
        when all nodes have been made, ``failed()``, called where an error ends the process, and ``close()``, called
        before it is destroyed.
    args : sequence of str or None
        Command line; None for ``sys.argv``.
    signals : StopSignals or None
        Signal handlers that the process has installed already; None: they are installed now.

    Returns
    -------
    int
        Exit code: 0 after an orderly stop; after an `ActsError` 2 where the settings are the cause, and 1 otherwise; 2
        for a parameter of ROS of the wrong type.
    """
    signals = StopSignals() if signals is None else signals
    middleware.init(
        args=list(args) if args is not None else None,
        # Theirs end the context at once, and whatever is under way then fails.
        signal_handler_options=SignalHandlerOptions.NO,
    )
    executor = make_executor()
    nodes: list[Node] = []
    has_failed = True
    try:
        # Until all is settled: what nodes are made of stays.
        gc.disable()
        with signals.interrupting():
            for factory in factories:
                node = factory()
                nodes.append(node)
                _require_own_names(nodes)
                executor.add_node(node)
        settle()
        for node in nodes:
            _call(node, "begin")
        watch_middleware(os.environ)
        _spin(executor, signals)
        has_failed = False
    except ActsError as error:
        print(f"error: {error}", file=sys.stderr, flush=True)
        return exit_code(error)
    except (InvalidParameterTypeException, ParameterUninitializedException) as error:
        # Of the parameters that ROS itself declares, such as use_sim_time.
        print(f"error: {error} (on the command line or in a params file)", file=sys.stderr, flush=True)
        return REFUSED_EXIT_CODE
    except KeyboardInterrupt:
        has_failed = False
        return 0
    finally:
        # What a start leaves that was broken off while it compiled would be searched for garbage for seconds.
        gc.freeze()
        gc.enable()
        _end(executor, nodes, signals, has_failed=has_failed)
    return 0


def _end(executor: Executor, nodes: Sequence[Node], signals: StopSignals, *, has_failed: bool) -> None:
    """Close all nodes, the last one first, and what they run on; an error of one leaves out none of the others."""
    with ExitStack() as ends:
        ends.callback(signals.ended)
        # Explicit: otherwise shared-memory files of the middleware stay behind.
        ends.callback(rclpy.try_shutdown)
        ends.callback(executor.shutdown)
        for node in nodes:
            ends.callback(node.destroy_node)
            ends.callback(_call, node, "close")
            if has_failed:
                ends.callback(_call, node, "failed")


def call_soon(node: Node, callback: Callable[[], object]) -> None:
    """Have the executor's thread call something; from any thread. Its exceptions end what those of a timer end.

    Parameters
    ----------
    node : rclpy.node.Node
        Whose executor calls back. Without an executor nothing is called.
    callback : callable
        Called once, without arguments.
    """
    if node.executor is not None:
        node.executor.create_task(_call_safely, node, callback)


def call_when_done(node: Node, future: Future[Any], callback: Callable[[Future[Any]], object]) -> None:
    """Have something called when a future is done. Its exceptions end what those of a timer end.

    Parameters
    ----------
    node : rclpy.node.Node
        Whose executor calls back, on its thread.
    future : Future
        Such as the answer of a service.
    callback : callable
        Called once, with the future.
    """
    future.add_done_callback(lambda done: _call_safely(node, lambda: callback(done)))


def _call_safely(node: Node, callback: Callable[[], object]) -> None:
    """Call something in a task: one that raises crashes the events executor (rclpy 7.1 and 9.1), a timer does not."""
    try:
        callback()
    except Exception as error:  # noqa: BLE001 - raised again
        _raise_soon(node, error)


def _raise_soon(node: Node, error: Exception) -> None:
    """Raise on the executor's thread."""

    def fail() -> None:
        node.destroy_timer(timer)
        raise error

    timer = steady_timer(node, 0.0, fail)


def spin_for(executor: Executor, seconds: float) -> None:
    """Run callbacks for a while [s], and end then even if there is always one more to run.

    The events executor checks its time limit only when it is idle. Where more messages arrive than the process has CPU
    time for, the limit alone would never end it.
    """
    ended: Future[None] = Future()
    overtime = threading.Timer(seconds + _OVERTIME_S, ended.set_result, (None,))
    overtime.daemon = True
    overtime.start()
    try:
        executor.spin_until_future_complete(ended, timeout_sec=seconds)
    finally:
        overtime.cancel()


def destroy_subscription(node: Node, subscription: Subscription) -> None:
    """Destroy a subscription of a node that an executor serves, on the executor's thread.

    An executor fails on an event of it that has come and was not handled yet, such as that a new publisher offers less.
    """
    for event in subscription.event_handlers:
        event.take_data = _nothing  # type: ignore[method-assign]
    node.destroy_subscription(subscription)


def _nothing() -> None:
    """What an event that is not handled any more brings."""


def _spin(executor: Executor, signals: StopSignals) -> None:
    """Run callbacks until a signal comes.

    Not ``executor.spin()``: the events executor of the Kilted wheels never calls back from it.
    """
    stopped: Future[None] = Future()
    signals.on_stop(lambda: stopped.set_result(None))
    while not stopped.done():
        try:
            executor.spin_until_future_complete(stopped, timeout_sec=_SPIN_S)
        except rclpy_implementation.RCLError as error:
            # An answer of a service, a question to one, or one of the messages that rclpy publishes itself.
            if not str(error).startswith(middleware.NOT_SENT):
                raise
            get_logger("acts_ros").warning(middleware.reason_of(error))


def _require_own_names(nodes: Sequence[Node]) -> None:
    """Refuse two nodes of one name: nobody could reach the parameters and services of either.

    Raises
    ------
    SettingsError
        The last node has the name of another.
    """
    *others, last = (node.get_fully_qualified_name() for node in nodes)
    if last in others:
        raise SettingsError(
            f"two nodes of this process are named {last}: __node, which is the name= of a <node> in a launch file, "
            "renames all nodes of a process; leave it out, and give a namespace instead"
        )


def _call(node: Node, name: str) -> None:
    method = getattr(node, name, None)
    if method is not None:
        method()
