# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Objects pressed into the skin: foam, force response, noise, and fast events.

In come objects and motions; out come full frames of counts.
"""

from acts_sim.pressing.contact_model import ContactModel, FoamConfig, Press, skin_of
from acts_sim.pressing.events import EVENT_RATE_HZ, EVENTS, event_recordings
from acts_sim.pressing.objects import OBJECTS, ContactObject, object_named
from acts_sim.pressing.outlines import Field, bar, disc, ellipsoid, prism
from acts_sim.pressing.presses import PRESS_RATE_HZ, press_over_time
from acts_sim.pressing.pressing_arm import RATE_HZ, PressingArm, PressingConfig

__all__ = [
    "EVENTS",
    "EVENT_RATE_HZ",
    "OBJECTS",
    "PRESS_RATE_HZ",
    "RATE_HZ",
    "ContactModel",
    "ContactObject",
    "Field",
    "FoamConfig",
    "Press",
    "PressingArm",
    "PressingConfig",
    "bar",
    "disc",
    "ellipsoid",
    "event_recordings",
    "object_named",
    "press_over_time",
    "prism",
    "skin_of",
]
