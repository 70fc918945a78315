# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A free ROS domain, so that a run and other nodes on this machine do not affect each other."""

from __future__ import annotations

import os
import socket

from acts_core.errors import LaunchError

_DOMAIN_IDS = range(215, 232)


def use_free_domain() -> None:
    """Set ``ROS_DOMAIN_ID`` for this process and its children, unless it is set. An empty one is none, as to ROS.

    Raises
    ------
    LaunchError
        When none is free.
    SettingsError
        When the one that is set is no domain.
    """
    if not os.environ.get("ROS_DOMAIN_ID"):
        os.environ["ROS_DOMAIN_ID"] = str(free_domain_id())
        return
    # Imported here: it imports rclpy, which is slow, and only who has set one needs it.
    from acts_ros.middleware import check_domain

    check_domain(os.environ)


def free_domain_id() -> int:
    """A domain that no process on this machine uses.

    It tries the highest ones, which are rarely used and whose ports are above Linux's ephemeral ports. A domain is free
    if the port of its first participant is free.

    Raises
    ------
    LaunchError
        When none is free.
    """
    for step in range(len(_DOMAIN_IDS)):
        domain_id = _DOMAIN_IDS[(os.getpid() + step) % len(_DOMAIN_IDS)]
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(("", 7400 + 250 * domain_id + 10))
            except OSError:
                continue
        return domain_id
    raise LaunchError(
        f"ROS domains {_DOMAIN_IDS[0]} to {_DOMAIN_IDS[-1]} are all in use here; choose one: export ROS_DOMAIN_ID=1"
    )
