# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""References, where the ball should be, and how those that arrive are followed."""

from __future__ import annotations

from math import hypot, isfinite, sin
from typing import NamedTuple

from acts_control.ball.plate import ROLLING_GRAVITY_M_S2

# No ball on a plate is meant to be faster [m/s], or to be accelerated more than by falling [m/s^2].
_FASTEST_M_S = 2.0
_HARDEST_M_S2 = 9.81

# Two references farther apart than this do not belong together.
_MAX_GAP_S = 0.1

# A reference is extrapolated to now, but not for longer than this.
_MAX_ADVANCE_S = 0.05

# One stamped farther in the future is of another clock: it would never grow old.
_FUTURE_S = 0.05

# Where so many in a row are ahead by the same, but for `_FUTURE_S`, that is how far their clock is ahead.
_CONFIRMED = 5


class Reference(NamedTuple):
    """Where the ball should be in the skin's frame: position, velocity, acceleration, jerk [m, m/s, m/s^2, m/s^3]."""

    x_m: float
    y_m: float
    vx_m_s: float = 0.0
    vy_m_s: float = 0.0
    ax_m_s2: float = 0.0
    ay_m_s2: float = 0.0
    jx_m_s3: float = 0.0
    jy_m_s3: float = 0.0

    def after(self, dt: float) -> Reference:
        """The reference a short time later [s]."""
        return Reference(
            self.x_m + dt * (self.vx_m_s + 0.5 * dt * self.ax_m_s2),
            self.y_m + dt * (self.vy_m_s + 0.5 * dt * self.ay_m_s2),
            self.vx_m_s + dt * self.ax_m_s2,
            self.vy_m_s + dt * self.ay_m_s2,
            self.ax_m_s2 + dt * self.jx_m_s3,
            self.ay_m_s2 + dt * self.jy_m_s3,
            self.jx_m_s3,
            self.jy_m_s3,
        )

    def at_rest(self) -> Reference:
        """The same place without motion."""
        return Reference(self.x_m, self.y_m)


class ReferenceReport(NamedTuple):
    """A reference as it arrived, without jerk, and the time it holds for [ns]."""

    stamp_ns: int
    reference: Reference


class ReferenceLimits(NamedTuple):
    """What a reference may be.

    Attributes
    ----------
    reach_m : float
        References farther from the centre than this in x or y are refused [m].
    stale_after_s : float
        Without a reference for longer the ball is held at the last one [s].
    max_tilt_rad, max_tilt_rate_rad_s : float
        What the plate can do: acceleration and jerk of a reference count no more than that [rad, rad/s].
    """

    reach_m: float
    stale_after_s: float
    max_tilt_rad: float
    max_tilt_rate_rad_s: float


class ReferenceFollower:
    """From the references that arrive to the one that holds now, with its jerk.

    An impossible reference is refused: the last good one is used, and the ball is held there when no better one
    comes. Where stamps are ahead by a constant time, the sender's clock is ahead, and they are corrected. Stamp and
    acceleration of a reference are used for the next one only where that follows within 0.1 s, so a wrong stamp or a
    clock that was set has no lasting effect.

    Attributes
    ----------
    limits : ReferenceLimits
        May be changed between two steps.
    problem : str
        Why the newest reference is not followed, in words without numbers; empty where it is.
    """

    def __init__(self, limits: ReferenceLimits) -> None:
        self.limits = limits
        self._newest: ReferenceReport | None = None
        self._good: ReferenceReport | None = None
        self._refused = ""
        self._ahead_ns = 0
        self._ahead_in_a_row = 0
        self.problem = ""

    def step(self, report: ReferenceReport | None, now_ns: int) -> Reference | None:
        """The reference for now; None before the first good one.

        Parameters
        ----------
        report : ReferenceReport or None
            The newest that has arrived, possibly the same as in the last step.
        now_ns : int
            The time, by the clock of the stamps [ns].
        """
        if report is None:
            return None
        if report is not self._newest:
            self._newest = report
            self._refused = self._why_refused(report.reference)
            if not self._refused:
                self._good = self._with_jerk(self._by_our_clock(report, now_ns))
        self.problem = self._refused
        if self._good is None:
            return None
        stamp_ns, reference = self._good
        age_s = (now_ns - stamp_ns) * 1e-9
        if -_FUTURE_S <= age_s <= self.limits.stale_after_s:
            if not self.problem and self._ahead_in_a_row:
                self.problem = "the reference is stamped in the future, the clocks differ: it counts as of when it came"
            return reference.after(min(max(age_s, 0.0), _MAX_ADVANCE_S))
        if not self.problem:
            why = "is stale" if age_s > 0.0 else "is stamped in the future, the clocks differ"
            self.problem = f"the reference {why}: its motion is left out"
        return reference.at_rest()

    def _by_our_clock(self, report: ReferenceReport, now_ns: int) -> ReferenceReport:
        """The report, with its stamp corrected where its clock has been ahead by the same for long enough."""
        ahead_ns = report.stamp_ns - now_ns
        if ahead_ns <= _FUTURE_S * 1e9:
            self._ahead_in_a_row = 0
            return report
        if self._ahead_in_a_row and abs(ahead_ns - self._ahead_ns) <= _FUTURE_S * 1e9:
            self._ahead_in_a_row += 1
        else:
            self._ahead_ns, self._ahead_in_a_row = ahead_ns, 1
        if self._ahead_in_a_row < _CONFIRMED:
            return report
        return report._replace(stamp_ns=report.stamp_ns - self._ahead_ns)

    def _why_refused(self, reference: Reference) -> str:
        x, y, vx, vy, ax, ay, _, _ = reference
        if not all(map(isfinite, reference)):
            return "the reference is refused: not finite"
        if max(abs(x), abs(y)) > self.limits.reach_m:
            return "the reference is refused: farther from the centre than reference_reach_m"
        if hypot(vx, vy) > _FASTEST_M_S:
            return f"the reference is refused: faster than {_FASTEST_M_S:g} m/s"
        if hypot(ax, ay) > _HARDEST_M_S2:
            return f"the reference is refused: accelerated by more than {_HARDEST_M_S2:g} m/s^2"
        return ""

    def _with_jerk(self, report: ReferenceReport) -> ReferenceReport:
        """The reference with its jerk, from how the acceleration changes, and no more of both than the plate can do."""
        stamp_ns, reference = report
        ax, ay = _shortened(reference.ax_m_s2, reference.ay_m_s2, ROLLING_GRAVITY_M_S2 * sin(self.limits.max_tilt_rad))
        jx = jy = 0.0
        if self._good is not None:
            dt = (stamp_ns - self._good.stamp_ns) * 1e-9
            if 0.0 < dt < _MAX_GAP_S:
                last, most = self._good.reference, ROLLING_GRAVITY_M_S2 * self.limits.max_tilt_rate_rad_s
                jx, jy = _shortened((ax - last.ax_m_s2) / dt, (ay - last.ay_m_s2) / dt, most)
        return ReferenceReport(stamp_ns, reference._replace(ax_m_s2=ax, ay_m_s2=ay, jx_m_s3=jx, jy_m_s3=jy))


def _shortened(x: float, y: float, longest: float) -> tuple[float, float]:
    share = longest / max(hypot(x, y), longest)
    return share * x, share * y
