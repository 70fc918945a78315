# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Hand, object and tip as a MuJoCo model. Its world frame is the palm's: gravity turns instead of the hand."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from xml.etree import ElementTree

import mujoco
import numpy as np
from numpy.typing import NDArray

from acts_sim.dynamixel import JOINT_DAMPING_NM_S, JOINT_FRICTION_NM, JOINT_INERTIA_KG_M2
from acts_sim.hand.kinematics import FINGERS, LINKS, PALM, PALM_MASS_KG, SOLIDS, Solid, frames
from acts_sim.hand.objects import HeldObject, Piece
from acts_sim.hand.solid_kernels import BOX, CAPSULE, CYLINDER

OBJECT = "object"
TIP = "tip"

PARKED_M = (0.0, 0.0, 2.0)
"""Position of an unused tip, out of reach, in the palm's frame [m]."""

# Pairs of kinds of solids that collide.
_KINDS = ("object", "palm", "root", "finger", "thumb")
_COLLIDING = {
    *(("object", kind) for kind in _KINDS[1:]),
    ("finger", "palm"),
    ("finger", "finger"),
    ("finger", "root"),
    ("thumb", "finger"),
    ("thumb", "root"),
}

_COLOURS = {
    "palm": "0.55 0.57 0.60 1",
    "finger": "0.62 0.64 0.67 1",
    "thumb": "0.62 0.64 0.67 1",
    "root": "0.50 0.52 0.55 1",
    "object": "0.90 0.62 0.25 0.55",
}


def build(thing: HeldObject | None, timestep_s: float) -> mujoco.MjModel:
    """Build the model.

    Parameters
    ----------
    thing : HeldObject or None
        Object in the hand, a free body ``object``.
    timestep_s : float

    Returns
    -------
    mujoco.MjModel
        Bodies and joints are named as links and joints of `kinematics.LINKS`; the tip is the mocap body ``tip``.
    """
    # Otherwise MuJoCo writes warnings to a file in the working directory; the world checks their counters instead.
    mujoco.set_mju_user_warning(lambda _warning: None)
    return mujoco.MjModel.from_xml_string(ElementTree.tostring(_document(thing, timestep_s), encoding="unicode"))


def body_index(model: mujoco.MjModel, name: str) -> int:
    """Index of a body of the model; -1 where there is none of this name."""
    return int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name))


def joint_index(model: mujoco.MjModel, name: str) -> int:
    """Index of a joint of the model; -1 where there is none of this name."""
    return int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name))


def _document(thing: HeldObject | None, timestep_s: float) -> ElementTree.Element:
    root = ElementTree.Element("mujoco", model="leap_right")
    ElementTree.SubElement(root, "compiler", angle="radian", autolimits="true", inertiafromgeom="true")
    option = ElementTree.SubElement(
        root, "option", timestep=str(timestep_s), integrator="implicitfast", cone="pyramidal", iterations="20"
    )
    # No silent reset when the simulation becomes unstable: the world raises an error.
    ElementTree.SubElement(option, "flag", autoreset="disable")
    visual = ElementTree.SubElement(root, "visual")
    ElementTree.SubElement(visual, "global", offwidth="1280", offheight="960")
    ElementTree.SubElement(visual, "headlight", ambient="0.45 0.45 0.45", diffuse="0.6 0.6 0.6", specular="0.1 0.1 0.1")
    assets = ElementTree.SubElement(root, "asset")
    ElementTree.SubElement(
        assets, "texture", type="skybox", builtin="flat", rgb1="0.97 0.97 0.97", width="8", height="8"
    )
    world = ElementTree.SubElement(root, "worldbody")
    at_rest = frames()
    bodies = {PALM: ElementTree.SubElement(world, "body", name=PALM)}
    masses = {PALM: PALM_MASS_KG, **{link.name: link.mass_kg for link in LINKS}}
    for link in LINKS:
        body = ElementTree.SubElement(
            bodies[link.parent], "body", name=link.name, pos=_text(link.offset_m), quat=_text(link.quaternion)
        )
        bodies[link.name] = body
        ElementTree.SubElement(
            body,
            "joint",
            name=link.joint,
            axis="0 0 -1",
            range=_text(link.limits_rad),
            armature=str(JOINT_INERTIA_KG_M2),
            damping=str(JOINT_DAMPING_NM_S),
            frictionloss=str(JOINT_FRICTION_NM),
        )
    for solid in SOLIDS:
        of_link = sum(other.link == solid.link for other in SOLIDS)
        _add_solid(bodies[solid.link], solid, at_rest[solid.link], masses[solid.link] / of_link)
    if thing is not None:
        _add_object(world, thing)
    contacts = ElementTree.SubElement(root, "contact")
    for digit in (*FINGERS, "thumb"):
        # The links of a finger overlap at its joints.
        for one, other in combinations([link.name for link in LINKS if link.name.startswith(digit)], 2):
            ElementTree.SubElement(contacts, "exclude", body1=one, body2=other)
    tip = ElementTree.SubElement(world, "body", name=TIP, mocap="true", pos=_text(PARKED_M))
    contype, conaffinity = _collision_of("object")
    ElementTree.SubElement(
        tip,
        "geom",
        name=TIP,
        type="capsule",
        size="0.0005 0.0195",
        pos="0 0 -0.02",
        contype=contype,
        conaffinity=conaffinity,
        rgba="0.8 0.1 0.1 1",
    )
    return root


def _kind_of(link: str) -> str:
    if link == PALM:
        return "palm"
    if link.endswith(("_base", "_proximal")):
        return "root"
    return "finger" if link.startswith(FINGERS) else "thumb"


def _collision_of(kind: str) -> tuple[str, str]:
    """MuJoCo's contype and conaffinity: a solid's own bit, and the bits of those that it collides with."""
    takes = {one for pair in _COLLIDING if kind in pair for one in (pair if pair[0] == pair[1] else set(pair) - {kind})}
    return str(1 << _KINDS.index(kind)), str(sum(1 << _KINDS.index(one) for one in takes))


def _add_solid(
    body: ElementTree.Element,
    solid: Solid,
    frame: tuple[NDArray[np.float64], NDArray[np.float64]],
    mass_kg: float,
) -> None:
    origin_m, rotation = frame
    start, end = ((np.array(point) - origin_m) @ rotation for point in (solid.start_m, solid.end_m))
    contype, conaffinity = _collision_of(_kind_of(solid.link))
    common = {
        "mass": str(mass_kg),
        "contype": contype,
        "conaffinity": conaffinity,
        "friction": "0.3",
        "rgba": _COLOURS[_kind_of(solid.link)],
    }
    if solid.radius_m:
        ElementTree.SubElement(
            body, "geom", type="capsule", fromto=_text((*start, *end)), size=str(solid.radius_m), attrib=common
        )
    else:
        ElementTree.SubElement(
            body, "geom", type="box", pos=_text((start + end) / 2), size=_text(np.abs(end - start) / 2), attrib=common
        )


def _add_object(world: ElementTree.Element, thing: HeldObject) -> None:
    body = ElementTree.SubElement(world, "body", name=OBJECT)
    ElementTree.SubElement(body, "freejoint", name=OBJECT)
    contype, conaffinity = _collision_of("object")
    for piece in thing.pieces:
        kind, size = _shape_of(piece)
        ElementTree.SubElement(
            body,
            "geom",
            type=kind,
            size=_text(size),
            pos=_text(piece.offset_m),
            quat=_text(piece.quaternion),
            mass=str(thing.mass_kg / len(thing.pieces)),
            contype=contype,
            conaffinity=conaffinity,
            friction="0.3",
            rgba=_COLOURS["object"],
        )


def _shape_of(piece: Piece) -> tuple[str, Sequence[float]]:
    if piece.kind == BOX:
        return "box", piece.size_m[:3]
    if piece.kind == CYLINDER:
        return "cylinder", piece.size_m[:2]
    if piece.kind == CAPSULE:
        return "capsule", piece.size_m
    return "sphere", piece.size_m


def _text(numbers: Sequence[float] | NDArray[np.float64]) -> str:
    return " ".join(f"{number:.9g}" for number in numbers)
