"""How late contacts are published beside programs that compute all the time, without and with real-time priorities."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from dataclasses import dataclass, field

import psutil
from rclpy.executors import SingleThreadedExecutor

from acts_control.stream_statistics import StreamCounter
from acts_core.realtime import RealtimeConfig, enter_realtime
from acts_core.realtime_guard import demote_process
from acts_msgs.msg import Contact
from acts_ros.qos import STREAM
from acts_tools.bench.graph import Graph
from acts_tools.bench.processes import START_TIMEOUT_S, check_alive, command_line, driver, reconstruction, virtual_board
from acts_tools.bench.result import Figure, Result
from acts_tools.bench.skin import pressed
from acts_tools.bench.workbench import Workbench
from acts_tools.percentiles import percentiles

# Those of docs/real_time.md.
_BOARD_PRIORITY, _DRIVER_PRIORITY, _RECONSTRUCTION_PRIORITY, _RECEIVER_PRIORITY = 45, 40, 38, 35
_LOOPS_A_CORE = 2
_SETTLE_S = 5.0
_NAMES = {"median": "median", "p99": "99 % within", "p99_9": "99.9 % within"}


@dataclass
class Published:
    """When contacts were published, by the middleware's own note [s after their stamp]."""

    counter: StreamCounter = field(default_factory=StreamCounter)

    def note(self, message: Contact, info: dict[str, int]) -> None:
        """Take one message with what the middleware knows of it."""
        stamp_ns = message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
        self.counter.step(message.sequence, (info["source_timestamp"] - stamp_ns) * 1e-9)


def measure(workbench: Workbench) -> Result:
    """Half of the time each: under the ordinary scheduler, and under SCHED_FIFO."""
    figures: list[Figure] = []
    p99_ms: dict[str, float] = {}
    for way, realtime in (("ordinary", False), ("fifo", True)):
        published, is_realtime = _run(workbench, realtime)
        if realtime and not is_realtime:
            return Result(figures, ["SCHED_FIFO is not allowed here, see `acts doctor`: only the ordinary scheduler"])
        values_ms = [1e3 * value for value in published.counter.take_latencies()]
        label = "SCHED_FIFO" if realtime else "ordinary scheduler"
        for name, value in percentiles(values_ms).items():
            shown = (
                f"stamp to published contact, {label}, {_NAMES[name]}" if name == "median" else f"    {_NAMES[name]}"
            )
            figures.append(Figure(f"{way}_ms.{name}", shown, value, "ms"))
            if name == "p99" and value is not None:
                p99_ms[way] = value
        figures.append(Figure(f"{way}_contacts", "    contacts received", published.counter.received))
    if len(p99_ms) == 2:
        ratio = p99_ms["ordinary"] / p99_ms["fifo"]
        figures.append(Figure("ratio", "99 %, ordinary scheduler to SCHED_FIFO", ratio, "times", is_ratio=True))
    return Result(figures)


def _run(workbench: Workbench, realtime: bool) -> tuple[Published, bool]:
    """Contacts of half of the time beside busy loops, and whether the driver's reader was under SCHED_FIFO."""
    folder = workbench.folder
    # The board stands for hardware, which nobody's load delays: it is under SCHED_FIFO both times, where that may be.
    options = ("--rate-hz", "1000", "--realtime-priority", str(_BOARD_PRIORITY), *pressed(folder))
    priorities = (_DRIVER_PRIORITY, _RECONSTRUCTION_PRIORITY) if realtime else (0, 0)
    published = Published()
    with ExitStack() as stack:
        board = stack.enter_context(virtual_board(folder, *options))
        process = stack.enter_context(driver(folder, board.link, f"realtime_priority:={priorities[0]}"))
        other = stack.enter_context(reconstruction(folder, f"realtime_priority:={priorities[1]}"))

        def check() -> None:
            check_alive(process, folder / "driver.log")
            check_alive(other, folder / "reconstruction.log")

        # Only this executor hands on what the middleware knows of a message.
        graph = stack.enter_context(Graph(workbench, SingleThreadedExecutor))
        first: list[Contact] = []
        subscription = graph.node.create_subscription(Contact, "contact", first.append, STREAM)
        graph.spin_until(lambda: first, START_TIMEOUT_S, "the first contact", check)
        graph.node.destroy_subscription(subscription)
        for number in range(_LOOPS_A_CORE * len(psutil.Process().cpu_affinity())):
            stack.enter_context(command_line(folder, f"loop_{number}", [sys.executable, "-c", "while True: pass"]))
        if realtime:
            # As a controller would: whoever shares the middleware's locks with real-time threads is to be one.
            # After the loops have been started, which would inherit it.
            stack.callback(demote_process)
            enter_realtime(
                RealtimeConfig(realtime_priority=_RECEIVER_PRIORITY), "bench", lambda _level, _sentence: None
            )
        graph.spin_for(min(_SETTLE_S, workbench.seconds))
        graph.node.create_subscription(Contact, "contact", published.note, STREAM)
        graph.spin_for(workbench.seconds / 2)
        check()
        return published, "SCHED_FIFO" in (folder / "driver.log").read_text(errors="replace")
