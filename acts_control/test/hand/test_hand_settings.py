# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings of a hand's nodes that do not go together."""

from __future__ import annotations

from typing import Any

import pytest

from acts_control.hand.control import HandLoopConfig
from acts_control.hand.nodes.hand_node import HandSettings
from acts_control.hand.nodes.reflexes_node import HandReflexesSettings
from acts_core.errors import SettingsError

BOTH_NODES = pytest.mark.parametrize("settings", [HandSettings, HandReflexesSettings])


@BOTH_NODES
@pytest.mark.parametrize(("rate_hz", "motor_watchdog_s"), [(10.0, 0.1), (99.0, 0.02), (10.0, 0.199)])
def test_a_rate_at_which_the_motors_would_stop_by_themselves_is_refused(
    settings: type, rate_hz: float, motor_watchdog_s: float
) -> None:
    told = (
        rf"rate_hz = {rate_hz:g}: .* motor_watchdog_s = {motor_watchdog_s:g} .*: "
        rf"raise rate_hz to {2.0 / motor_watchdog_s:.4g}, or motor_watchdog_s to {2.0 / rate_hz:.4g}"
    )
    with pytest.raises(SettingsError, match=told):
        settings(rate_hz=rate_hz, motor_watchdog_s=motor_watchdog_s)


@BOTH_NODES
@pytest.mark.parametrize(
    "values",
    [
        {"rate_hz": 10.0},
        {"rate_hz": 10.0, "motor_watchdog_s": 0.0},
        {"rate_hz": 100.0, "motor_watchdog_s": 0.02},
        # It has no motors of its own.
        {"rate_hz": 10.0, "motor_watchdog_s": 0.02, "interface": "cmd_leap"},
    ],
)
def test_a_rate_at_which_the_motors_hear_often_enough_is_taken(settings: type, values: dict[str, Any]) -> None:
    assert settings(**values).rate_hz == values["rate_hz"]


@pytest.mark.parametrize("settings", [HandSettings, HandReflexesSettings, HandLoopConfig])
def test_silence_that_begins_with_a_single_lost_answer_is_refused(settings: type) -> None:
    with pytest.raises(
        SettingsError, match=r"silence_s = 0\.15: .* rate_hz = 10.*: raise silence_s to 0\.2, or rate_hz"
    ):
        settings(rate_hz=10.0, silence_s=0.15)
    assert settings(rate_hz=20.0, silence_s=0.15).silence_s == 0.15
