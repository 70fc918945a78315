# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Emulation of the control script that ``ur_rtde`` uploads: its handshake over registers, once per cycle.

The client writes a command to input integer register 0 and reads the reply from output integer register 0: 1 is ready,
2 is done. The reply "done" stays until the client clears the command to 0. A streamed command is executed in every
cycle while its code is in the register, and the reply is always "ready". Any other command is executed once, and the
reply comes when it has ended. An offset of 0 or 24 is added to all register numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import NamedTuple, cast

from acts_sim.ur.controller import Controller, ProgramEnded
from acts_sim.ur.joints import Brake, Motion, Move, Servo, Speed

READY = 1
DONE = 2

CLEAR_COMMAND = 0
STOP_SCRIPT_COMMAND = 255


class Command(NamedTuple):
    """Function of the script for one code in the command register.

    Attributes
    ----------
    carry_out : callable
        Called with the program and the controller; reads the arguments from the input registers.
    is_streamed : bool
        Whether it is executed in every cycle, and the reply is never "done".
    """

    carry_out: Callable[[ControlProgram, Controller], None]
    is_streamed: bool = False


class ControlProgram:
    """One run of the control script.

    Parameters
    ----------
    commands : mapping of int to Command
        Known commands, by code.
    name : str
        Name of the program.
    register_offset : int
        Added to every register number.
    """

    def __init__(self, commands: Mapping[int, Command], name: str = "rtde_control", register_offset: int = 0) -> None:
        self._commands = commands
        self.name = name
        self.register_offset = register_offset
        self.watchdog_s = math.inf
        self._command_name = self._input("int", 0)
        self._double_names = [self._input("double", index) for index in range(18)]
        self._executing = False
        self._started = False
        self._blocking = False
        self._motion: Motion | None = None
        self._servo = Servo()
        self._speed = Speed()
        self._async_running = False
        self._async_operation = 0
        self._async_writes = 0

    # --- one cycle

    def cycle(self, controller: Controller) -> None:
        """Execute one cycle of the script.

        Raises
        ------
        ProgramEnded
            When it ends.
        """
        if not self._started:
            self._started = True
            controller.output.set(self.output_name("int", 1), 0)
            self._finish_async(controller)
            self._answer(controller, READY)
        if controller.since_command_s(self._command_name) > self.watchdog_s:
            raise ProgramEnded(f"watchdog: no command from the client for {self.watchdog_s:g} s")
        if self._motion_ended(controller):
            return
        command = self.command(controller)
        known = self._commands.get(command)
        if known is not None and known.is_streamed:
            if self._execute(command, controller):
                self._answer(controller, READY)
        elif command == CLEAR_COMMAND:
            self._executing = False
            self._answer(controller, READY)
        elif not self._executing:
            self._executing = True
            if self._execute(command, controller) and not self._blocking:
                self._answer(controller, DONE)

    def _execute(self, command: int, controller: Controller) -> bool:
        """Execute a command; False after a safety stop, when the paused script no longer replies."""
        if command == STOP_SCRIPT_COMMAND:
            raise ProgramEnded
        known = self._commands.get(command)
        if known is None:
            raise ProgramEnded(f"command {command} is not simulated; see docs/simulated_ur5e.md for those that are")
        known.carry_out(self, controller)
        return not controller.stopped_for_safety

    def _motion_ended(self, controller: Controller) -> bool:
        """Handle the end of a motion; return whether the script still waits for it."""
        if not controller.motion_done:
            return self._blocking
        if self._blocking:
            self._blocking = False
            self._motion = None
            self._answer(controller, DONE)
        elif self._async_running:
            self._motion = None
            self._finish_async(controller)
        return False

    def resume(self, controller: Controller) -> None:
        """Resume the motion after a pause."""
        if self._motion is not None:
            if isinstance(self._motion, Move):
                self._motion.restart()
            controller.move(self._motion)

    # --- for the commands: registers

    def command(self, controller: Controller) -> int:
        """The command that the client has written."""
        return self.integer(controller, 0)

    def integer(self, controller: Controller, index: int) -> int:
        """An input integer register."""
        return cast(int, controller.registers[self._input("int", index) if index else self._command_name])

    def double(self, controller: Controller, index: int) -> float:
        """An input double register."""
        return cast(float, controller.registers[self._double_names[index]])

    def six(self, controller: Controller, index: int = 0) -> list[float]:
        """Six input double registers from `index` on."""
        return [self.double(controller, index + step) for step in range(6)]

    def output_name(self, kind: str, index: int) -> str:
        """Name of an output register; `kind` is int or double."""
        return f"output_{kind}_register_{index + self.register_offset}"

    def _input(self, kind: str, index: int) -> str:
        return f"input_{kind}_register_{index + self.register_offset}"

    def _answer(self, controller: Controller, status: int) -> None:
        controller.output.set(self.output_name("int", 0), status)

    # --- for the commands: motion

    def servo(self, controller: Controller, target_rad: list[float], lookahead_s: float) -> None:
        """Follow a target."""
        self._require_free(self._servo, "servoJ")
        self._servo.set(target_rad, lookahead_s)
        self._take(controller, self._servo)

    def speed(self, controller: Controller, target_rad_s: list[float], acceleration_rad_s2: float) -> None:
        """Move at joint speeds."""
        self._require_free(self._speed, "speedJ")
        self._speed.set(target_rad_s, acceleration_rad_s2)
        self._take(controller, self._speed)

    def move(self, controller: Controller, motion: Move, asynchronous: bool) -> None:
        """Move to a target; the reply comes at the end of the move, or at once if `asynchronous`."""
        self._require_no_stream("moveJ")
        self._start(controller, motion, asynchronous)

    def stop(self, controller: Controller, deceleration_rad_s2: float, stream: type[Servo] | type[Speed]) -> None:
        """End the stream of targets, if there is one, and brake to rest."""
        if not isinstance(self._motion, stream):
            self._require_no_stream("a stop")
        self._start(controller, self._braking(controller, deceleration_rad_s2), False)

    def stop_move(self, controller: Controller, deceleration_rad_s2: float, asynchronous: bool) -> None:
        """Abort a move and brake to rest."""
        self._require_no_stream("stopJ or stopL")
        self._start(controller, self._braking(controller, deceleration_rad_s2), asynchronous)

    def _braking(self, controller: Controller, deceleration_rad_s2: float) -> Brake:
        usable = math.isfinite(deceleration_rad_s2) and deceleration_rad_s2 > 0.0
        return Brake(deceleration_rad_s2 if usable else controller.config.stop_deceleration_rad_s2)

    def _start(self, controller: Controller, motion: Motion, asynchronous: bool) -> None:
        if self._async_running:
            self._finish_async(controller)
        if asynchronous:
            self._async_operation = (self._async_operation + 1) % 128
            self._async_running = True
            self._write_async(controller, 0x8000)
        self._blocking = not asynchronous
        self._take(controller, motion)

    def _take(self, controller: Controller, motion: Motion) -> None:
        if self._motion is not motion:
            self._motion = motion
            controller.move(motion)

    # In the script, streams and asynchronous moves are separate threads, and only one may control the arm.

    def _require_no_stream(self, what: str) -> None:
        if isinstance(self._motion, Servo | Speed):
            stop = "servoStop" if isinstance(self._motion, Servo) else "speedStop"
            raise ProgramEnded(f"{what} while another thread is controlling the robot; call {stop} first")

    def _require_free(self, motion: Servo | Speed, what: str) -> None:
        if self._motion is not None and self._motion is not motion:
            kind = type(self._motion).__name__
            raise ProgramEnded(f"{what} while another thread is controlling the robot ({kind}); stop that first")

    # --- progress of an asynchronous move: operation << 24 | number of writes << 16 | running << 15 | progress

    def _finish_async(self, controller: Controller) -> None:
        self._async_running = False
        self._write_async(controller, 0)

    def _write_async(self, controller: Controller, state: int) -> None:
        self._async_writes = (self._async_writes + 1) % 128
        value = self._async_operation << 24 | self._async_writes << 16 | state
        controller.output.set(self.output_name("int", 2), value)
