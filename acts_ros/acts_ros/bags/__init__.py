# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reading bags of any recorder, and writing them. Importing this imports neither ROS nor rosbags; the modules do."""

from __future__ import annotations

import importlib
import importlib.util

from acts_core.errors import RecordingError

_HOW = "Install it with: pip install rosbags==0.11.9"


def require_rosbags() -> None:
    """Refuse to go on without the library that reads bags, which is no part of a ROS installation.

    Raises
    ------
    RecordingError
        It is not installed, or too old.
    """
    if importlib.util.find_spec("rosbags") is None:
        raise RecordingError(f"the Python package rosbags is not installed. {_HOW}")
    try:
        importlib.import_module("acts_ros.bags.reading")
    except ImportError as error:
        raise RecordingError(
            f"the Python package rosbags is of another version, or not whole ({error}). {_HOW}"
        ) from error
