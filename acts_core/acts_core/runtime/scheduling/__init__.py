# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""When the kernel runs the threads of a process: real-time priority, cores, and short time slices without any right."""

from acts_core.runtime.scheduling.realtime import RealtimeConfig, enter_realtime, parse_cores
from acts_core.runtime.scheduling.realtime_guard import LogCallback, demote_process
from acts_core.runtime.scheduling.time_slices import SHORTEST_NS, set_time_slice, time_slice_ns

__all__ = [
    "SHORTEST_NS",
    "LogCallback",
    "RealtimeConfig",
    "demote_process",
    "enter_realtime",
    "parse_cores",
    "set_time_slice",
    "time_slice_ns",
]
