# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The makes of motors by name: a new one is a module beside this and a line here (docs/hand.md)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, make_dataclass
from typing import Any

from acts_control.hand.description import HandDescription
from acts_control.hand.motors.bus import BusConfig, HandBus
from acts_control.hand.motors.dynamixel import DynamixelHand
from acts_control.hand.motors.dynamixel_config import DynamixelConfig
from acts_core.settings import part_of, refuse_doubles


@dataclass(frozen=True)
class MotorKind:
    """A make of motors.

    Attributes
    ----------
    config : type
        Its settings, which become parameters of the nodes; its ``__post_init__`` checks them.
    make : callable
        Makes the bus of a hand from these settings.
    """

    config: type[BusConfig]
    make: Callable[[HandDescription, Any], HandBus]


MOTORS: dict[str, MotorKind] = {
    "dynamixel": MotorKind(DynamixelConfig, DynamixelHand),
}


def make_motors(name: str, hand: HandDescription, settings: Any) -> HandBus:
    """The motors of a hand; `settings` are of a class by `with_motors`."""
    kind = MOTORS[name]
    return kind.make(hand, part_of(kind.config, settings))


def with_motors(own: type[BusConfig]) -> type:
    """A settings class: those of `own`, and the settings of every make of motors there is.

    Raises
    ------
    SettingsError
        When two of them have a setting of one name.
    """
    configs = [kind.config for kind in MOTORS.values()]
    refuse_doubles(own, *configs, common=BusConfig)
    namespace = {"__post_init__": own.__post_init__, "__doc__": own.__doc__}
    return make_dataclass(own.__name__, [], bases=(own, *configs), namespace=namespace, frozen=True)
