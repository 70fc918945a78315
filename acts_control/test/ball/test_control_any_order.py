# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Whatever comes in whatever order, the controller keeps the limits of the tilt, and motion has an end."""

from __future__ import annotations

from dataclasses import replace
from math import hypot, inf, isfinite, nan

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

from acts_control.ball import Ball, BallReport, Phase, Reference, ReferenceReport
from acts_control.ball.controller import BallController, ControlInput, ControllerConfig
from acts_control.robots.base import TiltGate

BEGIN_NS = 1_700_000_000_000_000_000
# Longest step of the control loop: four periods at the slowest rate [s].
LONGEST_S = 0.032

ODD = st.sampled_from([nan, inf, -inf, 1e9])
PLACES_M = st.floats(-0.06, 0.06) | ODD
SPEEDS_M_S = st.floats(-1.0, 1.0) | ODD


class Controlled(RuleBasedStateMachine):
    """A controller and the gate behind it; rules change what they are given, `steps` lets time pass."""

    @initialize(
        acceleration_rad_s2=st.floats(5.0, 40.0),
        touch_stop_after_s=st.floats(0.005, 0.5),
        settle_s=st.floats(0.0, 0.3),
        is_balancing=st.booleans(),
    )
    def begin(self, acceleration_rad_s2: float, touch_stop_after_s: float, settle_s: float, is_balancing: bool) -> None:
        self.config = ControllerConfig(
            max_tilt_acceleration_rad_s2=acceleration_rad_s2, touch_stop_after_s=touch_stop_after_s, settle_s=settle_s
        )
        self.controller = BallController(self.config)
        self.gate = TiltGate(self.config)
        self.now_ns = BEGIN_NS
        self.ball: BallReport | None = None
        self.reference: ReferenceReport | None = None
        self.tilt = self.rate = (0.0, 0.0)
        # Of all limits so far.
        self.farthest_rad, self.fastest_rad_s = self.config.max_tilt_rad, self.config.max_tilt_rate_rad_s
        self.was_lowered = False
        self.ended = ""
        # Rules hardly come in the order that it takes.
        if is_balancing:
            self.balance(0.02, -0.01)

    @rule(x=PLACES_M, y=PLACES_M, vx=SPEEDS_M_S, vy=SPEEDS_M_S, valid=st.booleans(), age_s=st.floats(-0.1, 0.4))
    def feel(self, x: float, y: float, vx: float, vy: float, valid: bool, age_s: float) -> None:
        self.ball = BallReport(self.now_ns - round(age_s * 1e9), valid, Ball(x, y, vx, vy))

    @rule(x=st.floats(-0.05, 0.05), y=st.floats(-0.05, 0.05))
    def feel_a_ball(self, x: float, y: float) -> None:
        self.ball = BallReport(self.now_ns, True, Ball(x, y, 0.0, 0.0))

    @rule(x=st.floats(-0.05, 0.05), y=st.floats(-0.05, 0.05))
    def balance(self, x: float, y: float) -> None:
        """All that motion needs, for as long as it takes to begin."""
        self.feel_a_ball(x, y)
        self.refer_to_the_centre()
        self.steps(60, 0.008, True, 0.0)

    @rule(many=st.integers(1, 60))
    def feel_no_ball(self, many: int) -> None:
        self.ball = BallReport(self.now_ns, False, Ball(0.0, 0.0, 0.0, 0.0))
        self.steps(many, 0.008, True, 0.0)

    @rule(x=PLACES_M, vx=SPEEDS_M_S, age_s=st.floats(-0.1, 0.4))
    def refer(self, x: float, vx: float, age_s: float) -> None:
        self.reference = ReferenceReport(self.now_ns - round(age_s * 1e9), Reference(x, 0.0, vx))

    @rule()
    def refer_to_the_centre(self) -> None:
        self.reference = ReferenceReport(self.now_ns, Reference(0.0, 0.0))

    @rule(tilt_rad=st.floats(0.001, 0.35), rate_rad_s=st.floats(0.01, 3.0), kp=st.floats(0.0, 200.0))
    def change(self, tilt_rad: float, rate_rad_s: float, kp: float) -> None:
        self.was_lowered |= tilt_rad < self.config.max_tilt_rad or rate_rad_s < self.config.max_tilt_rate_rad_s
        self.config = replace(self.config, max_tilt_rad=tilt_rad, max_tilt_rate_rad_s=rate_rad_s, kp=kp)
        self.controller.change(self.config)
        self.gate.limits = self.config
        self.farthest_rad = max(self.farthest_rad, tilt_rad)
        self.fastest_rad_s = max(self.fastest_rad_s, rate_rad_s)

    @rule(reason=st.sampled_from(["by request", "shutting down"]))
    def end(self, reason: str) -> None:
        if not self.controller.state.ending:
            self.ended = reason
        self.controller.end(reason)

    @rule(by_s=st.floats(-3600.0, 3600.0))
    def set_the_clock(self, by_s: float) -> None:
        self.now_ns += round(by_s * 1e9)

    @rule(
        many=st.integers(1, 60),
        dt_s=st.sampled_from([0.002, 0.004, 0.008, LONGEST_S]),
        touch_goes_on=st.booleans(),
        measured=st.floats(-0.1, 0.1),
    )
    def steps(self, many: int, dt_s: float, touch_goes_on: bool, measured: float) -> None:
        for _ in range(many):
            self.now_ns += round(dt_s * 1e9)
            if touch_goes_on and self.ball is not None:
                self.ball = self.ball._replace(stamp_ns=self.now_ns)
            tilt = self.controller.step(
                ControlInput(self.now_ns, self.ball, self.reference, (measured, -measured)), dt_s
            )
            self._look_at(tilt, dt_s)

    def _look_at(self, tilt: tuple[float, float], dt_s: float) -> None:
        assert all(map(isfinite, tilt))
        assert hypot(*tilt) <= self.farthest_rad * (1 + 1e-9)
        rate = ((tilt[0] - self.tilt[0]) / dt_s, (tilt[1] - self.tilt[1]) / dt_s)
        assert max(map(abs, rate)) <= self.fastest_rad_s * (1 + 1e-6)
        change = max(abs(rate[0] - self.rate[0]), abs(rate[1] - self.rate[1]))
        assert change <= self.config.max_tilt_acceleration_rad_s2 * dt_s * (1 + 1e-6)
        # Of limits that were lowered in motion see `TiltGate`.
        fault = self.gate.fault(tilt, dt_s)
        assert not fault or self.was_lowered, fault
        self.gate.sent(tilt)
        self.tilt, self.rate = tilt, rate

    @invariant()
    def is_known(self) -> None:
        state = self.controller.state
        assert state.phase in (Phase.WAITING, Phase.BALANCING, Phase.STOPPED)
        assert state.reason
        assert all(map(isfinite, state.error_m))
        if self.ended:
            assert state.reason == self.ended
        if state.phase is Phase.STOPPED:
            assert state.ending
            assert max(map(abs, (*self.tilt, *self.rate))) < 1e-3

    def teardown(self) -> None:
        """Whatever was before, motion that is to end does, level and at rest."""
        self.controller.end("the test is over")
        left_s = 20.0 + self.config.settle_s + 4.0 * self.farthest_rad / self.config.max_tilt_rate_rad_s
        while self.controller.state.phase is not Phase.STOPPED:
            assert left_s > 0.0, self.controller.state
            self.steps(1, 0.008, True, 0.0)
            left_s -= 0.008
        assert hypot(*self.tilt) < 1e-5


TestControlled = Controlled.TestCase
TestControlled.settings = settings(max_examples=100, stateful_step_count=20)
