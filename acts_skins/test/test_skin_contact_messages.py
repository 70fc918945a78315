# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Contacts out of and into messages."""

from __future__ import annotations

import numpy as np
import pytest

from acts_core.transforms import Transform
from acts_msgs.msg import Contact, Contacts, TrackedContact
from acts_skins.contacts.messages import skin_contact, touches
from acts_skins.contacts.placing import Placement


def test_every_number_of_a_contact_arrives() -> None:
    contact = TrackedContact(number=5, age=1.5, force=2.5, peak=300.0, area=1e-4, active_taxels=6, spread=0.002)
    contact.force_sigma, contact.area_sigma, contact.spread_sigma = 0.25, 1e-5, 1e-3
    contact.position.x, contact.position.y = 0.01, -0.02
    contact.velocity.x, contact.position_sigma.x, contact.velocity_sigma.x = 0.1, 0.001, 0.2
    (touch,) = touches(Contacts(contacts=[contact]))
    merged = skin_contact("left", "arm", Placement(Transform()).place(touch))
    for name in (
        "number",
        "age",
        "peak",
        "area",
        "active_taxels",
        "spread",
        "force_sigma",
        "area_sigma",
        "spread_sigma",
    ):
        assert getattr(merged, name) == getattr(contact, name), name
    for name in ("position", "velocity", "position_sigma", "velocity_sigma"):
        given_vector, vector = getattr(contact, name), getattr(merged, name)
        np.testing.assert_allclose([vector.x, vector.y, vector.z], [given_vector.x, given_vector.y, given_vector.z])
    assert (merged.skin, merged.link, merged.force.z, merged.normal.z) == ("left", "arm", -2.5, 1.0)


def test_where_nothing_presses_there_is_no_contact() -> None:
    assert touches(Contact(in_contact=False)) == []
    assert touches(Contacts()) == []
    (touch,) = touches(Contact(in_contact=True, force=3.0))
    assert touch.number == 0
    assert touch.force_n == pytest.approx(3.0)
