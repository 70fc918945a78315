# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""``dynamixel_bus``: the command line of a simulated bus of Dynamixel motors on free joints."""

from __future__ import annotations

import argparse
import contextlib
import json
import math
import signal
import sys
from collections.abc import Sequence
from pathlib import Path

from acts_core.names import own_words
from acts_core.runtime import RealtimeConfig, enter_realtime
from acts_core.stop_signals import StopSignals
from acts_sim.dynamixel.bus import Bus
from acts_sim.dynamixel.control import ControlSocket
from acts_sim.dynamixel.control_table import MODELS
from acts_sim.dynamixel.faults import Faults
from acts_sim.dynamixel.joints import FreeJoints
from acts_sim.dynamixel.motor import Motor
from acts_sim.dynamixel.port import BusPort
from acts_sim.shared import FileClaim, add_settings, number, require_within, settings_from, whole_number

_STEP_S = 0.002


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Parse the command line; arguments from ``--ros-args`` on are ignored."""
    parser = argparse.ArgumentParser(
        prog="dynamixel_bus", description="Simulated Dynamixel motors, Protocol 2.0, behind a pseudo-terminal."
    )
    parser.add_argument("--link", type=Path, help="symbolic link to the port")
    parser.add_argument(
        "--motors", type=whole_number, default=16, help="number of motors, with IDs from 0 on (1 to 100)"
    )
    parser.add_argument("--model", choices=sorted(MODELS), default="xc330", help="kind of motor")
    parser.add_argument(
        "--return-delay", type=whole_number, default=250, help="initial return delay time [2 us] (0 to 254)"
    )
    parser.add_argument(
        "--baud", type=whole_number, default=4_000_000, help="simulated baud rate; 0: packets take no time"
    )
    parser.add_argument(
        "--range-rad", type=number, default=math.pi, help="range of each joint to both sides of pi [rad]"
    )
    parser.add_argument("--control", type=Path, help="Unix socket for faults, one per line: lose 3, unplug ...")
    add_settings(parser, RealtimeConfig)
    options = parser.parse_args(own_words(arguments))
    require_within(parser, options, motors=(1, 100), return_delay=(0, 254), baud=(0, 10_000_000))
    if not 0.0 < options.range_rad <= 256.0 * math.tau:
        parser.error(f"--range-rad {options.range_rad}: allowed is above 0 to {256.0 * math.tau:.0f}")
    return options


def run(options: argparse.Namespace, signals: StopSignals) -> None:
    """Serve until a signal asks to stop.

    Raises
    ------
    ActsError
        When the port or the control socket cannot be made, or another process uses it.
    """
    scheduling = settings_from(options, RealtimeConfig)
    motors = [Motor(MODELS[options.model], number, options.return_delay) for number in range(options.motors)]
    bus = Bus(motors)
    limits = [(math.pi - options.range_rad, math.pi + options.range_rad)] * len(motors)
    joints = FreeJoints(motors, limits)
    with contextlib.ExitStack() as stack:
        if options.link is not None:
            stack.enter_context(contextlib.closing(FileClaim(options.link)))
        port = stack.enter_context(
            contextlib.closing(BusPort(bus, joints.step, _STEP_S, options.link, baud=options.baud))
        )
        # A client that was interrupted together with the motors is to switch their torque off first.
        signals.on_stop(lambda: port.stop(after_client=signals.first is not signal.SIGTERM))
        control = None
        if options.control is not None:
            control = ControlSocket(options.control, Faults(bus, joints, port).answer)
            stack.enter_context(contextlib.closing(control))
        enter_realtime(scheduling, "all of it", lambda _level, sentence: print(sentence, file=sys.stderr, flush=True))
        print(json.dumps({"port": port.path, "link": str(options.link or "")}), flush=True)
        port.run(control)


def main(signals: StopSignals) -> int:
    """Run the simulated bus; 0 after a signal."""
    run(parse(sys.argv[1:]), signals)
    return 0
