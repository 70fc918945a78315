# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A control loop that balances a ball that never comes to rest, on a simulated robot that may stand still."""

from __future__ import annotations

import signal
import time
from contextlib import ExitStack

from control_rig import SimulatedRobot
from waiting import wait_for

from acts_control.ball import Ball, BallReport, ControlLoop, LoopConfig, Phase, Reference, ReferenceReport
from acts_control.robots import with_robots
from acts_control.robots.base import RobotReading
from acts_control.robots.ur import UrRobot

# Where this machine held up the loop's own steps for longer in all, what is told says nothing of the loop: after 2.5 s
# without data the library ends the connection by itself.
HELD_UP_S = 1.0
_STOOD_STILL = "the robot has ended its program: this process stood still"
# What the loop tells of a controller that was not scheduled, and what the simulated one tells of itself then.
_NO_DATA = "no data from the robot"
_NOT_SCHEDULED = "the process was not scheduled"


class Arm(UrRobot):
    """Remembers the robot's time when it was last read."""

    time_s = 0.0

    def read(self) -> RobotReading:
        reading = super().read()
        self.time_s = reading.time_s
        return reading

    @property
    def is_over(self) -> bool:
        """Whether the process of the last connection has ended, and no other has begun."""
        return self._link.is_process_gone


class Rig:
    """A simulated robot, and a control loop that balances a ball that never comes to rest."""

    def __init__(
        self,
        host: str,
        stack: ExitStack,
        stale_after_s: float = 0.8,
        simulated: SimulatedRobot | None = None,
        homing_speed_rad_s: float = 2.0,
    ) -> None:
        self.simulated = simulated or stack.enter_context(SimulatedRobot(host))
        config = with_robots(LoopConfig)(
            robot_ip=host,
            robot_stale_after_s=stale_after_s,
            touch_stale_after_s=1.0,
            connect_retry_s=0.1,
            homing_speed_rad_s=homing_speed_rad_s,
        )
        self.arm = Arm(config)
        # How long steps were late in all, of those since the last start or pause [s].
        self.held_up_s = 0.0
        self._stepped_s = time.monotonic()
        # How often the controller had told that it was not scheduled, at the last start.
        self._not_scheduled = 0
        self.loop = ControlLoop(config, self.arm, time.time_ns)
        self.loop.look = self._feel
        stack.callback(self.loop.close)
        self.loop.launch()

    def _feel(self, _phase: Phase) -> None:
        before_s, self._stepped_s = self._stepped_s, time.monotonic()
        # Steps are due every 8 ms, and the loop counts no step for longer than four of these.
        if self.loop.status.steps:
            self.held_up_s += max(self._stepped_s - before_s - 0.032, 0.0)
        now_ns = time.time_ns()
        self.loop.ball = BallReport(now_ns, True, Ball(0.02, 0.01, 0.0, 0.0))
        self.loop.reference = ReferenceReport(now_ns, Reference(0.0, 0.0))

    def await_phase(self, phase: Phase, timeout_s: float = 30.0) -> str:
        wait_for(lambda: self.loop.status.phase is phase, lambda: f"{phase.name}, {self.loop.status}", timeout_s)
        return self.loop.status.reason

    def balance(self) -> None:
        """Until the plate is tilted; from the start again where this machine stood still meanwhile."""

        def is_tilted() -> bool:
            status = self.loop.status
            if self._was_held_up():
                self.start_again()
            return status.phase is Phase.BALANCING and abs(status.tilt_measured_rad[1]) > 0.02

        wait_for(is_tilted, lambda: f"a tilt, {self.loop.status}", 60.0)

    def _was_held_up(self) -> bool:
        """Whether motion has ended because this machine held up this process, or that of the controller."""
        status = self.loop.status
        if status.phase is not Phase.STOPPED:
            return False
        if status.reason.startswith(_NO_DATA) and self._times_not_scheduled() > self._not_scheduled:
            return True
        return status.reason.startswith(_STOOD_STILL) or self.held_up_s > HELD_UP_S

    def _times_not_scheduled(self) -> int:
        return self.simulated.text().count(_NOT_SCHEDULED)

    def start_again(self) -> None:
        """Start anew, as after a stop."""
        self.held_up_s = 0.0
        self._not_scheduled = self._times_not_scheduled()
        assert self.loop.start()

    def pause(self) -> None:
        """Let the controller stand still."""
        self.simulated.process.send_signal(signal.SIGSTOP)

    def resume(self) -> None:
        """Let it go on."""
        self.simulated.process.send_signal(signal.SIGCONT)

    def orders_since(self, time_s: float) -> list[str]:
        """What clients have told the robot after a moment of the robot's time."""
        return [words for at_s, _port, words in self.simulated.orders() if at_s > time_s]

    def await_time(self, seconds: float) -> None:
        """Let robot time pass."""
        end_s = float(self.simulated.state()["time_s"]) + seconds
        wait_for(lambda: float(self.simulated.state()["time_s"]) > end_s, "the robot's time to pass")
