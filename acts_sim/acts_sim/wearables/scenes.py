# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What happens to worn skins in the paper's figure 8: six scenes by name.

To add one, write a function that returns contacts and register it; `acts evaluate wearables` then has it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from acts_core.registry import registering
from acts_core.skin import Layout, SkinPatch
from acts_sim.impacts import GRAVITY_M_S2, Ball, ball_named, collide, thrown
from acts_sim.wearables.bodies import FINGER, FINGERTIPS, FOREFOOT, HEEL, MIDFOOT, PALM, TOES, held, rolled, tapped
from acts_sim.wearables.contacts import Bouncing, Bullet, Caught, Contact, Pressing

# The skin's foam, and the flesh under it and in the hand above, in series: together 1 cm of 25 kPa.
_FLESH_N_PER_M3 = 2.5e6
# A heel carries half of a body on 30 cm^2: the skin's own foam would be pressed flat.
_SOLE_N_PER_M3 = 4e7

# 1 g of foam, 13 mm wide, that touches for 3 ms; mass and width are those of the usual toy.
_BULLET = Ball(
    mass_kg=0.001, radius_m=0.0065, inertia=0.5, stiffness_n_per_m15=4.2e3, damping_s_per_m=0.02, friction=0.5
)
# Size 5. On a thigh it touches for some 20 ms.
_FOOTBALL = Ball(mass_kg=0.43, radius_m=0.11, inertia=0.6, stiffness_n_per_m15=95e3, damping_s_per_m=0.15, friction=0.6)

Make = Callable[[np.random.Generator, Layout, float], list[Contact]]


@dataclass(frozen=True)
class SceneKind:
    """A scene that can be made.

    Attributes
    ----------
    name : str
    figure : str
        Of the paper.
    layout : str
        Of the skin.
    told_as : str
        The kind of impact that its events are to be told as: tap, press, step, impact or slide.
    rebounds : bool
        Whether they are to be told as a bounce.
    stiffness_n_per_m3 : float
        Of the skin with what is soft below and above it.
    make : callable
        ``make(rng, layout, begin_s)``: its contacts in the order of time, the first touching at `begin_s`.
    """

    name: str
    figure: str
    layout: str
    told_as: str
    rebounds: bool
    stiffness_n_per_m3: float
    make: Make


SCENES: dict[str, SceneKind] = {}
"""Every scene by its name."""


def register(
    name: str,
    figure: str,
    on: str,
    told_as: str,
    *,
    rebounds: bool = False,
    stiffness_n_per_m3: float = _FLESH_N_PER_M3,
) -> Callable[[Make], Make]:
    """Register the decorated function in `SCENES`, on the skin of a layout; all else is as of `SceneKind`.

    Raises
    ------
    SettingsError
        When there is a scene of this name already.
    """
    return registering(
        name,
        SCENES,
        "scene",
        lambda make: SceneKind(name, figure, on, told_as, rebounds, stiffness_n_per_m3, make),
    )


def _near(rng: np.random.Generator, patch: SkinPatch, within_m: float) -> tuple[float, float]:
    """A random place near the middle of a patch."""
    dx_m, dy_m = rng.uniform(-within_m, within_m, 2)
    return float(patch.origin_m[0] + dx_m), float(patch.origin_m[1] + dy_m)


@register("arm_tap", "8B", on="arm", told_as="tap")
def _arm_tap(rng: np.random.Generator, arranged: Layout, begin_s: float) -> list[Contact]:
    """Three fingertips tap an arm at once, for 60 to 110 ms."""
    duration_s = float(rng.uniform(0.06, 0.11))
    motion = tapped(float(rng.uniform(*FINGERTIPS.depth_m)), duration_s)
    place_m = _near(rng, arranged.patches[0], 0.03)
    span_s = begin_s, begin_s + duration_s
    return [Pressing(FINGERTIPS, motion, span_s, place_m, float(rng.uniform(0, 2 * np.pi)))]


@register("ball_catch", "8C", on="glove", told_as="impact")
def _ball_catch(rng: np.random.Generator, arranged: Layout, begin_s: float) -> list[Contact]:
    """A tennis ball flies into the palm at 3 to 5 m/s, and four fingers close around it."""
    # Ball and palm together are softer than ball and table, and lose more.
    ball = replace(ball_named("tennis"), stiffness_n_per_m15=50e3, damping_s_per_m=0.5)
    patches = {patch.name: patch for patch in arranged.patches}
    throw = thrown(float(rng.uniform(3.0, 5.0)), 0.0, math.pi / 2, *_near(rng, patches["palm"], 0.012))
    until_s, grip_n = float(rng.uniform(0.45, 0.6)), float(rng.uniform(2.0, 5.0))
    grip = held(grip_n, 0.03, until_s)
    contacts: list[Contact] = [Caught(ball, collide(ball, throw, begin_s), grip, begin_s + until_s)]
    for name in ("index", "middle", "ring", "little"):
        closes_s, opens_s = float(rng.uniform(0.04, 0.09)), until_s - float(rng.uniform(0.0, 0.03))
        motion = held(float(rng.uniform(*FINGER.depth_m)), 0.010, opens_s - closes_s)
        span_s = begin_s + closes_s, begin_s + opens_s
        contacts.append(Pressing(FINGER, motion, span_s, _near(rng, patches[name], 0.002), is_event=False))
    return contacts


@register("footstep", "8D", on="insole", told_as="step", stiffness_n_per_m3=_SOLE_N_PER_M3)
def _footstep(rng: np.random.Generator, arranged: Layout, begin_s: float) -> list[Contact]:
    """A step: the heel strikes, and the weight rolls over the outer edge and the ball of the foot to the toes."""
    stance_s, weight = float(rng.uniform(0.55, 0.75)), float(rng.uniform(0.8, 1.1))
    striking_s = float(rng.uniform(0.012, 0.020))
    heel = held(weight * HEEL.depth_m[0], striking_s, 0.6 * stance_s)
    contacts: list[Contact] = [Pressing(HEEL, heel, (begin_s, begin_s + 0.6 * stance_s), (0.0, -0.095))]
    for item, (first, last), place_m in (
        (MIDFOOT, (0.06, 0.75), (0.012, -0.02)),
        (FOREFOOT, (0.12, 0.97), (0.0, 0.060)),
        (TOES, (0.40, 1.0), (-0.010, 0.110)),
    ):
        motion = rolled(weight * item.depth_m[1], (last - first) * stance_s)
        span_s = begin_s + first * stance_s, begin_s + last * stance_s
        contacts.append(Pressing(item, motion, span_s, place_m, is_event=False))
    return contacts


@register("helmet_hit", "8E", on="helmet", told_as="impact", rebounds=True)
def _helmet_hit(rng: np.random.Generator, arranged: Layout, begin_s: float) -> list[Contact]:
    """A foam bullet hits a helmet at 15 to 22 m/s."""
    throw = thrown(float(rng.uniform(15.0, 22.0)), 0.0, math.pi / 2, *_near(rng, arranged.patches[0], 0.045))
    return [Bullet(_BULLET.radius_m, collide(_BULLET, throw, begin_s))]


@register("chest_touch", "8F", on="chest", told_as="press")
def _chest_touch(rng: np.random.Generator, arranged: Layout, begin_s: float) -> list[Contact]:
    """A palm comes at 0.05 to 0.15 m/s, rests on a chest for half a second to one, and leaves."""
    until_s, depth_m = float(rng.uniform(0.5, 1.0)), float(rng.uniform(*PALM.depth_m))
    motion = held(depth_m, depth_m / float(rng.uniform(0.05, 0.15)), until_s)
    place_m = _near(rng, arranged.patches[0], 0.025)
    return [Pressing(PALM, motion, (begin_s, begin_s + until_s), place_m, float(rng.uniform(0, 2 * np.pi)))]


@register("juggling", "8G", on="leg", told_as="impact", rebounds=True)
def _juggling(rng: np.random.Generator, arranged: Layout, begin_s: float) -> list[Contact]:
    """A football is kept up with a thigh: four touches, between them flights of 0.2 to 0.45 m height."""
    heights_m = rng.uniform(0.20, 0.45, 5)
    speeds_m_s = np.sqrt(2 * GRAVITY_M_S2 * heights_m)
    contacts: list[Contact] = []
    at_s = begin_s
    for comes_m_s, leaves_m_s in zip(speeds_m_s[:-1].tolist(), speeds_m_s[1:].tolist(), strict=True):
        # The thigh moves up, and gives what the ball loses; about 0.7 of the speed against it comes back.
        against_m_s = (comes_m_s + leaves_m_s) / 1.7
        throw = thrown(against_m_s, 0.0, math.pi / 2, *_near(rng, arranged.patches[0], 0.025))
        contacts.append(Bouncing(_FOOTBALL, collide(_FOOTBALL, throw, at_s)))
        at_s = contacts[-1].end_s + 2 * leaves_m_s / GRAVITY_M_S2
    return contacts
