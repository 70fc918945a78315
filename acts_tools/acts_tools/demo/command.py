# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts demo NAME`: the demonstrations by name."""

from __future__ import annotations

import argparse
from pathlib import Path

from acts_tools.arguments import random_seed, real, whole

_EPILOG = """\
examples:
  acts demo ball_balancing                              all of it, some 30 s
  acts demo ball_balancing --seconds 10                 as much as fits into this time
  acts demo hand                                        the four acts of the hand, about a minute
  acts demo hand slip sharp                             two of them
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``demo`` to the acts command."""
    parser = subparsers.add_parser(
        "demo",
        help="run a demonstration in simulation",
        description="Run a demonstration with everything simulated. The results are in the folder out.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    demos = parser.add_subparsers(dest="demo", required=True, metavar="NAME")
    ball = demos.add_parser(
        "ball_balancing",
        help="a UR5e balances a ball by touch and traces N, B and I",
        description="Ball balancing by touch with simulated skin, ball and UR5e. The exit code is 0 if the trajectory "
        "came to its end within the limits that the result shows.",
    )
    ball.add_argument(
        "--seconds", type=real(5.0, 600.0), help="shorten it: trace only what fits into this time (default: all)"
    )
    ball.add_argument("--out", type=Path, default=Path("out"), help="folder for the results (default: out)")
    ball.add_argument(
        "--robot-ip", default="127.0.0.1", help="loopback address of the simulated robot (default: %(default)s)"
    )
    ball.add_argument(
        "--realtime-priority",
        type=whole(0, 99),
        default=0,
        help="priority of all processes under SCHED_FIFO, 1 to 99, where the limits allow it; see docs/real_time.md",
    )
    hand = demos.add_parser(
        "hand",
        help="a LEAP hand holds, balances, avoids and shakes hands by touch",
        description="The reflexes of a simulated LEAP hand, with a new hand for each act. The exit code is 0 if the "
        "result is good, that is, every act met all that is asked of it, and 1 if it only works "
        "(docs/hand_demo.md).",
    )
    hand.add_argument(
        "acts", nargs="*", metavar="ACT", help="acts to play: sphere, slip, sharp, hand_to_hand (default: all)"
    )
    hand.add_argument("--out", type=Path, default=Path("out"), help="folder for the results (default: out)")
    hand.add_argument(
        "--seed", type=random_seed, default=5, help="seed of the simulated hands' variation (default: %(default)s)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the chosen demonstration and return its exit code."""
    # Imported here: other commands need neither ROS messages nor the drawing library.
    if arguments.demo == "hand":
        from acts_tools.demo.hand import run as hand

        return hand.run(arguments.acts, arguments.out, arguments.seed)
    from acts_tools.demo.ball import run as ball

    return ball.run(arguments.seconds, arguments.out, arguments.robot_ip, arguments.realtime_priority)
