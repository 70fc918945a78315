# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What clients of a UR5e do, with the real ur_rtde, each in a process of its own: ``ur_clients.py SCENARIO HOST``.

A scenario prints what it has found out as one line of JSON. The process then ends without the client's clean-up, which
takes half a second for each connection (and leaves the simulator with clients that vanish).
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable
from typing import Any

from dashboard_client import DashboardClient
from rtde_control import RTDEControlInterface
from rtde_receive import RTDEReceiveInterface
from ur_process import hook
from ur_simulator import wait_for

from acts_core.robots import ur5e

LEVEL = list(ur5e.LEVEL_Q_RAD)


def is_at(receive: RTDEReceiveInterface, q_rad: list[float]) -> Callable[[], bool]:
    """Whether an arm's joints are received as they are to be."""
    return lambda: receive.getActualQ() == q_rad


def servo(control: RTDEControlInterface, q: list[float], lookahead_s: float = 0.1) -> bool:
    return bool(control.servoJ(q, 0.0, 0.0, 0.002, lookahead_s, 300.0))


def plus(q: list[float], offset: float) -> list[float]:
    return [angle + offset for angle in q]


def basics(host: str) -> dict[str, Any]:
    receive = RTDEReceiveInterface(host)
    control = RTDEControlInterface(host)
    found: dict[str, Any] = {"connected": receive.isConnected() and control.isConnected()}
    control.moveJ(LEVEL, 3.0, 10.0)
    target = plus(LEVEL, 0.2)
    before = receive.getTimestamp()
    found["move"] = control.moveJ(target, 2.0, 8.0)
    wait_for(lambda: receive.getActualQ() == target, "the end of the move to be received")
    found["duration_s"] = receive.getTimestamp() - before
    found["steady"] = control.isSteady()
    found["kinematics"] = [control.getForwardKinematics(), receive.getActualTCPPose()]
    wait_for(lambda: control.getStepTime() == 0.002, "the cycle time")
    wait_for(lambda: control.getActualJointPositionsHistory(0) == target, "the joints' history")
    found["modes"] = [receive.getRobotMode(), receive.getSafetyMode(), receive.getRuntimeState()]
    found["bits"] = [receive.getRobotStatus(), receive.getSafetyStatusBits(), control.getRobotStatus()]

    # Slowly: a busy machine may not run this process while a short move is shown.
    control.moveJ(LEVEL, 2.0, 0.3, True)
    wait_for(lambda: control.getAsyncOperationProgress() >= 0, "the asynchronous move to be shown")
    wait_for(lambda: control.getAsyncOperationProgress() < 0, "its end")
    wait_for(lambda: receive.getActualQ() == LEVEL, "its target to be received")

    control.moveJ(plus(LEVEL, 2.0), 1.0, 2.0, True)
    wait_for(lambda: receive.getActualQ()[0] > 0.05, "the arm to move")
    control.stopJ(8.0)
    wait_for(lambda: max(abs(speed) for speed in receive.getActualQd()) == 0.0, "the arm to rest")
    found["short_of_target"] = receive.getActualQ()[0] < LEVEL[0] + 1.9

    control.speedJ([0.3, 0, 0, 0, 0, 0], 2.0, 0.0)
    wait_for(lambda: receive.getActualQd()[0] > 0.29, "the speed")
    found["speed_stop"] = control.speedStop(10.0)

    control.stopScript()
    found["running"] = control.isProgramRunning()
    found["servo_after_stop"] = servo(control, LEVEL)
    control.reuploadScript()
    wait_for(control.isProgramRunning, "the script to run again")
    found["move_again"] = control.moveJ(LEVEL, 3.0, 10.0)
    return found


def streaming(host: str) -> dict[str, Any]:
    receive = RTDEReceiveInterface(host)
    control = RTDEControlInterface(host)
    control.moveJ(LEVEL, 3.0, 10.0)
    speed, start = 0.3, receive.getTimestamp()
    accepted, lags_s = True, []
    while (now := receive.getTimestamp()) < start + 1.0:
        period = control.initPeriod()
        target = list(LEVEL)
        target[3] += speed * (now - start)
        accepted = servo(control, target) and accepted
        if now > start + 0.5:
            lags_s.append((target[3] - receive.getActualQ()[3]) / speed)
        control.waitPeriod(period)
    lags_s.sort()
    wait_for(lambda: abs(receive.getActualQ()[3] - target[3]) < 1e-6, "the last target to be reached")
    # As far as a jump may go: followed, within the limits.
    jump, fastest = list(target), 0.0
    jump[5] += 2.0
    servo(control, jump, 0.03)
    while abs(receive.getActualQ()[5] - jump[5]) > 1e-6:
        fastest = max(fastest, abs(receive.getActualQd()[5]))
    stopped = control.servoStop(10.0)
    return {
        "accepted": accepted,
        "lag_s": lags_s[len(lags_s) // 2],
        "fastest": fastest,
        "stopped": stopped,
        "move": control.moveJ(LEVEL, 3.0, 10.0),
        "stops": receive.isProtectiveStopped() or receive.isEmergencyStopped(),
    }


def protective_stop(host: str) -> dict[str, Any]:
    receive = RTDEReceiveInterface(host)
    control = RTDEControlInterface(host)
    found: dict[str, Any] = {"streamed": servo(control, plus(LEVEL, 0.5))}
    wait_for(lambda: max(receive.getActualQd()) > 0.1, "the arm to move")
    hook(host, "protective_stop")
    wait_for(receive.isProtectiveStopped, "the protective stop to be received")
    wait_for(lambda: not control.isProgramRunning(), "the script to be paused")
    found["servo"] = servo(control, LEVEL)
    found["move"] = control.moveJ(LEVEL, 3.0, 10.0)
    wait_for(lambda: max(abs(speed) for speed in receive.getActualQd()) == 0.0, "the arm to rest")
    dashboard = DashboardClient(host)
    dashboard.connect()
    hook(host, "clear")
    hook(host, "protective_stop")
    try:
        dashboard.unlockProtectiveStop()
        found["early"] = "unlocked"
    except RuntimeError as error:
        found["early"] = str(error)

    def unlocked() -> bool:
        try:
            dashboard.unlockProtectiveStop()
        except RuntimeError:
            return False
        return True

    wait_for(unlocked, "the stop to be unlocked")
    wait_for(lambda: not receive.isProtectiveStopped(), "the release to be received")
    control.reuploadScript()
    wait_for(control.isProgramRunning, "the script to run again")
    found["recovered"] = control.moveJ(LEVEL, 3.0, 10.0)
    found["triggered"] = control.triggerProtectiveStop()
    wait_for(receive.isProtectiveStopped, "the triggered stop to be received")
    return found


def bad_target(host: str, which: str) -> dict[str, Any]:
    receive = RTDEReceiveInterface(host)
    control = RTDEControlInterface(host)
    start = receive.getActualQ()
    targets = {"nan": [float("nan"), *start[1:]], "far": [7.0, *start[1:]], "short": start[:5]}
    servo(control, targets[which])
    wait_for(receive.isProtectiveStopped, "the protective stop")
    return {"move": control.moveJ(LEVEL, 3.0, 10.0), "moved": receive.getActualQ() != start}


def emergency_stop(host: str) -> dict[str, Any]:
    receive = RTDEReceiveInterface(host)
    control = RTDEControlInterface(host)
    hook(host, "emergency_stop")
    wait_for(receive.isEmergencyStopped, "the emergency stop to be received")
    wait_for(lambda: not control.isProgramRunning(), "the script to end")
    found: dict[str, Any] = {"move": control.moveJ(plus(LEVEL, 0.1), 3.0, 10.0), "mode": receive.getRobotMode()}
    hook(host, "clear")
    wait_for(lambda: not receive.isEmergencyStopped(), "the release to be received")
    control.reuploadScript()
    wait_for(control.isProgramRunning, "the script to run again")
    found["recovered"] = control.moveJ(LEVEL, 3.0, 10.0)
    return found


def second_control(host: str) -> dict[str, Any]:
    control = RTDEControlInterface(host)
    receives = [RTDEReceiveInterface(host, 125.0), RTDEReceiveInterface(host, 500.0, ["timestamp", "actual_q"])]
    found: dict[str, Any] = {}
    try:
        RTDEControlInterface(host)
        found["second"] = "connected"
    except RuntimeError as error:
        found["second"] = str(error)
    try:
        RTDEReceiveInterface(host, 500.0, ["actual_q", "nonsense"])
        found["unknown"] = "connected"
    except RuntimeError as error:
        found["unknown"] = str(error)
    found["move"] = control.moveJ(LEVEL, 3.0, 10.0)
    target = plus(LEVEL, 0.05)
    control.moveJ(target, 3.0, 10.0)
    for receive in receives:
        wait_for(is_at(receive, target), "the pose to be received")
    return found


def two_robots(first: str, second: str) -> dict[str, Any]:
    hosts = (first, second)
    receives = [RTDEReceiveInterface(host) for host in hosts]
    controls = [RTDEControlInterface(host) for host in hosts]
    targets = [plus(LEVEL, 0.1), plus(LEVEL, -0.1)]
    moves = [control.moveJ(target, 3.0, 10.0) for control, target in zip(controls, targets, strict=True)]
    for receive, target in zip(receives, targets, strict=True):
        wait_for(is_at(receive, target), "both poses")
    return {"moves": moves}


def watched(host: str, frequency_hz: str) -> dict[str, Any]:
    control = RTDEControlInterface(host)
    if float(frequency_hz) > 0.0:
        control.setWatchdog(float(frequency_hz))
    target = list(LEVEL)
    target[0] = 1.0
    return {"accepted": servo(control, target)}


def reconnecting(host: str) -> dict[str, Any]:
    receive = RTDEReceiveInterface(host)
    control = RTDEControlInterface(host)
    control.moveJ(plus(LEVEL, 0.1), 3.0, 10.0)
    print("moved", flush=True)
    wait_for(lambda: not receive.isConnected() and not control.isConnected(), "the loss to be noticed")
    print("lost", flush=True)
    if sys.stdin.readline() != "back\n":
        raise AssertionError("not told that the robot is back")

    def reconnected() -> bool:
        try:
            receive.disconnect()
            control.disconnect()
            return bool(receive.reconnect() and control.reconnect())
        except RuntimeError:
            return False

    wait_for(reconnected, "the robot to be reached again")
    return {"move": control.moveJ(plus(LEVEL, -0.1), 3.0, 10.0), "q0": receive.getActualQ()[0]}


def connecting(host: str) -> dict[str, Any]:
    receive = RTDEReceiveInterface(host)
    before = receive.getTimestamp()
    wait_for(lambda: receive.getTimestamp() > before + 0.05, "time to go on")
    control = RTDEControlInterface(host)
    return {"move": control.moveJ(LEVEL, 3.0, 10.0)}


def upper_registers(host: str) -> dict[str, Any]:
    flags = RTDEControlInterface.FLAG_UPLOAD_SCRIPT | RTDEControlInterface.FLAG_UPPER_RANGE_REGISTERS
    receive = RTDEReceiveInterface(host, 500.0, [], False, True)
    control = RTDEControlInterface(host, 500.0, flags)
    target = plus(LEVEL, 0.03)
    found: dict[str, Any] = {"move": control.moveJ(target, 3.0, 10.0), "streamed": servo(control, LEVEL)}
    wait_for(lambda: abs(receive.getActualQ()[0] - LEVEL[0]) < 1e-6, "the servo's target to be reached")
    return found


SCENARIOS: dict[str, Callable[..., dict[str, Any]]] = {
    function.__name__: function
    for function in (
        basics,
        streaming,
        protective_stop,
        bad_target,
        emergency_stop,
        second_control,
        two_robots,
        watched,
        reconnecting,
        connecting,
        upper_registers,
    )
}

if __name__ == "__main__":
    result = SCENARIOS[sys.argv[1]](*sys.argv[2:])
    print(json.dumps(result), flush=True)
    os._exit(0)
