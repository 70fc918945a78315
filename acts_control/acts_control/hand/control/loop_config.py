# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings of the loop of a hand."""

from __future__ import annotations

from dataclasses import dataclass

from acts_core.errors import SettingsError
from acts_core.settings import rounded_up, setting, validate

# So many reads have to fail before motors count as silent: one answer may be lost.
_LEAST_READS = 2
# For so many cycles a command has to count: one may be late.
_LEAST_CYCLES = 2


@dataclass(frozen=True)
class HandLoopConfig:
    """Rates and limits of the loop."""

    rate_hz: float = setting(100.0, "how often the motors are read and commanded [Hz]", minimum=10.0, maximum=500.0)
    max_speed_rad_s: float = setting(
        3.0, "fastest that a joint's goal moves towards the command [rad/s]", minimum=0.01, maximum=8.0
    )
    command_stale_after_s: float = setting(
        0.5,
        "without a command for longer the goals stand still [s]; at least two periods of rate_hz",
        minimum=0.01,
        maximum=10.0,
    )
    silence_s: float = setting(
        0.3,
        "motors that do not answer for longer are connected anew [s]; at least two periods of rate_hz",
        minimum=0.05,
        maximum=10.0,
    )
    connect_retry_s: float = setting(1.0, "time between attempts to connect [s]", minimum=0.05, maximum=60.0)
    max_faults: int = setting(
        2, "a motor that has switched itself off so often within a minute is given up", minimum=1, maximum=100
    )
    autostart: bool = setting(
        True, "whether to switch the torque on at once; else, and with interface cmd_leap always, on ~/enable"
    )

    def __post_init__(self) -> None:
        validate(self)
        if self.command_stale_after_s < _LEAST_CYCLES / self.rate_hz:
            raise SettingsError(
                f"command_stale_after_s = {self.command_stale_after_s:g}: with rate_hz = {self.rate_hz:g} the joints "
                f"are commanded every {1.0 / self.rate_hz:.4g} s, and a command could be old before it is followed: "
                f"raise command_stale_after_s to {rounded_up(_LEAST_CYCLES / self.rate_hz)}, or rate_hz to "
                f"{rounded_up(_LEAST_CYCLES / self.command_stale_after_s)}"
            )
        if self.silence_s < _LEAST_READS / self.rate_hz:
            raise SettingsError(
                f"silence_s = {self.silence_s:g}: with rate_hz = {self.rate_hz:g} the motors are read "
                f"every {1.0 / self.rate_hz:.4g} s, and one lost answer would count as silence: raise silence_s to "
                f"{rounded_up(_LEAST_READS / self.rate_hz)}, or rate_hz to {rounded_up(_LEAST_READS / self.silence_s)}"
            )
