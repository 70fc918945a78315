# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The control loop's thread on an arm in this process: every way from connecting to a stop."""

import itertools
import math
import threading
import time
from collections.abc import Callable

import pytest
from arm_in_process import DEADLINE_S, ArmInProcess
from control_loop_rig import ORDERLY_END, Make, await_stop, balance, feel
from waiting import wait_for

from acts_control.ball import LoopConfig, Phase, Reference, ReferenceReport
from acts_control.ball.controller import BallController
from acts_control.loop_rate import steady_s
from acts_control.robots.base import CommandRefusedError, RobotStoppedError
from acts_core.errors import RobotError

pytestmark = pytest.mark.slow


def test_from_connecting_to_balancing_and_back_to_level(arm: ArmInProcess, make: Make) -> None:
    loop = make()
    wait_for(lambda: loop.status.phase is Phase.WAITING, "waiting")
    assert arm.calls == ["connect", "begin_levelling"]
    assert loop.status.reason == "waiting for touch"
    balance(loop)

    # A ball at +x is brought back by a tilt about -y. Touch that is late is carried on by the tilt, as if the ball
    # rolled: past the centre on a machine that stands still for long enough.
    def is_brought_back() -> bool:
        feel(loop)
        return loop.status.error_m == pytest.approx((0.02, 0.0), abs=1e-3) and arm.commands[-1][1] < 0.0

    wait_for(is_brought_back, lambda: f"the ball where it is felt, and a tilt against it, {loop.status}")
    assert loop.stop("stopped by request")
    assert await_stop(loop) == "stopped by request"
    wait_for(lambda: arm.calls[-3:] == ORDERLY_END, "the end of the connection")
    assert arm.commands[-1] == pytest.approx((0.0, 0.0), abs=1e-5)
    assert not loop.stop("again")
    assert loop.start()
    assert not loop.start()
    wait_for(lambda: arm.calls.count("begin_levelling") == 2, "a second start")


def test_limits_and_gains_change_while_balancing(arm: ArmInProcess, make: Make) -> None:
    loop = make()
    balance(loop)
    loop.change(LoopConfig(max_tilt_rad=0.01, max_tilt_rate_rad_s=0.2, touch_stale_after_s=1.0, touch_stop_after_s=5.0))
    changed_at = len(arm.commands)

    def limited() -> bool:
        feel(loop)
        return loop.status.tilt_commanded_rad[1] == pytest.approx(-0.01, abs=1e-5)

    wait_for(limited, lambda: f"the new limit, {loop.status}")
    assert loop.status.phase is Phase.BALANCING
    tilts = [y for _, y in arm.commands[changed_at - 1 :]]
    # 1 rad/s to begin with, in steps of four periods at most.
    assert max(abs(b - a) for a, b in itertools.pairwise(tilts)) < 0.04
    loop.change(LoopConfig(kp=0.0, kd=0.0, ki=0.0, touch_stale_after_s=1.0, touch_stop_after_s=5.0))

    def level() -> bool:
        feel(loop)
        return loop.status.tilt_commanded_rad == pytest.approx((0.0, 0.0), abs=1e-5)

    wait_for(level, lambda: f"a level plate, {loop.status}")


def test_why_the_ball_is_not_led_by_a_reference_is_in_the_status(arm: ArmInProcess, make: Make) -> None:
    loop = make()
    wait_for(lambda: loop.status.reference_problem == "no reference has come", lambda: f"none yet, {loop.status}")
    balance(loop)
    assert loop.status.reference_problem == ""

    def is_refused() -> bool:
        feel(loop)
        loop.reference = ReferenceReport(time.time_ns(), Reference(math.nan, 0.0))
        return loop.status.reference_problem == "the reference is refused: not finite"

    wait_for(is_refused, lambda: f"a refusal, {loop.status}")


def test_a_robot_that_is_not_there_yet_is_tried_again(
    arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    arm.connect_errors = [RobotError("no UR controller at 127.0.2.9"), RobotError("no UR controller at 127.0.2.9")]
    is_seen, connect = threading.Event(), arm.connect

    def connect_once_seen(is_wanted: Callable[[], bool]) -> None:
        if not arm.connect_errors:
            is_seen.wait(DEADLINE_S)
        connect(is_wanted)

    monkeypatch.setattr(arm, "connect", connect_once_seen)
    loop = make(connect_retry_s=0.2)
    wait_for(lambda: "127.0.2.9" in loop.status.reason, "the error in the status")
    assert loop.status.phase is Phase.CONNECTING
    is_seen.set()
    wait_for(lambda: loop.status.phase is Phase.WAITING, "waiting")
    assert arm.calls.count("connect") == 3


def test_connecting_can_be_given_up(arm: ArmInProcess, make: Make) -> None:
    arm.connect_errors = [RobotError("not there")] * 1000
    loop = make(connect_retry_s=60.0)
    wait_for(lambda: loop.status.reason == "not there", "the error in the status")
    loop.stop("stopped by request")
    assert await_stop(loop) == "stopped by request"


def test_an_arm_does_not_move_after_a_stop_that_comes_as_it_is_connected(
    arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    loop = make(autostart=False)
    connect = arm.connect

    def stopped_meanwhile(is_wanted: Callable[[], bool]) -> None:
        connect(is_wanted)
        assert loop.stop("stopped by request")

    monkeypatch.setattr(arm, "connect", stopped_meanwhile)
    assert loop.start()
    assert await_stop(loop) == "stopped by request"
    wait_for(lambda: arm.calls[-1] == "disconnect", "the end of the connection")
    assert arm.calls == ["connect", "release", "disconnect"]


@pytest.mark.parametrize("attempts", [1, 3])
def test_an_arm_does_not_move_by_a_start_from_before_the_program_stood_still(
    arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch, attempts: int
) -> None:
    loop = make(autostart=False)
    connect, is_late = arm.connect, False

    def stands_still_meanwhile(is_wanted: Callable[[], bool]) -> None:
        nonlocal is_late
        is_late = arm.calls.count("connect") + 1 == attempts
        connect(is_wanted)

    arm.connect_errors = [RobotError("not there")] * (attempts - 1)
    monkeypatch.setattr(arm, "connect", stands_still_meanwhile)
    told = "this program stood still for 3.0 s"
    loop.stood_still = lambda asked_s: told if is_late and asked_s < steady_s() else ""
    assert loop.start()
    assert await_stop(loop) == f"{told} while it connected; call start again"
    wait_for(lambda: arm.calls[-1] == "disconnect", "the end of the connection")
    assert arm.calls == ["connect"] * attempts + ["release", "disconnect"]


def test_a_robot_held_by_a_safety_function_is_not_waited_for(arm: ArmInProcess, make: Make) -> None:
    # It would begin to move at the moment a person releases it.
    arm.connect_errors = [RobotStoppedError("protective stop")]
    loop = make()
    assert await_stop(loop) == "protective stop"
    assert "begin_levelling" not in arm.calls


def test_without_autostart_nothing_moves_until_it_is_asked_for(arm: ArmInProcess, make: Make) -> None:
    loop = make(autostart=False)
    assert (loop.status.phase, loop.status.reason) == (Phase.STOPPED, "not started")
    assert arm.calls == []
    assert loop.start()
    wait_for(lambda: loop.status.phase is Phase.WAITING, "waiting")


def test_homing_can_be_broken_off(arm: ArmInProcess, make: Make) -> None:
    arm.moves = False
    loop = make()
    wait_for(lambda: "begin_levelling" in arm.calls, "homing")
    loop.stop("stopped by request")
    assert await_stop(loop) == "stopped by request"
    wait_for(lambda: arm.calls[-1] == "disconnect", "the end of the connection")
    assert arm.calls == ["connect", "begin_levelling", "end_levelling", "release", "disconnect"]


def test_a_process_that_stands_still_while_the_arm_moves_to_level_looks_at_it_again(
    arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    loop, sleeps = make(autostart=False), itertools.count(1)
    still_s = [0.0]
    pause = loop._sleep

    def pause_and_stand_still(seconds: float) -> None:
        if next(sleeps) == 2:
            still_s[0] = 2.0 * DEADLINE_S
        pause(seconds)

    monkeypatch.setattr(loop, "_steady_s", lambda: time.monotonic() + still_s[0])
    monkeypatch.setattr(loop, "_sleep", pause_and_stand_still)
    assert loop.start()
    wait_for(lambda: loop.status.phase in (Phase.WAITING, Phase.STOPPED), "the end of the way")
    assert (loop.status.phase, loop.status.reason) == (Phase.WAITING, "waiting for touch")


@pytest.mark.parametrize(
    ("fault", "value", "words"),
    [
        ("stopped", "robot: protective stop", "robot: protective stop"),
        ("stopped", "the robot's program is not running (stopped)", "the robot's program is not running (stopped)"),
        ("q", (float("nan"), 0.0), "the robot reports joint angles (nan, 0.0)"),
        ("q", (0.0, 0.0, 0.0), "the robot reports 3 joints"),
        ("connected", False, "connection to the robot lost"),
        ("frozen", True, "no data from the robot for"),
    ],
)
@pytest.mark.parametrize("when", ["homing", "balancing"])
def test_a_robot_that_stops_gets_no_further_command(
    arm: ArmInProcess, make: Make, fault: str, value: object, words: str, when: str
) -> None:
    arm.moves = when == "balancing"
    loop = make()
    if when == "balancing":
        balance(loop)
    else:
        wait_for(lambda: "begin_levelling" in arm.calls, "homing")
    setattr(arm, fault, value)
    assert await_stop(loop).startswith(words)
    sent = len(arm.commands)
    loop.close()
    # Neither the end of tilting nor a release: nothing is sent any more.
    assert arm.calls == ["connect", "begin_levelling", "disconnect"]
    assert len(arm.commands) == sent


@pytest.mark.parametrize(("stopped", "words"), [("", "tilt refused"), ("protective stop", "protective stop")])
def test_a_refused_command_ends_motion_with_the_reason_if_there_is_one(
    arm: ArmInProcess, make: Make, stopped: str, words: str
) -> None:
    loop = make()
    balance(loop)

    def refuse() -> None:
        # The command is refused before the stop is told.
        arm.stopped = stopped
        raise RobotError("tilt refused")

    arm.refuses = refuse
    assert await_stop(loop) == words
    loop.close()
    assert arm.calls == ["connect", "begin_levelling", "disconnect"]


def test_the_reason_for_a_refused_command_is_found_also_after_this_process_stood_still(
    arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    loop, still_s, is_refused = make(autostart=False), [0.0], threading.Event()

    def refuse() -> None:
        is_refused.set()
        raise RobotError("tilt refused")

    pause = loop._sleep

    def pause_and_stand_still(seconds: float) -> None:
        if is_refused.is_set():
            still_s[0], arm.stopped = 5.0, "protective stop"
        pause(seconds)

    monkeypatch.setattr(loop, "_steady_s", lambda: time.monotonic() + still_s[0])
    monkeypatch.setattr(loop, "_sleep", pause_and_stand_still)
    assert loop.start()
    balance(loop)
    arm.refuses = refuse
    assert await_stop(loop) == "protective stop"


def test_stale_touch_levels_the_plate_and_ends_the_servo(arm: ArmInProcess, make: Make) -> None:
    loop = make()
    balance(loop)
    loop.change(LoopConfig(touch_stale_after_s=0.1, touch_stop_after_s=0.3))
    reason = await_stop(loop)
    assert reason.startswith("touch is stale: the newest is")
    wait_for(lambda: arm.calls[-3:] == ORDERLY_END, "the end of the connection")
    assert arm.commands[-1] == pytest.approx((0.0, 0.0), abs=1e-5)


def test_a_command_that_is_not_finite_ends_motion_and_is_not_sent(
    arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    loop = make()
    balance(loop)
    monkeypatch.setattr(BallController, "step", lambda self, inputs, dt: (float("nan"), 0.0))
    assert "tilt = (nan, 0.0)" in await_stop(loop)
    wait_for(lambda: arm.calls[-3:] == ORDERLY_END, "the end of the connection")
    assert all(angle == angle for command in arm.commands for angle in command)


def test_a_single_bad_command_levels_the_plate(arm: ArmInProcess, make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    loop = make()
    balance(loop)
    step = BallController.step
    left = [1]

    def once_bad(self: BallController, inputs: object, dt: float) -> tuple[float, float]:
        tilt = step(self, inputs, dt)  # type: ignore[arg-type]
        if left:
            left.pop()
            return (0.3, 0.0)
        return tilt

    monkeypatch.setattr(BallController, "step", once_bad)
    assert "rad off the level pose" in await_stop(loop)
    assert arm.commands[-1] == pytest.approx((0.0, 0.0), abs=1e-5)
    assert max(abs(command[0]) for command in arm.commands) < 0.2


@pytest.mark.parametrize(("times", "last_words"), [(1, "joint 4 is too far"), (2, "joint 4 is still too far")])
def test_what_the_robots_own_check_refuses_levels_the_plate_or_ends_motion_at_once(
    arm: ArmInProcess, make: Make, times: int, last_words: str
) -> None:
    loop = make()
    balance(loop)
    words = ["joint 4 is too far", "joint 4 is still too far"][:times]

    def refuse() -> None:
        if words:
            raise CommandRefusedError(words.pop(0))

    arm.refuses = refuse
    assert await_stop(loop) == last_words
    wait_for(lambda: arm.calls[-3:] == ORDERLY_END, "the end of the connection")
    is_level = arm.commands[-1] == pytest.approx((0.0, 0.0), abs=1e-5)
    assert is_level is (times == 1)
