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
    try:
        while rclpy.ok():
            executor.spin_until_future_complete(Future(), timeout_sec=_SPIN_S)
    except _STOPPED:
        return
    except RuntimeError:
        # A signal shuts the context down at once. Whatever was under way then fails with one of rclpy's errors, or one
        # of pybind11's that does not even say of what; all of them are RuntimeErrors.
        if rclpy.ok():
            raise


_STOPPED = (KeyboardInterrupt, ExternalShutdownException)


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
    except _STOPPED:
        return 0
    except RuntimeError:
        # While a node was made: see `spin`.
        if rclpy.ok():
            raise
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
