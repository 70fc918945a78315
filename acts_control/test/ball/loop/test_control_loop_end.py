# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The control loop's thread on an arm in this process: how motion, the program on the robot and the connection end."""

import threading
import time
from collections.abc import Callable

import pytest
from arm_in_process import DEADLINE_S, ArmInProcess
from control_loop_rig import ORDERLY_END, Make, await_stop, balance
from waiting import wait_for

from acts_control.ball import Phase
from acts_control.ball.controller import BallController
from acts_control.ball.loop import ControlLoop
from acts_core.errors import RobotError

pytestmark = pytest.mark.slow


def test_a_mistake_in_the_program_still_ends_the_robots_program(
    arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    loop = make()
    balance(loop)
    monkeypatch.setattr("threading.excepthook", lambda arguments: None)
    monkeypatch.setattr(BallController, "step", lambda self, inputs, dt: 1 / 0)
    assert await_stop(loop) == "the control loop failed"
    wait_for(lambda: arm.calls[-2:] == ["release", "disconnect"], "the end of the robot's program")
    assert not loop.start()


def test_a_robot_that_does_not_end_its_motion_is_cut_off(
    arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("acts_control.ball.loop._ENDING_TIMEOUT_S", 0.1)
    loop = make()
    balance(loop)
    # On a busy machine the time for it may be over before this thread goes on.
    is_seen, end_tilting = threading.Event(), arm.end_tilting

    def held() -> None:
        end_tilting()
        is_seen.wait(DEADLINE_S)

    monkeypatch.setattr(arm, "end_tilting", held)
    arm.is_busy = True
    loop.stop("stopped by request")
    assert loop.is_stopping
    is_seen.set()
    assert await_stop(loop) == "the robot has not ended its motion within 0.1 s"
    assert not loop.is_stopping
    loop.close()
    assert arm.calls[-2:] == ["end_tilting", "disconnect"]


def stop_in_order(
    arm: ArmInProcess,
    loop: ControlLoop,
    monkeypatch: pytest.MonkeyPatch,
    still_s: list[float],
    stand_still: Callable[[], None],
) -> None:
    """Balance, and stop an arm that ends its motion while this process stands still, for ``still_s[0]`` in all."""
    pause, end_tilting = loop._sleep, arm.end_tilting

    def end() -> None:
        end_tilting()
        arm.is_busy = True

    def pause_and_stand_still(seconds: float) -> None:
        stand_still()
        pause(seconds)

    monkeypatch.setattr(arm, "end_tilting", end)
    monkeypatch.setattr(loop, "_steady_s", lambda: time.monotonic() + still_s[0])
    monkeypatch.setattr(loop, "_sleep", pause_and_stand_still)
    assert loop.start()
    balance(loop)
    loop.stop("stopped by request")
    assert await_stop(loop) == "stopped by request"
    wait_for(lambda: arm.calls[-3:] == ORDERLY_END, "the end of the connection")


def test_a_machine_that_stands_still_while_motion_ends_is_no_lost_robot(
    arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    loop, still_s = make(autostart=False), [0.0]

    def stand_still() -> None:
        if arm.is_busy and not still_s[0]:
            # Neither this process nor that which hands on what the robot says goes on meanwhile.
            still_s[0], arm.frozen = 0.5, True
        elif arm.frozen:
            arm.frozen = arm.is_busy = False

    stop_in_order(arm, loop, monkeypatch, still_s, stand_still)


def test_a_process_that_stands_still_while_motion_ends_does_not_take_it_for_one_that_does_not_end(
    arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    loop, still_s = make(autostart=False), [0.0]

    def stand_still() -> None:
        if arm.is_busy:
            # Meanwhile the robot has ended its motion.
            still_s[0], arm.is_busy = 5.0, False

    stop_in_order(arm, loop, monkeypatch, still_s, stand_still)
    assert still_s == [5.0]


def test_a_program_that_cannot_be_ended_is_told(arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    loop = make()
    balance(loop)

    def fail() -> None:
        raise RobotError("gone")

    monkeypatch.setattr(arm, "release", fail)
    loop.stop("stopped by request")
    assert await_stop(loop) == "stopped by request; the robot's program may still run: gone"


def test_a_robot_that_fails_in_a_way_of_its_own_is_cut_off_and_that_is_told(
    arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    loop = make()
    balance(loop)
    monkeypatch.setattr("threading.excepthook", lambda arguments: None)
    monkeypatch.setattr(arm, "release", lambda: 1 / 0)
    loop.stop("stopped by request")
    assert await_stop(loop) == "stopped by request; the robot's program may still run"
    wait_for(lambda: arm.calls[-1] == "disconnect", "the end of the connection")
    loop.close()
    assert not loop.start()


def test_the_end_is_told_before_the_connection_is_cut(
    arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    loop = make()
    balance(loop)
    cut = threading.Event()
    monkeypatch.setattr(arm, "disconnect", lambda: cut.wait(DEADLINE_S))
    arm.frozen = True
    assert await_stop(loop).startswith("no data from the robot for")
    assert not loop.stop("again")
    # Asked for meanwhile, and begun when the old connection is gone.
    assert loop.start()
    assert not loop.start()
    # Not that it has stopped, which is over, and whoever asks why it cannot be started is not told that it has ended.
    assert (loop.status.phase, loop.status.reason) == (Phase.CONNECTING, "connecting")
    assert arm.calls.count("connect") == 1
    arm.frozen = False
    cut.set()
    wait_for(lambda: arm.calls.count("connect") == 2, "a new connection")


def test_closing_stops_the_robot_in_order(arm: ArmInProcess, make: Make) -> None:
    loop = make()
    balance(loop)
    loop.close()
    assert (loop.status.phase, loop.status.reason) == (Phase.STOPPED, "shutting down")
    assert arm.calls[-3:] == ORDERLY_END
    assert arm.commands[-1] == pytest.approx((0.0, 0.0), abs=1e-5)


def test_closing_ends_also_where_levelling_would_take_longer(
    arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("acts_control.ball.loop._ENDING_TIMEOUT_S", 0.1)
    loop = make(settle_s=5.0, max_tilt_rate_rad_s=0.01, max_tilt_rad=0.05)
    balance(loop)
    begin_s = time.monotonic()
    loop.close(DEADLINE_S)
    assert time.monotonic() - begin_s < 3.0
    assert loop.status.phase is Phase.STOPPED
    assert loop.status.reason == "shutting down; levelling was broken off after 0.1 s"
    assert arm.calls[-3:] == ORDERLY_END
