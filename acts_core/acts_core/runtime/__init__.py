# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a long-running process needs: real-time scheduling, background work, changes of the clock.

In come settings and stamps; out come decisions and warnings. Nothing here knows tactile skins.
"""

from acts_core.runtime import background
from acts_core.runtime.addresses import is_loopback
from acts_core.runtime.background import begin, is_done, within_patience
from acts_core.runtime.late_frames import LateFrames, Use
from acts_core.runtime.pace import Pace
from acts_core.runtime.port_words import errno_of, not_opened, path_shown, port_shown, ports_present
from acts_core.runtime.process_names import process_name
from acts_core.runtime.rate_limit import RateLimit
from acts_core.runtime.scheduling import LogCallback, RealtimeConfig, demote_process, enter_realtime, parse_cores
from acts_core.runtime.sequence_numbers import SequenceNumbers
from acts_core.runtime.stamp_order import NS_PER_S, Order, StampOrder
from acts_core.runtime.stream_statistics import StreamCounter
from acts_core.runtime.terminals import holders, is_multiplexer, is_stale_link, leads_to

__all__ = [
    "NS_PER_S",
    "LateFrames",
    "LogCallback",
    "Order",
    "Pace",
    "RateLimit",
    "RealtimeConfig",
    "SequenceNumbers",
    "StampOrder",
    "StreamCounter",
    "Use",
    "background",
    "begin",
    "demote_process",
    "enter_realtime",
    "errno_of",
    "holders",
    "is_done",
    "is_loopback",
    "is_multiplexer",
    "is_stale_link",
    "leads_to",
    "not_opened",
    "parse_cores",
    "path_shown",
    "port_shown",
    "ports_present",
    "process_name",
    "within_patience",
]
