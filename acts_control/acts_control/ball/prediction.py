# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Prediction of the ball from the time of the last contact to now, by the tilts that the plate had meanwhile."""

from __future__ import annotations

from collections import deque

from acts_control.ball.pid import Ball
from acts_control.ball.plate import ROLLING, acceleration_of


class TiltHistory:
    """Tilts of the last moments, by which the ball's position and velocity are predicted.

    Parameters
    ----------
    lever_arm_m : float
        As in `acts_control.ball.estimator`, whose coordinate z is predicted [m].
    horizon_s : float
        How far back tilts are kept: estimates older than this are not predicted [s].
    """

    def __init__(self, lever_arm_m: float, horizon_s: float) -> None:
        self._lever = ROLLING * lever_arm_m
        self._horizon_ns = round(horizon_s * 1e9)
        # Time [ns], and the lean [rad] and acceleration [m/s^2] along x and y from then on.
        self._past: deque[tuple[int, float, float, float, float]] = deque()

    def add(self, now_ns: int, tilt_x_rad: float, tilt_y_rad: float) -> None:
        """Note the tilt that the plate has now.

        Parameters
        ----------
        now_ns : int
            The time, by the clock of the stamps [ns]. Where it was set back, the tilts before are forgotten.
        tilt_x_rad, tilt_y_rad : float
            Rotation vector about the skin's x and y axes [rad].
        """
        past = self._past
        if past and now_ns <= past[-1][0]:
            past.clear()
        past.append((now_ns, tilt_y_rad, -tilt_x_rad, *acceleration_of(tilt_x_rad, tilt_y_rad)))
        while past[0][0] < now_ns - self._horizon_ns:
            past.popleft()

    def predict(self, ball: Ball, stamp_ns: int) -> Ball:
        """Where the ball is at the time of the newest tilt.

        Parameters
        ----------
        ball : Ball
            The estimate.
        stamp_ns : int
            The time it holds for [ns].
        """
        x, y, vx, vy = ball
        past = self._past
        if not past:
            return ball
        first = len(past) - 1
        while first > 0 and past[first][0] > stamp_ns:
            first -= 1
        _, then_x, then_y, _, _ = past[first]
        x, y = x + self._lever * then_x, y + self._lever * then_y
        for k in range(first, len(past) - 1):
            start_ns, _, _, ax, ay = past[k]
            # Before the first known tilt, the plate is assumed to have had that tilt.
            dt = (past[k + 1][0] - (stamp_ns if k == first else start_ns)) * 1e-9
            x, y = x + dt * (vx + 0.5 * dt * ax), y + dt * (vy + 0.5 * dt * ay)
            vx, vy = vx + dt * ax, vy + dt * ay
        _, now_x, now_y, _, _ = past[-1]
        return Ball(x - self._lever * now_x, y - self._lever * now_y, vx, vy)
