"""How ACTS enters the middleware: without shared memory, and bound to this machine where it is to keep to it.

A publisher of Fast DDS looks into the shared memory of each subscriber from within ``publish()``. One that joins,
leaves or stands still holds it up there, for 0.33 s at a time and up to a second, and all other subscribers with it.

``ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST`` by itself only keeps nodes from looking further. Their sockets are open on
all interfaces, and another machine that names this one as its peer gets and sends everything.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, MutableMapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import rclpy
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.logging import get_logger

from acts_core.errors import SettingsError
from acts_ros.processes import packages

_RANGE, _LOCALHOST_ONLY = "ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_LOCALHOST_ONLY"
# What it becomes where the profile says where to look.
_BOUND = "SYSTEM_DEFAULT"
_TRANSPORTS = "FASTDDS_BUILTIN_TRANSPORTS"
# Jazzy's Fast DDS knows the older name only; newer ones complain about it.
_PROFILE, _JAZZY_PROFILE = "FASTDDS_DEFAULT_PROFILES_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE"
# With any of these somebody has chosen a network of their own.
_CHOICES = (_PROFILE, _JAZZY_PROFILE, "ROS_STATIC_PEERS", "ROS_DISCOVERY_SERVER")
# Fast DDS reads them where a process starts.
_FILES = ("DEFAULT_FASTDDS_PROFILES.xml", "DEFAULT_FASTRTPS_PROFILES.xml")


# Where in its own source ROS found that something is wrong.
_SOURCE_PLACE = re.compile(r", at \S+:\d+")


def init(**options: Any) -> None:
    """`rclpy.init`, before which `choose_transports` is called; what stands against that is logged.

    Raises
    ------
    SettingsError
        As of `telling_wrong_arguments`.
    """
    obstacle = choose_transports(os.environ, rclpy.get_rmw_implementation_identifier(), Path.cwd())
    with telling_wrong_arguments():
        rclpy.init(**options)
    if obstacle is not None:
        get_logger("acts_ros").warning(
            f"{_RANGE} asks for this machine only, but {obstacle}: others may get in (docs/security.md)"
        )


@contextmanager
def telling_wrong_arguments() -> Iterator[None]:
    """What ROS refuses of a command line, such as a params file that is no YAML, is raised as `SettingsError`."""
    try:
        yield
    except rclpy_implementation.RCLInvalidROSArgsError as error:
        raise SettingsError(_SOURCE_PLACE.sub("", str(error))) from None


def choose_transports(environment: MutableMapping[str, str], rmw: str, folder: Path) -> str | None:
    """Have Fast DDS do without shared memory and, where this machine only is asked for, open sockets on 127.0.0.1 only.

    What the user has set stays. Processes that are started from this one inherit it.

    Parameters
    ----------
    environment : mutable mapping of str to str
        Is changed; the middleware reads it when ROS is initialised.
    rmw : str
        Name of the middleware.
    folder : Path
        Where the process runs.

    Returns
    -------
    str or None
        What stands against keeping to this machine; None where it is done or not asked for.

    Raises
    ------
    LaunchError
        The profile is not installed.
    """
    only_here = environment.get(_RANGE) == "LOCALHOST" or environment.get(_LOCALHOST_ONLY) == "1"
    if not rmw.startswith("rmw_fastrtps"):
        return f"ACTS cannot bind {rmw}" if only_here else None
    profile = str(packages.share("acts_config", environment) / "network" / "loopback.xml")
    if environment.get(_RANGE) != _BOUND:
        # Inherited from a process that was bound; what is asked for here is another matter.
        for name in (_PROFILE, _JAZZY_PROFILE):
            if environment.get(name) == profile:
                del environment[name]
    if not only_here:
        # Where there is a profile it says which transports there are.
        environment.setdefault(_TRANSPORTS, "UDPv4")
        return None
    if environment.get("ROS_DISTRO") == "humble":
        # It does not know the range; this one does bind to the loopback there.
        environment[_LOCALHOST_ONLY] = "1"
        return None
    chosen = [name for name in _CHOICES if environment.get(name)]
    chosen += [name for name in _FILES if (folder / name).exists()]
    if chosen:
        return f"{', '.join(chosen)} is there and is left as it is"
    environment[_JAZZY_PROFILE if environment.get("ROS_DISTRO") == "jazzy" else _PROFILE] = profile
    environment.pop(_LOCALHOST_ONLY, None)
    environment[_RANGE] = _BOUND
    return None
