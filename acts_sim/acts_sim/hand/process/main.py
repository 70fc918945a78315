# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""``hand_world``: the command line of the simulated LEAP hand with its skin, its motors and an object."""

from __future__ import annotations

import argparse
import contextlib
import json
import signal
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from acts_core.errors import ActsError
from acts_core.names import own_words
from acts_core.runtime import RealtimeConfig, enter_realtime
from acts_core.stop_signals import StopSignals
from acts_sim.dynamixel import BusPort, ControlSocket, state
from acts_sim.hand import STEP_S, HandWorld, HandWorldConfig, carry_out, row_width
from acts_sim.hand.process.loop import HandWorldLoop
from acts_sim.shared import (
    FileClaim,
    TimedRingWriter,
    add_settings,
    default_run_dir,
    number,
    require_within,
    settings_from,
    telling_of_compiling,
    whole_number,
)

TRUTH_SLOTS = 8192
"""Number of steps of truth in the ring: 16 s."""

_FILES = ("link", "field-ring", "truth-ring", "control")


def parse(arguments: Sequence[str]) -> tuple[argparse.Namespace, HandWorldConfig]:
    """Parse the command line; arguments from ``--ros-args`` on are ignored."""
    parser = argparse.ArgumentParser(
        prog="hand_world", description="A simulated LEAP hand: 16 Dynamixel motors on a port, 1024 taxels in a ring."
    )
    folder = "in the folder /dev/shm/acts-USER by default"
    parser.add_argument("--link", type=Path, help=f"symbolic link to the motors' port; hand {folder}")
    parser.add_argument("--field-ring", type=Path, help=f"shared file with the skin's counts; field.ring {folder}")
    parser.add_argument("--truth-ring", type=Path, help=f"shared file with the true state; truth.ring {folder}")
    parser.add_argument("--control", type=Path, help=f"Unix socket for commands; hand.control {folder}")
    parser.add_argument(
        "--baud", type=whole_number, default=4_000_000, help="simulated baud rate; 0: packets take no time"
    )
    parser.add_argument("--lead-ms", type=number, default=4.0, help="how far the world is ahead of the clock (2 to 20)")
    add_settings(parser, RealtimeConfig)
    add_settings(parser.add_argument_group("the world"), HandWorldConfig)
    options = parser.parse_args(own_words(arguments))
    require_within(parser, options, baud=(0, 10_000_000), lead_ms=(2.0, 20.0))
    run_dir = default_run_dir()
    options.link = options.link or run_dir / "hand"
    options.field_ring = options.field_ring or run_dir / "field.ring"
    options.truth_ring = options.truth_ring or run_dir / "truth.ring"
    options.control = options.control or run_dir / "hand.control"
    files = {f"--{name}": getattr(options, name.replace("-", "_")) for name in _FILES}
    for name, path in files.items():
        others = [other for other, taken in files.items() if taken.absolute() == path.absolute() and other != name]
        if others:
            parser.error(f"{name} and {others[0]} are both {path}: each needs a path of its own")
    return options, settings_from(options, HandWorldConfig)


def run(options: argparse.Namespace, config: HandWorldConfig, signals: StopSignals) -> None:
    """Run the world until a signal asks to stop.

    Raises
    ------
    ActsError
        When a ring, the port or the control socket cannot be made, or another process uses it.
    """
    scheduling = settings_from(options, RealtimeConfig)
    with contextlib.ExitStack() as stack:
        for path in (options.field_ring, options.truth_ring, options.link):
            stack.enter_context(contextlib.closing(FileClaim(path)))
        # Its kernels are compiled here where they are new.
        with signals.interrupting(), telling_of_compiling(_tell):
            world = HandWorld(config)
        patches = world.layout.patches
        field = stack.enter_context(TimedRingWriter(options.field_ring, len(world.forces_n)))
        truth = stack.enter_context(TimedRingWriter(options.truth_ring, row_width(len(patches)), TRUTH_SLOTS))
        loop = HandWorldLoop(world, field, truth, round(options.lead_ms * 1e6))
        port = stack.enter_context(
            contextlib.closing(BusPort(world.bus, loop.step, STEP_S, options.link, baud=options.baud))
        )
        # A client that was interrupted together with the motors is to switch their torque off first.
        signals.on_stop(lambda: port.stop(after_client=signals.first is not signal.SIGTERM))
        control = ControlSocket(options.control, lambda line: answer(world, loop, port, line))
        stack.enter_context(contextlib.closing(control))
        enter_realtime(scheduling, "all of it", lambda _level, sentence: _tell(sentence))
        print(json.dumps({"port": port.path, "link": str(options.link)}), flush=True)
        port.run(control)


def _tell(sentence: str) -> None:
    print(sentence, file=sys.stderr, flush=True)


_OF_THE_PROCESS = ("unplug", "plug_in", "state")


def answer(world: HandWorld, loop: HandWorldLoop, port: BusPort, line: str) -> str:
    """Execute a line of the control socket and return ``ok``, a JSON object for ``state``, or ``error: ...``."""
    if line == "state":
        return json.dumps(
            {
                "connected": port.connected,
                "loop": asdict(loop.statistics),
                "motors": [state(motor) for motor in world.motors],
                "truth": world.truth.as_dict(),
            }
        )
    try:
        if line == "unplug":
            port.unplug()
        elif line == "plug_in":
            port.plug_in()
        else:
            carry_out(world, line, _OF_THE_PROCESS)
    except ActsError as error:
        return f"error: {error}"
    return "ok"


def main(signals: StopSignals) -> int:
    """Run the simulated hand; 0 after a signal."""
    options, config = parse(sys.argv[1:])
    run(options, config, signals)
    return 0
