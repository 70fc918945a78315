# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Objects that slide over the skin or bounce on it in fast events (events.py): small, round and smooth."""

from __future__ import annotations

from acts_sim.pressing.objects import ContactObject, object_named
from acts_sim.pressing.outlines import Field, disc, ellipsoid, prism

_GROUP = "event"


def _fingertip(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.014, 0.009, 0.007)


def _marble(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.008, 0.008, 0.008)


def _golf_ball(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.0213, 0.0213, 0.0213)


def _coin(x: Field, y: Field) -> Field:
    return prism(disc(x, y, 0.012))


GOLF_BALL = ContactObject("golf_ball", _GROUP, (0.0008, 0.0040), _golf_ball)
"""Objects that bounce."""

SLIDING = (
    ContactObject("fingertip", _GROUP, (0.0006, 0.0030), _fingertip),
    ContactObject("marble", _GROUP, (0.0008, 0.0040), _marble),
    GOLF_BALL,
    ContactObject("coin", _GROUP, (0.0003, 0.0015), _coin),
    object_named("circle"),
)
"""Objects that slide."""
