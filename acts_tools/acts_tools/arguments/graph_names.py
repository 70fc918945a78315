# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Names of topics and namespaces as people type them."""

from __future__ import annotations

import re

from acts_core.errors import SettingsError

_FULL_NAME = re.compile(r"(/[A-Za-z_]\w*)+", re.ASCII)


def full_name(given: str, what: str = "topic") -> str:
    """The name with one slash before it and none behind.

    Parameters
    ----------
    given : str
        From a command line, such as ``/plate/contact`` or ``plate``.
    what : str
        What it names, for the message.

    Raises
    ------
    SettingsError
        ROS has no such names.
    """
    name = f"/{given.strip('/')}"
    if _FULL_NAME.fullmatch(name) is None:
        raise SettingsError(
            f"{given!r} is no {what}: allowed are letters, digits (not first) and _, parts with / between"
        )
    return name
