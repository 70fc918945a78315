# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""All robots by name: a new one is a module and a line here (docs/extending.md)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, make_dataclass
from typing import Any

from acts_control.robots.base import Robot, RobotConfig
from acts_control.robots.ur import UrConfig, UrRobot
from acts_core.errors import SettingsError
from acts_core.settings import refuse_doubles, setting


@dataclass(frozen=True)
class RobotKind:
    """A kind of robot.

    Attributes
    ----------
    config : type
        Its settings, which become parameters of the node `ball_control`; its ``__post_init__`` checks them.
    make : callable
        Makes the robot from an object with these settings.
    has_simulation : bool
        Whether there is a simulation of it. If so, `config` has to refuse, with `loopback_only`, settings that speak of
        a real one; if not, the robot itself is refused then, so that what a simulated skin feels never moves it.
    """

    config: type[RobotConfig]
    make: Callable[[Any], Robot]
    has_simulation: bool = False


ROBOTS: dict[str, RobotKind] = {
    "ur5e": RobotKind(UrConfig, UrRobot, has_simulation=True),
}


def make_robot(settings: Any) -> Robot:
    """The robot that `settings` name, made from them; they are of a class by `with_robots`."""
    return ROBOTS[settings.robot].make(settings)


def with_robots(own: type) -> type:
    """A settings class: those of `own`, the name of the robot, and the settings of every robot there is.

    It checks what `own` checks, and what the robot of that name does.

    Raises
    ------
    SettingsError
        When two of them have a setting of one name.
    """
    refuse_doubles(own, *(kind.config for kind in ROBOTS.values()), common=RobotConfig)

    def check(self: Any) -> None:
        own.__post_init__(self)  # type: ignore[attr-defined]
        kind = ROBOTS[self.robot]
        if self.loopback_only and not kind.has_simulation:
            raise SettingsError(
                f"robot = {self.robot!r}: nothing is controlled, for the skin is simulated and this robot is not; "
                f"with a real skin give sim:=false"
            )
        kind.config.__post_init__(self)

    name = setting("ur5e", "what carries the plate", choices=tuple(ROBOTS))
    bases = (own, *(kind.config for kind in ROBOTS.values()))
    namespace = {"__post_init__": check, "__doc__": own.__doc__}
    return make_dataclass(own.__name__, [("robot", str, name)], bases=bases, namespace=namespace, frozen=True)
