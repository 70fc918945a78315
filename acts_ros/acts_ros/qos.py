# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Quality of service of the ACTS topics.

1 kHz topics are best effort, topics for viewers are reliable, and descriptions of a skin are kept for late joiners.
For publishers and subscriptions made with `overridable`, ``qos_overrides`` in a params file can change this.
"""

import re
from collections.abc import Mapping
from copy import copy
from typing import Any

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions

from acts_core.errors import SettingsError

OVERRIDES = "qos_overrides."
"""How the names of the parameters begin that override quality of service."""

# What is between that and the policy; several publishers of a topic may be told apart by what is behind the word.
_END = re.compile(r"(/\w+)+\.(publisher|subscription)(_\w+)?")

_DEPTH_MAX = 2**31 - 1
_WORDS = {
    "history": ("keep_last", "keep_all", "system_default"),
    "reliability": ("reliable", "best_effort", "system_default"),
}

STREAM = QoSProfile(
    reliability=ReliabilityPolicy.BEST_EFFORT,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    # A quarter of a second at 1 kHz: a subscriber that is delayed by less loses nothing.
    depth=256,
)
"""1 kHz topics: samples, contact, cop, image_raw."""

VIEW = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    depth=5,
)
"""Topics for viewers, at most 30 Hz: image."""

STATE = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    depth=50,
)
"""States, references and statistics up to a few hundred hertz."""

LATCHED = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    history=HistoryPolicy.KEEP_LAST,
    depth=1,
)
"""Settings and baselines: late joiners get the last one."""


def overridable(profile: QoSProfile) -> dict[str, Any]:
    """Keyword arguments for a publisher or subscription whose quality of service a params file may override.

    The profile is copied, because rclpy writes the overrides into the profile that it is given.
    """
    return {"qos_profile": copy(profile), "qos_overriding_options": QoSOverridingOptions.with_default_policies()}


def check_overrides(given: Mapping[str, object]) -> None:
    """Refuse overrides that rclpy passes over silently, or ends the process for with a traceback.

    Parameters
    ----------
    given : mapping of str to object
        Values of parameters by name; those that do not begin with `OVERRIDES` are not looked at.

    Raises
    ------
    SettingsError
        For a name that is not made of topic, ``publisher`` or ``subscription``, and policy; another policy than
        `overridable` has; or a value that it cannot have.
    """
    for name, value in given.items():
        if not name.startswith(OVERRIDES):
            continue
        end, _, policy = name.removeprefix(OVERRIDES).rpartition(".")
        if not _END.fullmatch(end):
            raise SettingsError(
                f"{name}: needed is {OVERRIDES}TOPIC.publisher.POLICY or {OVERRIDES}TOPIC.subscription.POLICY, with "
                "the topic's full name, such as /plate/contact"
            )
        if policy == "depth":
            # A truth value is a whole number to Python.
            fits, allowed = type(value) is int and 1 <= value <= _DEPTH_MAX, f"a whole number, 1 to {_DEPTH_MAX}"
        elif policy in _WORDS:
            words = _WORDS[policy]
            fits, allowed = isinstance(value, str) and value.lower() in words, f"one of {', '.join(words)}"
        else:
            raise SettingsError(f"{name}: {policy!r} cannot be overridden; allowed are depth, {', '.join(_WORDS)}")
        if not fits:
            raise SettingsError(f"{name} = {value!r}: allowed is {allowed}")
