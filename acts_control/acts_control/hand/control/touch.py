# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the hand's skin feels: the newest touch that can be of this hand; anything else is counted and left out."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

from acts_control.hand.description import HandKinematics
from acts_core.skin import RegionContact

# Touch that is stamped further ahead of the clock is by another clock: it would count as the newest until then.
_FUTURE_S = 0.05

# What no skin of a hand goes beyond. Nothing pulls it: fingers would close on and on against such a force. With places
# farther off and longer normals, equations could not be solved.
_LARGEST = 1e6
_AMOUNTS = ("force_n", "area_m2", "peak_n", "spread_m", "concentration", "sharpness", "slip_m")
_LARGEST_PARTS = {"motion_m_s": _LARGEST, "centre_m": 10.0, "normal": 1.01}
_LONGEST_NAME = 64
_MOST_NAMES = 3


class HandTouch:
    """What has come of touch.

    Parameters
    ----------
    kinematics : HandKinematics

    Attributes
    ----------
    regions : dict of str to RegionContact
        The newest touch, by the names of the hand's regions and in their order.
    unfelt : tuple of str
        Regions of the hand of which it says nothing: nothing is felt there.
    is_new : bool
        Whether it has come since somebody set this to False.
    refused : int
        Messages left out, for what cannot be.
    refusal : str
        Why the last of them was; empty before the first.
    """

    def __init__(self, kinematics: HandKinematics) -> None:
        self._kinematics = kinematics
        self._hand = kinematics.hand
        self._stamp_s = self._came_s = -float("inf")
        self.regions: dict[str, RegionContact] = {}
        self.unfelt: tuple[str, ...] = ()
        self.is_new = False
        self.refused = 0
        self.refusal = ""

    def take(self, regions: Sequence[RegionContact], stamp_s: float, now_s: float) -> bool:
        """Take a message of touch, see `HandSupervisor.touch`."""
        if not stamp_s <= now_s + _FUTURE_S:
            return self.refuse(f"touch is stamped {stamp_s - now_s:.3g} s ahead of the clock")
        names = [one.name for one in regions]
        # A message has all patches of its skin, also those that nothing touches: this one says nothing of the hand.
        if not any(one.name in self._hand.regions for one in regions):
            return self.refuse(
                f"touch names {_listed(names)}; the hand has "
                f"{_listed(list(self._hand.regions))}: is `regions` the topic of another skin?"
            )
        twice = next((name for name in self._hand.regions if names.count(name) > 1), "")
        if twice:
            return self.refuse(f"touch names {twice!r} more than once")
        objection = next(filter(None, map(self._objection, regions)), "")
        if objection:
            return self.refuse(objection)
        if stamp_s <= self._stamp_s:
            return False  # newer touch has come: this may be of a recording
        felt = {one.name: one for one in regions}
        # In the order of the description, from the root of each finger to its tip: a layout may have any other.
        self.regions = {name: felt[name] for name in self._hand.regions if name in felt}
        self.unfelt = tuple(name for name in self._hand.regions if name not in self.regions)
        self._stamp_s, self._came_s = stamp_s, now_s
        self.is_new = True
        return True

    def refuse(self, why: str) -> bool:
        """Count a message that has come and cannot be used; False."""
        self.refused += 1
        self.refusal = why
        return False

    def age_s(self, now_s: float) -> float:
        """How old the newest touch is; infinite before the first [s]."""
        return now_s - self._stamp_s

    def comes_old_s(self, now_s: float, stale_after_s: float) -> float:
        """How old the touch is that comes now, where that counts as none already; 0 where it is not, or none comes [s].

        Parameters
        ----------
        now_s, stale_after_s : float
            As of `take`, and when touch counts as none [s].
        """
        old_s = self._came_s - self._stamp_s
        return old_s if old_s > stale_after_s and now_s - self._came_s <= stale_after_s else 0.0

    def _objection(self, region: RegionContact) -> str:
        """Why a region cannot be of this hand's skin, in words; empty where it can."""
        name, known = region.name[:_LONGEST_NAME], self._hand.regions.get(region.name)
        if known is not None and region.link != known.link:
            said = f"region {name!r} is said to be on link {region.link[:_LONGEST_NAME]!r}"
            if self._kinematics.has(region.link):
                return f"{said}; in the description of the hand it is on {known.link!r}"
            links = ", ".join(link.name for link in self._hand.links)
            return f"{said}; the hand has {self._hand.base}, {links}"
        impossible = _impossible(region)
        return f"region {name!r} cannot have {impossible}" if impossible else ""


def no_touch(age_s: float, comes_old_s: float = 0.0) -> str:
    """That touch is missing, and for how long, in words; infinite before the first. See `HandTouch.comes_old_s` [s]."""
    if comes_old_s:
        return f"touch is {comes_old_s:.2g} s old when it comes, as from a recording or a machine whose clock is behind"
    return f"no touch for {age_s:.2g} s" if isfinite(age_s) else "no touch so far"


def _listed(names: Sequence[str]) -> str:
    """Names of regions for a person, shortened: anybody may have sent them."""
    more = len(names) - _MOST_NAMES
    shown = ", ".join(name[:_LONGEST_NAME] for name in names[:_MOST_NAMES])
    return f"{shown} and {more} more" if more > 0 else shown or "no region at all"


def _impossible(region: RegionContact) -> str:
    """A number that no skin says, and what is allowed, in words; empty where there is none. NaN is one."""
    for name in _AMOUNTS:
        amount = getattr(region, name)
        if not 0.0 <= amount <= _LARGEST:
            return f"{name} = {amount:g}: allowed is 0 to {_LARGEST:g}"
    for name, largest in _LARGEST_PARTS.items():
        vector = getattr(region, name)
        if not all(abs(part) <= largest for part in vector):
            return f"{name} = {vector}: allowed is {-largest:g} to {largest:g} for each part"
    return ""
