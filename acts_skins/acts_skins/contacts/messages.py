# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Conversion of messages: contacts of one skin in, contacts of all skins out."""

from __future__ import annotations

from geometry_msgs.msg import Point, Vector3

from acts_core.transforms import Vector
from acts_msgs.msg import Contact, Contacts, SkinContact, TrackedContact
from acts_skins.contacts.placing import PlacedTouch, Touch

CONTACT_TYPES = {"contacts": Contacts, "contact": Contact}
"""Topics of a skin that can be merged: tracked contacts with numbers, or all pressure as one contact."""


def touches(message: Contacts | Contact) -> list[Touch]:
    """The contacts of a skin's message, including those with NaN or infinite values."""
    if isinstance(message, Contacts):
        return [_tracked(contact) for contact in message.contacts]
    return [_whole(message)] if message.in_contact else []


def _tracked(contact: TrackedContact) -> Touch:
    return Touch(
        number=contact.number,
        age_s=contact.age,
        position_m=_vector(contact.position),
        velocity_m_s=_vector(contact.velocity),
        force_n=contact.force,
        peak_counts=contact.peak,
        area_m2=contact.area,
        active_taxels=contact.active_taxels,
        spread_m=contact.spread,
        position_sd_m=_vector(contact.position_sigma),
        velocity_sd_m_s=_vector(contact.velocity_sigma),
        force_sd_n=contact.force_sigma,
        area_sd_m2=contact.area_sigma,
        spread_sd_m=contact.spread_sigma,
    )


def _whole(contact: Contact) -> Touch:
    return Touch(
        number=0,
        age_s=0.0,
        position_m=_vector(contact.centre_of_pressure),
        velocity_m_s=(0.0, 0.0, 0.0),
        force_n=contact.force,
        peak_counts=contact.peak,
        area_m2=contact.area,
        active_taxels=contact.active_taxels,
        spread_m=contact.spread,
        position_sd_m=_vector(contact.centre_of_pressure_sigma),
        velocity_sd_m_s=(0.0, 0.0, 0.0),
        force_sd_n=contact.force_sigma,
        area_sd_m2=contact.area_sigma,
        spread_sd_m=contact.spread_sigma,
    )


def skin_contact(skin: str, link: str, placed: PlacedTouch) -> SkinContact:
    """A contact of a skin in the robot's frame, as a message."""
    touch = placed.touch
    x, y, z = placed.position_m
    return SkinContact(
        skin=skin,
        link=link,
        number=touch.number,
        age=touch.age_s,
        position=Point(x=x, y=y, z=z),
        velocity=_message(placed.velocity_m_s),
        normal=_message(placed.normal),
        force=_message(placed.force_n),
        peak=touch.peak_counts,
        area=touch.area_m2,
        active_taxels=touch.active_taxels,
        spread=touch.spread_m,
        position_sigma=_message(placed.position_sd_m),
        velocity_sigma=_message(placed.velocity_sd_m_s),
        force_sigma=touch.force_sd_n,
        area_sigma=touch.area_sd_m2,
        spread_sigma=touch.spread_sd_m,
    )


def _vector(values: Point | Vector3) -> Vector:
    return values.x, values.y, values.z


def _message(values: Vector) -> Vector3:
    x, y, z = values
    return Vector3(x=x, y=y, z=z)
