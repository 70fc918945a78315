# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Objects pressed into the contact model over time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from acts_sim.pressing.contact_model import ContactModel
from acts_sim.pressing.objects import ContactObject

PRESS_RATE_HZ = 250.0
"""Frames per second of a press; its rise of 40 ms is its fastest change."""

_BEFORE_S = 0.020
_RISE_S = 0.040
_HOLD_S = 0.200
_SWAY = 0.05
_SWAY_HZ = 7.0


def press_over_time(model: ContactModel, item: ContactObject) -> NDArray[np.uint16]:
    """One random press: untouched, 40 ms down, 200 ms held with small movements, 40 ms up.

    Returns
    -------
    np.ndarray [shape=(n, rows, cols), dtype=uint16]
        Counts at `PRESS_RATE_HZ`, with the noise of the model.
    """
    press = model.random_press(item)
    t = np.arange(round((_BEFORE_S + 2 * _RISE_S + _HOLD_S) * PRESS_RATE_HZ) + 1) / PRESS_RATE_HZ - _BEFORE_S
    ramp = np.clip(np.minimum(t, 2 * _RISE_S + _HOLD_S - t) / _RISE_S, 0, 1)
    # Eased, because an arm neither starts nor stops at once.
    depth = (3 * ramp**2 - 2 * ramp**3) * (1 + _SWAY * np.sin(2 * np.pi * _SWAY_HZ * t)) * press.depth_m
    return np.stack([model.counts(model.forces_n(item, replace(press, depth_m=float(d)))) for d in depth])
