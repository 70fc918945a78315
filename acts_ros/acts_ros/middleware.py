# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Initialise ROS without shared memory, and bound to this machine if only this machine is to be reached.

In ``publish()``, Fast DDS accesses the shared memory of each subscriber. A subscriber that joins, leaves or stands
still blocks it for 0.33 s at a time and up to a second, which delays all other subscribers.

``ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST`` only keeps nodes from searching other machines. Their sockets are open on
all interfaces, and another machine that names this one as its peer can receive and send everything.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator, Mapping, MutableMapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import rclpy
from rclpy.client import Client
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.logging import get_logger
from rclpy.task import Future

from acts_core.errors import ActsError, SettingsError
from acts_core.names import check_remaps
from acts_ros.params_files import more_of
from acts_ros.processes import packages

_RANGE, _LOCALHOST_ONLY = "ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_LOCALHOST_ONLY"
# Value of _RANGE where a profile limits discovery.
_BOUND = "SYSTEM_DEFAULT"
_TRANSPORTS = "FASTDDS_BUILTIN_TRANSPORTS"
# Fast DDS of Jazzy knows only the older name; newer versions warn about it.
_PROFILES = (_PROFILE, _JAZZY_PROFILE) = ("FASTDDS_DEFAULT_PROFILES_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE")
# Fast DDS reads these files in the working directory of a process.
_FILES = ("DEFAULT_FASTDDS_PROFILES.xml", "DEFAULT_FASTRTPS_PROFILES.xml")
# These name other machines.
_PEERS = ("ROS_STATIC_PEERS", "ROS_DISCOVERY_SERVER")

HIGHEST_DOMAIN = 232
"""Largest domain whose ports, from 7400 + 250 * domain on, are below 65536."""

# The place in the source of ROS that its error messages contain.
_SOURCE_PLACE = re.compile(r", at \S+:\d+")

NOT_SENT = ("Failed to publish", "failed to send response", "failed to send request")
"""How rclpy's errors begin of a message, an answer or a question that the middleware did not take."""
# What to do, by a part of what ROS says when it is initialised.
_ADVICE = {
    "failed to initialize logging": "set ROS_LOG_DIR to a folder that can be written",
    "SECURITY ERROR": "make the keys of this enclave with `ros2 security`, or unset ROS_SECURITY_ENABLE",
}


def init(**options: Any) -> None:
    """Call `choose_transports` and then `rclpy.init`; log why nodes cannot be bound to this machine.

    Raises
    ------
    SettingsError
        As of `check_domain` and `telling_wrong_arguments`.
    """
    check_domain(os.environ)
    obstacle = choose_transports(os.environ, rclpy.get_rmw_implementation_identifier(), Path())
    given = options.get("args")
    with telling_wrong_arguments(sys.argv if given is None else given):
        rclpy.init(**options)
    if obstacle is not None:
        get_logger("acts_ros").warning(
            f"{_RANGE} asks for this machine only, but {obstacle}: others may get in (docs/security.md)"
        )


def announces_often(environment: Mapping[str, str]) -> bool:
    """Whether this process announces itself twice a second, as the profiles in ``network`` of acts_config say."""
    profiles = [Path(environment[name]) for name in _PROFILES if environment.get(name)]
    return any(profile.parent == packages.share("acts_config", environment) / "network" for profile in profiles)


def reason_of(error: Exception) -> str:
    """What an error of rclpy says, without the lines of ROS's source that it adds."""
    return _SOURCE_PLACE.sub("", str(error))


class NotAskedError(ActsError):
    """The middleware has not taken a question; nobody has heard it, and it can be asked again."""


def ask(client: Client, request: Any) -> Future[Any]:
    """Call a service; the future is done when it has answered.

    Raises
    ------
    NotAskedError
        The middleware does not take the question: Fast DDS, for instance, gives one up when its own threads do not let
        go of a writer within 0.1 s.
    """
    try:
        return client.call_async(request)
    except rclpy_implementation.RCLError as error:
        raise NotAskedError(f"{client.srv_name} was not asked: {reason_of(error)}; ask again") from error


def check_domain(environment: Mapping[str, str]) -> None:
    """Refuse an invalid domain, for which ROS ends the process, in some releases without a message.

    Raises
    ------
    SettingsError
        ``ROS_DOMAIN_ID`` is not a number from 0 to 232.
    """
    text = environment.get("ROS_DOMAIN_ID", "")
    if text and not (text.isdecimal() and int(text) <= HIGHEST_DOMAIN):
        raise SettingsError(
            f"ROS_DOMAIN_ID={text}: allowed is 0 to {HIGHEST_DOMAIN}, for the ports of others do not exist; "
            "export another, or unset it for 0"
        )


@contextmanager
def telling_wrong_arguments(words: Sequence[str]) -> Iterator[None]:
    """Raise `SettingsError` where ROS refuses a command line, cannot begin its log, or lacks keys.

    The first is, for example, a params file that is not YAML, or a word that is not UTF-8; the second, a folder that
    cannot be written; the third, where ``ROS_SECURITY_ENABLE`` asks for them.
    """
    check_remaps(words)
    try:
        yield
    except rclpy_implementation.RCLInvalidROSArgsError as error:
        reason = reason_of(error).strip()
        raise SettingsError("; ".join(filter(None, (reason, more_of(reason, words))))) from None
    except UnicodeEncodeError as error:
        raise SettingsError(
            f"{error.object!r}: ROS takes text in UTF-8 only; rename the file or folder, or give a link to it"
        ) from None
    except rclpy_implementation.RCLError as error:
        reason = reason_of(error)
        advice = _advice_on(reason)
        if not advice:
            raise
        raise SettingsError(f"ROS: {reason}; {advice}") from None


def _advice_on(reason: str) -> str:
    """What to do where ROS refuses to begin for this reason; nothing where that is not known."""
    enabled, strategy, keys = (os.environ.get(f"ROS_SECURITY_{name}") for name in ("ENABLE", "STRATEGY", "KEYSTORE"))
    if (enabled, strategy) == ("true", "Enforce") and not keys:
        # ROS itself has no words for that.
        return "set ROS_SECURITY_KEYSTORE, which ROS_SECURITY_STRATEGY=Enforce needs, or unset ROS_SECURITY_ENABLE"
    return next((advice for part, advice in _ADVICE.items() if part in reason), "")


def choose_transports(environment: MutableMapping[str, str], rmw: str, folder: Path) -> str | None:
    """Disable the shared memory of Fast DDS and, if only this machine is to be reached, bind it to 127.0.0.1.

    Both have a profile in the folder ``network`` of acts_config, which on Humble is not used. Settings of the user are
    kept. Child processes inherit the environment.

    Parameters
    ----------
    environment : mutable mapping of str to str
        Is changed; the middleware reads it when ROS is initialised.
    rmw : str
        Name of the middleware.
    folder : Path
        Working directory of the process.

    Returns
    -------
    str or None
        Why nodes cannot be bound to this machine; None where they are, or need not be.

    Raises
    ------
    LaunchError
        The profile is not installed.
    """
    only_here = environment.get(_RANGE) == "LOCALHOST" or environment.get(_LOCALHOST_ONLY) == "1"
    if not rmw.startswith("rmw_fastrtps"):
        return f"ACTS cannot bind {rmw}" if only_here else None
    network = packages.share("acts_config", environment) / "network"
    bound, unbound = str(network / "loopback.xml"), str(network / "open.xml")
    if not only_here and environment.get(_RANGE) == _BOUND and bound in map(environment.get, _PROFILES):
        # Inherited from a process that is bound.
        return None
    for name in _PROFILES:
        if environment.get(name) in (bound, unbound):
            # Inherited from a process of which something else was asked.
            del environment[name]
    release = environment.get("ROS_DISTRO")
    variable = _JAZZY_PROFILE if release == "jazzy" else _PROFILE
    profiles = [name for name in _PROFILES if environment.get(name)]
    profiles += [name for name in _FILES if (folder / name).exists()]
    if not only_here:
        environment.setdefault(_TRANSPORTS, "UDPv4")
        if not profiles and release != "humble":
            environment[variable] = unbound
        return None
    if release == "humble":
        # Humble does not know the range, but binds to the loopback by this variable.
        environment[_LOCALHOST_ONLY] = "1"
        return None
    chosen = profiles + [name for name in _PEERS if environment.get(name)]
    if chosen:
        return f"{', '.join(chosen)} is there and is left as it is"
    environment[variable] = bound
    environment.pop(_LOCALHOST_ONLY, None)
    environment[_RANGE] = _BOUND
    return None
