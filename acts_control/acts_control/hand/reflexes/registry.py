# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""All reflexes by name: a new one is a file beside this and a line here (docs/reflexes.md)."""

from __future__ import annotations

from dataclasses import make_dataclass
from typing import Any

from acts_control.hand.reflexes.base import Reflex
from acts_control.hand.reflexes.hand_to_hand import HandToHand
from acts_control.hand.reflexes.sharp_avoidance import SharpAvoidance
from acts_control.hand.reflexes.slip_prevention import SlipPrevention
from acts_control.hand.reflexes.sphere_balancing import SphereBalancing
from acts_control.hand.reflexes.trapping import Trapping
from acts_core.errors import SettingsError
from acts_core.settings import part_of, refuse_doubles, unknown_key_message

_NONE = "none"

REFLEXES: dict[str, type[Reflex]] = {
    "sharp": SharpAvoidance,
    "slip": SlipPrevention,
    "sphere": SphereBalancing,
    "trap": Trapping,
    "hand_to_hand": HandToHand,
}


def make_reflexes(names: str, settings: Any) -> dict[str, Reflex]:
    """The reflexes of these names, with blanks or commas between them, made from one object with all their settings.

    The word none stands for none of them.

    Raises
    ------
    SettingsError
        For a name that is not in the registry, and for settings that a reflex refuses.
    """
    wanted = names.replace(",", " ").split()
    if wanted == [_NONE]:
        return {}
    for name in wanted:
        if name not in REFLEXES:
            raise SettingsError(unknown_key_message(name, list(REFLEXES), "reflexes"))
    return {name: REFLEXES[name](part_of(REFLEXES[name].Config, settings)) for name in wanted}


def with_reflexes(own: type) -> type:
    """A settings class: those of `own`, and the settings of every reflex there is.

    Raises
    ------
    SettingsError
        When two of them have a setting of one name.
    """
    configs = [kind.Config for kind in REFLEXES.values()]
    refuse_doubles(own, *configs)
    namespace = {"__post_init__": own.__post_init__, "__doc__": own.__doc__}  # type: ignore[attr-defined]
    return make_dataclass(own.__name__, [], bases=(*configs, own), namespace=namespace, frozen=True)
