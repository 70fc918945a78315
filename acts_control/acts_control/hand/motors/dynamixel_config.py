# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings of Dynamixel motors; those that motors cannot take are refused."""

from __future__ import annotations

from dataclasses import dataclass

from acts_control.hand.description import Joint
from acts_control.hand.motors.bus import BusConfig
from acts_control.hand.motors.dynamixel_table import LARGEST_GAIN
from acts_core.errors import SettingsError
from acts_core.settings import rounded_up, setting

# What the SDK waits for a lost reply besides twice `answer_timeout_ms`.
_SDK_WAITS_S = 0.002


@dataclass(frozen=True)
class DynamixelConfig(BusConfig):
    """How the motors are reached, and how strong they are."""

    baud: int = setting(4_000_000, "bits a second on the bus", minimum=9600, maximum=4_000_000)
    answer_timeout_ms: float = setting(
        16.0,
        "half of the time to wait for a reply, in addition to the time of its bytes [ms]",
        minimum=1.0,
        maximum=500.0,
    )
    position_p_gain: int = setting(600, "P gain of position control", minimum=0, maximum=LARGEST_GAIN)
    position_i_gain: int = setting(0, "I gain of position control", minimum=0, maximum=LARGEST_GAIN)
    position_d_gain: int = setting(200, "D gain of position control", minimum=0, maximum=LARGEST_GAIN)
    max_current_ma: int = setting(350, "largest current of each motor [mA]", minimum=1, maximum=1750)
    motor_watchdog_s: float = setting(
        0.2,
        "a motor that hears nothing for longer stops [s]; 0: never. At least a period of rate_hz, and another one or "
        "the wait for a lost reply (twice answer_timeout_ms and 2 ms), whichever is longer",
        minimum=0.0,
        maximum=2.54,
    )
    set_return_delay: bool = setting(
        False, "whether to set the return delay in the EEPROM of the motors to 0 where it is not"
    )

    @property
    def lost_answer_s(self) -> float:
        """How long a reply is waited for that does not come [s]."""
        return 2e-3 * self.answer_timeout_ms + _SDK_WAITS_S

    def check_rate(self, rate_hz: float) -> None:
        """See `BusConfig.check_rate`."""
        period_s, lost_s = 1.0 / rate_hz, self.lost_answer_s
        # One cycle may be late, or wait for a reply that is lost.
        least_s = period_s + max(period_s, lost_s)
        if 0.0 < self.motor_watchdog_s < least_s:
            ways = [f"raise motor_watchdog_s to {rounded_up(least_s)}"]
            if self.motor_watchdog_s > lost_s:
                ways.append("raise rate_hz")
            if self.motor_watchdog_s > 2.0 * period_s:
                ways.append("lower answer_timeout_ms")
            raise SettingsError(
                f"motor_watchdog_s = {self.motor_watchdog_s:g}: with rate_hz = {rate_hz:g} and answer_timeout_ms = "
                f"{self.answer_timeout_ms:g} the motors may hear nothing for {least_s:.4g} s when one reply is lost, "
                f"and would stop: {' or '.join(ways)}"
            )

    def check_grip_current(self, max_grip_current_ma: float) -> None:
        """See `BusConfig.check_grip_current`."""
        if max_grip_current_ma >= self.max_current_ma:
            raise SettingsError(
                f"max_grip_current_ma = {max_grip_current_ma:g}: no motor takes more, with max_current_ma = "
                f"{self.max_current_ma}, so it would not limit the grip: lower max_grip_current_ma or raise "
                f"max_current_ma"
            )

    def gains(self, joint: Joint) -> tuple[int, int, int]:
        """The P, I and D gain of a joint's motor.

        Raises
        ------
        SettingsError
            When a motor cannot take one of them.
        """
        scaled = []
        for name in ("position_p_gain", "position_d_gain"):
            gain = getattr(self, name)
            scaled.append(round(gain * joint.gain_scale))
            if scaled[-1] > LARGEST_GAIN:
                raise SettingsError(
                    f"joint {joint.name}: {name} {gain} times gain_scale {joint.gain_scale:g} is {scaled[-1]}; "
                    f"a motor takes 0 to {LARGEST_GAIN}: lower one of them"
                )
        p_gain, d_gain = scaled
        return p_gain, self.position_i_gain, d_gain
