# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The dashboard server: one line of reply to each line of text."""

from __future__ import annotations

from acts_sim.ur import VERSION, Controller, RobotMode, RuntimeState, SafetyMode

GREETING = "Connected: Universal Robots Dashboard Server"

SERIAL_NUMBER = "20235500001"
"""Digits only, or the client refuses it."""

_PROGRAM_FILE = "rtde_control.urp"

_QUESTIONS = frozenset({"running", "programState"})

_SAFETY_NAMES = {
    SafetyMode.NORMAL: "NORMAL",
    SafetyMode.PROTECTIVE_STOP: "PROTECTIVE_STOP",
    SafetyMode.ROBOT_EMERGENCY_STOP: "ROBOT_EMERGENCY_STOP",
}

_UNLOCK_TOO_EARLY = (
    "Cannot unlock protective stop until {seconds:g}s after occurrence. "
    "Always inspect cause of protective stop before unlocking"
)

_UNLOCK_IN_EMERGENCY = "Cannot unlock protective stop: the robot is stopped by its emergency stop"


def answer(controller: Controller, line: str) -> str:
    """Execute a line of the client and return the reply."""
    fixed = {
        "PolyscopeVersion": "URSoftware {}.{}.{}.{} (Oct 14 2021)".format(*VERSION),
        "version": "URSoftware {}.{}.{}.{} (Oct 14 2021)".format(*VERSION),
        "get serial number": SERIAL_NUMBER,
        "get robot model": "UR5",
        "is in remote control": "true",
        "robotmode": f"Robotmode: {controller.robot_mode.name}",
        "safetymode": f"Safetymode: {_SAFETY_NAMES[controller.safety]}",
        "safetystatus": f"Safetystatus: {_SAFETY_NAMES[controller.safety]}",
        "get loaded program": "No program loaded",
        "isProgramSaved": "True",
        "close popup": "closing popup",
        "close safety popup": "closing safety popup",
        "restart safety": "Restarting safety",
        "get operational mode": "NONE",
        "quit": "Disconnected",
    }
    if line in fixed:
        return fixed[line]
    actions = {
        "running": _running,
        "programState": _program_state,
        "play": _play,
        "pause": _pause,
        "stop": _stop,
        "unlock protective stop": _unlock,
        "power on": _power_on,
        "power off": _power_off,
        "brake release": _brake_release,
        "shutdown": _shutdown,
    }
    if line in actions:
        if line not in _QUESTIONS:
            controller.note("dashboard", line)
        return actions[line](controller)
    word, _, rest = line.partition(" ")
    if word == "load" and rest:
        return f"File not found: {rest}"
    with_text = {"popup": "showing popup", "addToLog": "Added log message", "setUserRole": f"Setting user role: {rest}"}
    if word in with_text:
        return with_text[word]
    return f'could not understand: "{line}"'


def _running(controller: Controller) -> str:
    return f"Program running: {str(controller.runtime == RuntimeState.PLAYING).lower()}"


def _program_state(controller: Controller) -> str:
    state = controller.runtime
    word = state.name if state in (RuntimeState.PLAYING, RuntimeState.PAUSED) else "STOPPED"
    return f"{word} {_PROGRAM_FILE}"


def _play(controller: Controller) -> str:
    return "Starting program" if controller.play_program() else "Failed to execute: play"


def _pause(controller: Controller) -> str:
    return "Pausing program" if controller.pause_program() else "Failed to execute: pause"


def _stop(controller: Controller) -> str:
    controller.stop_program()
    return "Stopped"


def _unlock(controller: Controller) -> str:
    if controller.safety == SafetyMode.ROBOT_EMERGENCY_STOP:
        return _UNLOCK_IN_EMERGENCY
    if controller.unlock_protective_stop():
        return "Protective stop releasing"
    return _UNLOCK_TOO_EARLY.format(seconds=controller.config.unlock_after_s)


def _power_on(controller: Controller) -> str:
    if controller.robot_mode == RobotMode.POWER_OFF:
        controller.set_power(RobotMode.IDLE)
    return "Powering on"


def _power_off(controller: Controller) -> str:
    controller.set_power(RobotMode.POWER_OFF)
    return "Powering off"


def _brake_release(controller: Controller) -> str:
    if controller.robot_mode == RobotMode.IDLE:
        controller.set_power(RobotMode.RUNNING)
    return "Brake releasing"


def _shutdown(controller: Controller) -> str:
    # Only the arm: the process goes on, as whoever has started it expects.
    controller.set_power(RobotMode.POWER_OFF)
    return "Shutting down"
