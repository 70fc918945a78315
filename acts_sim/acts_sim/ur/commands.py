# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The simulated commands of the control script, by code: arguments, effect and result.

Arguments are in the input registers, in the order of the client's function. Results are written to output integer
register 1 or output double registers 0 to 5.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from acts_sim.ur.config import CYCLE_S, POSITION_LIMIT_RAD
from acts_sim.ur.controller import Controller
from acts_sim.ur.joints import Move, Servo, Speed
from acts_sim.ur.pose import pose_from_transform, transform_from_pose
from acts_sim.ur.program import Command, ControlProgram

MOVE_J, SPEED_J, SERVO_J = 1, 9, 11

MOTION_COMMANDS = frozenset({MOVE_J, SPEED_J, SERVO_J})
"""Commands whose arguments must be complete: a missing value would move a joint to a wrong position."""

# Range of servoj's lookahead time [s].
_LOOKAHEAD_RANGE_S = (0.03, 0.2)

_LARGEST = 1e6


def _refuse(controller: Controller, what: str, values: Sequence[float]) -> None:
    numbers = ", ".join(f"{value:.6g}" for value in values)
    controller.protective_stop(f"{what}: not finite or out of range: {numbers}")


def _in_range(q_rad: Sequence[float]) -> bool:
    # Written so that NaN is out of range.
    return all(abs(angle) <= POSITION_LIMIT_RAD for angle in q_rad)


def _sensible(values: Sequence[float]) -> bool:
    # Poses in metres and radians; the sine of larger numbers is meaningless before they overflow.
    return all(abs(value) <= _LARGEST for value in values)


def _move_j(program: ControlProgram, controller: Controller) -> None:
    target = program.six(controller)
    speed, acceleration = program.double(controller, 6), program.double(controller, 7)
    if not _in_range(target):
        _refuse(controller, "target of moveJ", target)
    elif not (0.0 < speed < math.inf and 0.0 < acceleration < math.inf):
        _refuse(controller, "speed and acceleration of moveJ", (speed, acceleration))
    else:
        program.move(controller, Move(target, speed, acceleration), program.integer(controller, 1) == 1)


def _servo_j(program: ControlProgram, controller: Controller) -> None:
    target, lookahead = program.six(controller), program.double(controller, 9)
    if not _in_range(target):
        _refuse(controller, "target of servoJ", target)
    elif not math.isfinite(lookahead):
        _refuse(controller, "lookahead time of servoJ", (lookahead,))
    else:
        shortest, longest = _LOOKAHEAD_RANGE_S
        program.servo(controller, target, min(max(lookahead, shortest), longest))


def _speed_j(program: ControlProgram, controller: Controller) -> None:
    target, acceleration = program.six(controller), program.double(controller, 6)
    if not all(math.isfinite(speed) for speed in target):
        _refuse(controller, "target of speedJ", target)
    elif not 0.0 < acceleration < math.inf:
        _refuse(controller, "acceleration of speedJ", (acceleration,))
    else:
        program.speed(controller, target, acceleration)


def _servo_stop(program: ControlProgram, controller: Controller) -> None:
    program.stop(controller, program.double(controller, 0), Servo)


def _speed_stop(program: ControlProgram, controller: Controller) -> None:
    program.stop(controller, program.double(controller, 0), Speed)


def _stop(program: ControlProgram, controller: Controller) -> None:
    program.stop_move(controller, program.double(controller, 0), program.integer(controller, 1) == 1)


def _protective_stop(program: ControlProgram, controller: Controller) -> None:
    controller.protective_stop("asked for by the client")


def _set_watchdog(program: ControlProgram, controller: Controller) -> None:
    frequency = program.double(controller, 0)
    program.watchdog_s = 1.0 / frequency if 0.0 < frequency < math.inf else math.inf


def _set_payload(program: ControlProgram, controller: Controller) -> None:
    mass, *centre = (program.double(controller, index) for index in range(4))
    controller.output.set("payload", mass)
    if any(centre):
        controller.output.set("payload_cog", *centre)


def _set_tcp(program: ControlProgram, controller: Controller) -> None:
    pose = program.six(controller)
    if _sensible(pose):
        controller.set_tcp(pose)
    else:
        _refuse(controller, "pose of setTcp", pose)


def _accept(program: ControlProgram, controller: Controller) -> None:
    """Accept settings of forces and gravity, which are not simulated."""


def _answer_six(program: ControlProgram, controller: Controller, values: Sequence[float]) -> None:
    for index, value in enumerate(values):
        controller.output.set(program.output_name("double", index), value)


def _answer_integer(program: ControlProgram, controller: Controller, value: int) -> None:
    controller.output.set(program.output_name("int", 1), value)


def _get_steptime(program: ControlProgram, controller: Controller) -> None:
    controller.output.set(program.output_name("double", 0), CYCLE_S)


def _get_history(program: ControlProgram, controller: Controller) -> None:
    history = controller.history
    steps = min(max(program.integer(controller, 1), 0), len(history) - 1)
    _answer_six(program, controller, history[-1 - steps])


def _get_tcp_offset(program: ControlProgram, controller: Controller) -> None:
    _answer_six(program, controller, pose_from_transform(controller.tcp_offset))


def _get_flange_pose(program: ControlProgram, controller: Controller) -> None:
    _answer_six(program, controller, pose_from_transform(controller.transform(controller.joints.q)))


def _forward_kinematics(program: ControlProgram, controller: Controller) -> None:
    tcp = controller.transform(controller.joints.q) @ controller.tcp_offset
    _answer_six(program, controller, pose_from_transform(tcp))


def _forward_kinematics_of(program: ControlProgram, controller: Controller) -> None:
    q, offset = program.six(controller), program.six(controller, 6)
    if not _sensible((*q, *offset)):
        _refuse(controller, "arguments of getForwardKinematics", (*q, *offset))
        return
    _answer_six(program, controller, pose_from_transform(controller.transform(q) @ transform_from_pose(offset)))


def _pose_trans(program: ControlProgram, controller: Controller) -> None:
    first, second = program.six(controller), program.six(controller, 6)
    if not _sensible((*first, *second)):
        _refuse(controller, "arguments of poseTrans", (*first, *second))
        return
    _answer_six(program, controller, pose_from_transform(transform_from_pose(first) @ transform_from_pose(second)))


def _joints_within_limits(program: ControlProgram, controller: Controller) -> None:
    _answer_integer(program, controller, int(_in_range(program.six(controller))))


def _is_steady(program: ControlProgram, controller: Controller) -> None:
    _answer_integer(program, controller, int(controller.joints.at_rest))


COMMANDS: dict[int, Command] = {
    MOVE_J: Command(_move_j),
    8: Command(_accept),  # zeroFtSensor
    SPEED_J: Command(_speed_j, is_streamed=True),
    SERVO_J: Command(_servo_j, is_streamed=True),
    15: Command(_speed_stop),
    16: Command(_servo_stop),
    17: Command(_set_payload),
    26: Command(_get_steptime, is_streamed=True),
    27: Command(_get_history, is_streamed=True),
    29: Command(_set_tcp),
    31: Command(_protective_stop),
    33: Command(_stop),  # stopL
    34: Command(_stop),  # stopJ
    35: Command(_set_watchdog),
    37: Command(_joints_within_limits),
    39: Command(_pose_trans),
    40: Command(_get_tcp_offset),
    43: Command(_forward_kinematics),
    44: Command(_forward_kinematics_of),
    47: Command(_is_steady),
    58: Command(_get_flange_pose, is_streamed=True),
    59: Command(_accept),  # setGravity
}
"""The simulated commands, by code."""
