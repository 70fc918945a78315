# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A controller that consumes `contact`, to be copied: what carries the skin gives way to who pushes it.

    ./acts run python3 examples/ros/contact_controller.py --ros-args -r __ns:=/plate

Topics: contact (acts_msgs/Contact) in; twist (geometry_msgs/TwistStamped), in the skin's frame, out, as MoveIt Servo
and most velocity controllers take it. docs/extending.md, "A controller that consumes contact".
"""

from __future__ import annotations

import math
import sys
import time
from dataclasses import dataclass
from typing import Any

from geometry_msgs.msg import TwistStamped

from acts_core.errors import PacketError
from acts_core.settings import Changeable, setting, validate
from acts_core.stop_signals import StopSignals
from acts_msgs.msg import Contact
from acts_ros.clocks import keep_system_clock, steady_timer
from acts_ros.diagnostics import OK, WARN, DiagnosticsReporter, Report
from acts_ros.executor import run
from acts_ros.log import STEADY
from acts_ros.messages import read_contact
from acts_ros.parameters import declare, node_options
from acts_ros.polled import PollingNode
from acts_ros.qos import STATE, STREAM

_NS_PER_S = 1_000_000_000
# Contacts that have come while the loop was held up: the newest counts.
_CONTACTS = 64
# Clocks of two machines differ by less; a contact from further in the future is not to be trusted [s].
_FUTURE_S = 0.005
# After a longer pause the loop goes on as if it had been this long [s].
_LONGEST_STEP_S = 0.02


@dataclass(frozen=True)
class GiveWaySettings:
    """Parameters of the node. Whatever limits a motion has a range."""

    rate_hz: float = setting(250.0, "how often a speed is published", minimum=10.0, maximum=1000.0)
    touch_stale_after_s: float = setting(
        0.05, "where the newest touch is older, the motion ends [s]", minimum=0.005, maximum=1.0
    )
    light_force_n: float = setting(
        1.0, "up to here nothing moves [N]", minimum=0.0, maximum=100.0, changeable=Changeable.RUNNING
    )
    speed_per_n: float = setting(
        0.01,
        "speed for each newton above [m/(s N)]",
        minimum=0.0,
        maximum=1.0,
        changeable=Changeable.RUNNING,
    )
    max_speed_m_s: float = setting(0.1, "never faster [m/s]", minimum=0.0, maximum=0.5)
    max_acceleration_m_s2: float = setting(
        0.5, "never more, also where touch is stale [m/s^2]", minimum=0.01, maximum=10.0
    )

    def __post_init__(self) -> None:
        validate(self)


class GiveWay:
    """From force to speed, without ROS: whatever comes in, speed and acceleration stay within their limits.

    Parameters
    ----------
    settings : GiveWaySettings

    Attributes
    ----------
    speed_m_s : float
        Now, along z out of the skin; 0 or less, away from who pushes.
    is_stale : bool
        Whether the newest touch was too old.
    """

    def __init__(self, settings: GiveWaySettings) -> None:
        self.settings = settings
        self.speed_m_s = 0.0
        self.is_stale = True

    def step(self, force_n: float, age_s: float, dt_s: float) -> float:
        """The speed from now on [m/s].

        Parameters
        ----------
        force_n : float
            Of the newest contact; finite.
        age_s : float
            Since it was measured; inf: there was none.
        dt_s : float
            Since the step before.
        """
        settings = self.settings
        self.is_stale = not -_FUTURE_S <= age_s <= settings.touch_stale_after_s
        wanted = 0.0
        if not self.is_stale:
            wanted = -min(settings.speed_per_n * max(force_n - settings.light_force_n, 0.0), settings.max_speed_m_s)
        change = settings.max_acceleration_m_s2 * min(max(dt_s, 0.0), _LONGEST_STEP_S)
        self.speed_m_s += min(max(wanted - self.speed_m_s, -change), change)
        return self.speed_m_s


class GiveWayNode(PollingNode):
    """Takes the newest contact when a step is due, and publishes a speed at each."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__("give_way", **node_options(), **node_arguments)
        settings = declare(self, GiveWaySettings, self._change)
        # Stamps of contacts are by the system's clock: their age is as well.
        keep_system_clock(self, "it compares stamps with the present")
        self._behaviour = GiveWay(settings)
        self._force_n = 0.0
        self._stamp_ns: int | None = None
        self._refused = 0
        self._stepped_s = time.monotonic()
        self._message = TwistStamped()
        self._publisher = self.create_publisher(TwistStamped, "twist", STATE)
        # Not called back for every contact: that would cost a wake-up each. Bytes, of which only some are needed.
        self._contacts = self.create_raw_polled_subscription(Contact, "contact", STREAM, depth=_CONTACTS)
        self._diagnostics = DiagnosticsReporter(self, "give_way", self._report)
        steady_timer(self, 1.0 / settings.rate_hz, self._step)

    def close(self) -> None:
        """The defined end: whoever listens is told to stand still."""
        self._publish(0.0)

    def _change(self, settings: GiveWaySettings) -> str:
        """Put changed parameters in force."""
        self._behaviour.settings = settings
        return ""

    def _step(self) -> None:
        taken = self._contacts.take_all()
        if taken:
            self._take(taken[-1][0])
        now_s = time.monotonic()
        dt_s, self._stepped_s = now_s - self._stepped_s, now_s
        age_s = math.inf if self._stamp_ns is None else (time.time_ns() - self._stamp_ns) / _NS_PER_S
        self._publish(self._behaviour.step(self._force_n, age_s, dt_s))

    def _take(self, data: bytes) -> None:
        """Keep what is needed of a contact; what is no number never gets further than here."""
        try:
            contact = read_contact(data)
        except PacketError as error:
            self._refuse(str(error))
            return
        if not math.isfinite(contact.force_n):
            self._refuse("its force is no finite number")
            return
        self._force_n = contact.force_n if contact.in_contact else 0.0
        self._stamp_ns = contact.stamp_ns
        self._message.header.frame_id = contact.frame_id

    def _refuse(self, why: str) -> None:
        self._refused += 1
        self.get_logger().warning(
            f"contact dropped: {why}", throttle_duration_sec=5.0, throttle_time_source_type=STEADY
        )

    def _publish(self, speed_m_s: float) -> None:
        stamp = self._message.header.stamp
        stamp.sec, stamp.nanosec = divmod(time.time_ns(), _NS_PER_S)
        self._message.twist.linear.z = speed_m_s
        self._publisher.publish(self._message)

    def _report(self) -> Report:
        values = {"speed_m_s": self._behaviour.speed_m_s, "refused": self._refused}
        if self._behaviour.is_stale:
            return WARN, f"no fresh touch on {self._contacts.topic_name}: it stands still", values
        return OK, "gives way" if self._behaviour.speed_m_s else "stands still", values


def main(signals: StopSignals | None = None) -> int:
    """Run the node; the exit code."""
    return run([GiveWayNode], signals=signals)


if __name__ == "__main__":
    sys.exit(main())
