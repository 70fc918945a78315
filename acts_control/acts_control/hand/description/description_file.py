# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Hands as YAML files: the shipped ones in `hands/`, or anybody's (docs/hand.md). An error names file and line."""

from __future__ import annotations

import math
from functools import lru_cache
from pathlib import Path

from acts_control.hand.description.description import ROLES, Finger, HandDescription, Joint, Link, Region
from acts_core.errors import SettingsError
from acts_core.files import Section, is_there, path_of, read_yaml
from acts_core.transforms import Vector

_SHIPPED = Path(__file__).parent / "hands"
_UNIT_TOLERANCE = 1e-3
# Farther is said by who takes degrees for radians, or millimetres for metres.
_FARTHEST_RAD, _FARTHEST_M = 4.0 * math.pi, 1.0
_KEYS = ("name", "base", "joints", "links", "fingers", "regions", "postures")


def hand_description(name_or_path: str) -> HandDescription:
    """A hand by the name of a shipped one, or the path of a file (what ends in .yaml).

    Raises
    ------
    SettingsError
        With file and line, where something is missing, unknown, or cannot be.
    """
    if name_or_path.endswith((".yaml", ".yml")):
        return _read(path_of(name_or_path, error=SettingsError))
    return _shipped(name_or_path)


@lru_cache
def _shipped(name: str) -> HandDescription:
    path = _SHIPPED / f"{name}.yaml"
    if not is_there(path, error=SettingsError):
        shipped = ", ".join(sorted(file.stem for file in _SHIPPED.glob("*.yaml")))
        raise SettingsError(f"hand {name!r}: allowed is one of {shipped}, or the path of a .yaml file")
    return _read(path)


def _read(path: Path) -> HandDescription:
    file = read_yaml(path)
    file.check_keys(_KEYS)
    name, base = _text(file, "name"), _text(file, "base")
    joints = tuple(_joint(one, key) for key, one in _entries(file, "joints", "joint"))
    if not joints:
        raise file.error("joints: at least one is needed", "joints")
    names = {joint.name for joint in joints}
    links: list[Link] = []
    # By the name of each link, the joints that move it.
    moved_by: dict[str, list[str]] = {base: []}
    for key, one in _entries(file, "links", "link"):
        links.append(_link(one, key, list(moved_by), names))
        moved_by[key] = [*moved_by[links[-1].parent], links[-1].joint]
    for key, one in _entries(file, "joints", "joint"):
        if not any(link.joint == key for link in links):
            raise one.error(f"it turns no link; describe the link, with joint: {key}, also if it carries no skin")
    fingers = {key: _finger(one, key, moved_by, names) for key, one in _entries(file, "fingers", "finger")}
    regions = {key: _region(one, key, set(moved_by), fingers) for key, one in _entries(file, "regions", "region")}
    postures = {key: _posture(one, joints) for key, one in _entries(file, "postures", "posture")}
    for needed in ("open", "pregrasp"):
        if needed not in postures:
            raise file.error(f"posture {needed} is missing", "postures")
    try:
        return HandDescription(name, joints, base, tuple(links), fingers, regions, postures)
    except SettingsError as error:
        raise file.error(str(error), "joints") from error


def _joint(one: Section, name: str) -> Joint:
    one.check_keys(("motor", "limits_rad", "zero_rad", "direction", "gain_scale", "step_scale"))
    if "limits_rad" not in one.values:
        raise one.error("limits_rad is missing")
    lower, upper = one.numbers("limits_rad", (0.0, 0.0))
    zero = one.number("zero_rad", math.pi)
    for key, angle in (("limits_rad", lower), ("limits_rad", upper), ("zero_rad", zero)):
        if abs(angle) > _FARTHEST_RAD:
            raise one.error(
                f"{key}: {angle:g} rad is more than two turns; allowed is {-_FARTHEST_RAD:.4g} to {_FARTHEST_RAD:.4g}, "
                "in radians, not in degrees",
                key,
            )
    scales = one.number("gain_scale", 1.0), one.number("step_scale", 1.0)
    motor, direction = one.whole("motor"), one.whole("direction", 1)
    try:
        return Joint(name, motor, lower, upper, zero, direction, *scales)
    except SettingsError as error:
        raise one.error(str(error).removeprefix(f"{one.what}: ")) from error


def _link(one: Section, name: str, parents: list[str], joints: set[str]) -> Link:
    one.check_keys(("parent", "joint", "position_m", "rpy_rad", "quaternion_xyzw", "axis"))
    if name == parents[0]:
        raise one.error("the base has this name, which nothing moves; give the link another")
    _place(one, "position_m")
    axis = _unit(one, "axis")
    try:
        parent = one.one_of("parent", parents)
    except SettingsError as error:
        raise SettingsError(f"{error}: the base, and the links that stand before this one") from error
    return Link(name, parent, one.one_of("joint", joints), one.transform(), axis)


def _finger(one: Section, name: str, moved_by: dict[str, list[str]], joints: set[str]) -> Finger:
    one.check_keys(("closes", "tip_link", "tip_m", "opposes"))
    closes = one.section("closes", f"finger {name}")
    if not closes.values:
        raise one.error("closes: at least one joint is needed", "closes")
    for joint in closes.values:
        if joint not in joints:
            raise closes.error(f"{joint!r} is no joint of this hand", joint)
    shares = {joint: closes.number(joint) for joint in closes.values}
    for joint, share in shares.items():
        if share <= 0.0:
            raise closes.error(f"{joint} = {share:g}: how much a joint takes part in closing is above 0", joint)
    tip_link = one.one_of("tip_link", moved_by)
    for joint in shares:
        if joint not in moved_by[tip_link]:
            movers = ", ".join(moved_by[tip_link]) or "no joint"
            raise closes.error(
                f"{joint} does not move {tip_link}, the finger's tip_link; that is moved by {movers}", joint
            )
    return Finger(name, shares, tip_link, _place(one, "tip_m"), bool(one.flag("opposes")))


def _region(one: Section, name: str, links: set[str], fingers: dict[str, Finger]) -> Region:
    one.check_keys(("link", "finger", "role", "centre_m", "normal"))
    finger = one.text("finger", "") or ""
    role = next(known for known in ROLES if known == one.one_of("role", ROLES))
    if bool(finger) == (role == "palm") or (finger and finger not in fingers):
        raise one.error(f"finger = {finger!r}: a palm has none, all else has one of {', '.join(fingers)}", "finger")
    if role == "palm":
        for needed in ("centre_m", "normal"):
            if needed not in one.values:
                raise one.error(f"{needed} is missing; a palm has it")
    normal = _unit(one, "normal") if "normal" in one.values else (0.0, 0.0, 0.0)
    centre_m = _place(one, "centre_m")
    return Region(name, one.one_of("link", links), finger, role, centre_m, normal)


def _posture(one: Section, joints: tuple[Joint, ...]) -> tuple[float, ...]:
    one.check_keys([joint.name for joint in joints])
    angles = []
    for joint in joints:
        angle = one.number(joint.name, joint.clipped(0.0))
        if angle != joint.clipped(angle):
            raise one.error(
                f"{joint.name} = {angle:g}: allowed is {joint.lower_rad:g} to {joint.upper_rad:g}", joint.name
            )
        angles.append(angle)
    return tuple(angles)


# --- single values


def _entries(file: Section, key: str, what: str) -> list[tuple[str, Section]]:
    all_of = file.section(key, key)
    for name in all_of.values:
        if not isinstance(name, str):
            raise all_of.error(f"{name!r}: names are text", name)
    return [(name, all_of.section(name, f"{what} {name}")) for name in all_of.values]


def _text(one: Section, key: str) -> str:
    text = one.text(key)
    if text is None:
        raise one.error(f"{key} is missing", key)
    return text


def _unit(one: Section, key: str) -> Vector:
    vector = _vector(one, key, (0.0, 0.0, 1.0))
    length = math.hypot(*vector)
    if abs(length - 1.0) > _UNIT_TOLERANCE:
        raise one.error(f"{key} = {list(vector)}: its length is {length:g}; needed is 1", key)
    return vector


def _place(one: Section, key: str) -> Vector:
    place = _vector(one, key, (0.0, 0.0, 0.0))
    if max(map(abs, place)) > _FARTHEST_M:
        raise one.error(
            f"{key} = {list(place)}: allowed is {-_FARTHEST_M:g} to {_FARTHEST_M:g}, in metres, not in millimetres", key
        )
    return place


def _vector(one: Section, key: str, default: Vector) -> Vector:
    x, y, z = one.numbers(key, default)
    return (x, y, z)


LEAP_RIGHT = hand_description("leap_right")
"""The right LEAP hand: joints and limits of its URDF, motors open at pi."""
