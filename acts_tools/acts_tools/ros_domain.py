"""A ROS domain of one's own, so that a run neither disturbs nor is disturbed by what else runs here."""

from __future__ import annotations

import os
import socket

from acts_core.errors import LaunchError

_DOMAIN_IDS = range(215, 232)


def use_free_domain() -> None:
    """Set ``ROS_DOMAIN_ID`` for this process and its children, unless somebody has chosen one.

    Raises
    ------
    LaunchError
        When none is free.
    """
    if "ROS_DOMAIN_ID" not in os.environ:
        os.environ["ROS_DOMAIN_ID"] = str(free_domain_id())


def free_domain_id() -> int:
    """A domain that nobody on this machine uses.

    The highest ones, because nobody counts up to them; their ports lie above Linux's ephemeral ones. One is free where
    nobody has the port of its first participant.

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
