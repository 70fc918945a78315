"""Run nodes until the process is told to stop, on the executor that fits 1 kHz, and leave nothing behind."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence

import rclpy
from rclpy.executors import Executor, ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future

from acts_core.errors import ActsError

try:  # ROS 2 Kilted and newer; half the latency and a third of the CPU of the other at 1 kHz
    from rclpy.experimental import EventsExecutor
except ImportError:  # Humble and Jazzy
    EventsExecutor = None

_SPIN_S = 3600.0


def make_executor() -> Executor:
    """The fastest executor of this ROS distribution that keeps the order of callbacks (never the multi-threaded)."""
    return SingleThreadedExecutor() if EventsExecutor is None else EventsExecutor()


def spin(executor: Executor) -> None:
    """Run callbacks until SIGINT, SIGTERM or shutdown.

    Not ``executor.spin()``: the events executor of the Kilted wheels never calls back from it.
    """
    stopped = _stop_errors()
    try:
        while rclpy.ok():
            executor.spin_until_future_complete(Future(), timeout_sec=_SPIN_S)
    except stopped:
        return
    except RuntimeError:
        # A signal in the middle of a callback can reach us as an exception of pybind11 that says nothing of it.
        if rclpy.ok():
            raise


def _stop_errors() -> tuple[type[BaseException], ...]:
    # InvalidHandle is what the events executor raises when the context went away under it.
    from rclpy._rclpy_pybind11 import InvalidHandle

    return (KeyboardInterrupt, ExternalShutdownException, InvalidHandle)


def run(factories: Sequence[Callable[[], Node]], args: Sequence[str] | None = None) -> int:
    """The `main` of every ACTS node: start, spin, shut down, and tell an `ActsError` in one line.

    Parameters
    ----------
    factories : sequence of callables
        Each makes one node; all of them run in this process on one executor. A node that has to end things in order
        defines ``close()``, which is called before it is destroyed.
    args : sequence of str or None
        Command line; None for ``sys.argv``.

    Returns
    -------
    int
        Exit code: 0 after an orderly stop, 1 when a node could not start or failed with an `ActsError`.
    """
    rclpy.init(args=list(args) if args is not None else None)
    executor = make_executor()
    nodes: list[Node] = []
    try:
        for factory in factories:
            node = factory()
            nodes.append(node)
            executor.add_node(node)
        spin(executor)
    except ActsError as error:
        print(f"error: {error}", file=sys.stderr, flush=True)
        return 1
    except _stop_errors():
        return 0
    finally:
        for node in reversed(nodes):
            close = getattr(node, "close", None)
            if close is not None:
                close()
            node.destroy_node()
        executor.shutdown()
        # Explicit: otherwise shared-memory files of the middleware stay behind.
        rclpy.try_shutdown()
    return 0
