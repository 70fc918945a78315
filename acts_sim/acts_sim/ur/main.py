# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""``ur_controller``: the command line of the simulated UR5e controller."""

from __future__ import annotations

import argparse
import contextlib
import gc
import signal
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from acts_core.names import own_words
from acts_core.runtime import RealtimeConfig, enter_realtime
from acts_core.stop_signals import StopSignals
from acts_sim.shared import (
    JOINT_RING_WIDTH,
    FileClaim,
    LineSession,
    TimedRingWriter,
    add_settings,
    settings_from,
    whole_number,
)
from acts_sim.ur import Controller, UrControllerConfig
from acts_sim.ur.ports import Port, RtdePort, ScriptSession, Server, dashboard, hooks

RTDE_PORT, DASHBOARD_PORT, SCRIPT_PORT = 30004, 29999, 30003
_LARGEST_PORT = 65535


@dataclass(frozen=True)
class ControllerSettings(RealtimeConfig, UrControllerConfig):
    """Options of the command line: settings of the robot, and of the scheduling of its process."""

    def __post_init__(self) -> None:
        RealtimeConfig.__post_init__(self)


class _Log:
    """Writes lines to standard error: the same line at most once a second, and at most 20 lines a second."""

    def __init__(self, host: str) -> None:
        self._prefix = f"ur_controller {host}:"
        self._since_s = 0.0
        self._said: set[str] = set()

    def __call__(self, text: str) -> None:
        now_s = time.monotonic()
        if now_s - self._since_s >= 1.0:
            self._since_s = now_s
            self._said.clear()
        if text in self._said or len(self._said) >= 20:
            return
        self._said.add(text)
        with contextlib.suppress(OSError):  # nobody reads it
            print(self._prefix, text, file=sys.stderr, flush=True)


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Parse the command line; arguments from ``--ros-args`` on are ignored."""
    parser = argparse.ArgumentParser(prog="ur_controller", description="Simulated UR5e controller for ur_rtde.")
    parser.add_argument("--host", default="127.0.0.1", help="address to listen on; for a second robot 127.0.0.2 ...")
    parser.add_argument("--joint-ring", type=Path, help="file of the shared ring with q(6), qd(6) of every cycle")
    parser.add_argument(
        "--hook-port",
        type=whole_number,
        default=0,
        help="port of the test hooks; 0: none. Lines: protective_stop, state ...",
    )
    add_settings(parser, ControllerSettings)
    options = parser.parse_args(own_words(arguments))
    # An empty one would be every address of this machine.
    if not options.host.strip():
        parser.error("--host is empty: needed is an address of this machine, such as 127.0.0.1")
    if not 0 <= options.hook_port <= _LARGEST_PORT:
        parser.error(f"--hook-port {options.hook_port}: allowed is 0 (none) to {_LARGEST_PORT}")
    return options


def run(options: argparse.Namespace, signals: StopSignals) -> None:
    """Serve until a signal asks to stop.

    Raises
    ------
    ActsError
        When a setting is out of range, a port is taken or the ring cannot be written.
    """
    config = settings_from(options, ControllerSettings)
    log = _Log(options.host)
    controller = Controller(config, log)
    rtde = RtdePort(controller)
    ports = [
        Port(RTDE_PORT, "RTDE", rtde.session),
        Port(SCRIPT_PORT, "script", lambda: ScriptSession(controller)),
        Port(
            DASHBOARD_PORT,
            "dashboard",
            lambda: LineSession(lambda line: dashboard.answer(controller, line), dashboard.GREETING),
        ),
    ]
    if options.hook_port:
        ports.append(Port(options.hook_port, "hook", lambda: LineSession(lambda line: hooks.answer(controller, line))))

    with contextlib.ExitStack() as stack:
        ring: TimedRingWriter | None = None
        ring_values = np.zeros(JOINT_RING_WIDTH)

        def cycle(time_ns: int) -> None:
            controller.tcp_wanted = rtde.needs_tcp
            controller.tick()
            if ring is not None:
                ring_values[:6] = controller.joints.q
                ring_values[6:] = controller.joints.qd
                ring.write(time_ns, ring_values)

        server = stack.enter_context(contextlib.closing(Server(options.host, ports, cycle, log)))

        # A client that was interrupted together with the robot is to bring it to rest first.
        signals.on_stop(lambda: server.stop(after_clients=signals.first is not signal.SIGTERM))
        if options.joint_ring is not None:
            stack.enter_context(contextlib.closing(FileClaim(options.joint_ring)))
            ring = stack.enter_context(TimedRingWriter(options.joint_ring, JOINT_RING_WIDTH))
        # All present objects live as long as the process: exempt them from garbage collection.
        gc.freeze()
        enter_realtime(config, "all of it", lambda _level, sentence: log(sentence))
        print("ready", flush=True)
        server.run()


def main(signals: StopSignals) -> int:
    """Run the simulated controller; 0 after a signal."""
    run(parse(sys.argv[1:]), signals)
    return 0
