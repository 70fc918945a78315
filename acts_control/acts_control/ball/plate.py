# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A ball that rolls on a tilted plate: tilt to acceleration and back.

A solid ball that rolls without slipping accelerates along the plate with 5/7 of the gravity in the plate's plane. (The
paper's S16 writes g sin(theta), that of a body sliding without friction.)
"""

from __future__ import annotations

from math import asin, hypot, sin

from acts_core.settings import setting

GRAVITY_M_S2 = 9.81

ROLLING = 5 / 7
"""Share of the force along the plate that accelerates a solid ball; the rest spins it."""

ROLLING_GRAVITY_M_S2 = ROLLING * GRAVITY_M_S2
"""Acceleration of the ball per sine of tilt."""

LEVER_ARM_SETTING = setting(
    0.155,
    "distance L over which turning the plate carries it sideways under the ball: from the wrist axes to the flange "
    "(0.0996 on a UR5e), to the skin's surface, and 7/5 of the ball's radius; 0: the plate turns about the ball [m]",
    minimum=-0.5,
    maximum=0.5,
)
"""A setting of estimator and controller, which have to agree. The default is for a skin 20 mm over the flange and a
ball of 50 mm. (7/5: the plate's turning also spins the ball, 2/5 of its radius more than its centre's height.)"""

RESISTANCE_SETTING = setting(
    0.005,
    "coefficient of rolling resistance of the ball on the skin: force over weight",
    minimum=0.0,
    maximum=0.1,
)
"""A setting of estimator and controller. The default is assumed: steel on a rail has 0.001, a tyre on asphalt 0.01."""

RESISTANCE_SPEED_M_S = 0.005
"""Speed at which half of the rolling resistance counts: it turns round smoothly, not at once [m/s]."""


def resistance_per_speed(coefficient: float, speed_m_s: float) -> float:
    """Deceleration of a ball by rolling resistance, over its speed [1/s]."""
    return ROLLING_GRAVITY_M_S2 * coefficient / (speed_m_s + RESISTANCE_SPEED_M_S)


def acceleration_of(tilt_x_rad: float, tilt_y_rad: float) -> tuple[float, float]:
    """Acceleration of the ball in the skin's plane [m/s^2] on a plate tilted by this rotation vector [rad]."""
    angle = hypot(tilt_x_rad, tilt_y_rad)
    gain = ROLLING_GRAVITY_M_S2 * (sin(angle) / angle if angle > 0.0 else 1.0)
    return gain * tilt_y_rad, -gain * tilt_x_rad


def tilt_for(ax_m_s2: float, ay_m_s2: float, max_tilt_rad: float) -> tuple[float, float]:
    """Tilt that accelerates the ball like this, shortened to the largest allowed one; the inverse of `acceleration_of`.

    Parameters
    ----------
    ax_m_s2, ay_m_s2 : float
        Wanted acceleration in the skin's plane [m/s^2].
    max_tilt_rad : float
        Largest angle between plate and level [rad].

    Returns
    -------
    tilt_x_rad, tilt_y_rad : float
        Rotation vector about the skin's x and y axes [rad]; it keeps the direction of the wanted acceleration.
    """
    wanted = hypot(ax_m_s2, ay_m_s2)
    if wanted == 0.0:
        return 0.0, 0.0
    sine = min(wanted / ROLLING_GRAVITY_M_S2, sin(max_tilt_rad))
    angle = asin(sine)
    return -angle * ay_m_s2 / wanted, angle * ax_m_s2 / wanted
