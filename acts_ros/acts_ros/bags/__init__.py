# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reading bags of any recorder, and writing them. Importing this imports neither ROS nor rosbags; the modules do."""

from __future__ import annotations

import importlib.util

from acts_core.errors import RecordingError


def require_rosbags() -> None:
    """Refuse to go on without the library that reads bags, which is no part of a ROS installation.

    Raises
    ------
    RecordingError
        It is not installed.
    """
    if importlib.util.find_spec("rosbags") is None:
        raise RecordingError(
            "the Python package rosbags is not installed. Install it with: pip install rosbags==0.11.9"
        )
