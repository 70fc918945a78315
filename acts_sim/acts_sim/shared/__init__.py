# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What simulated processes share: options, a private folder, rings in shared memory, lines of text over sockets.

Into a ring come arrays with their times; out come those of any time that its slots reach back: 256 slots, the default,
are 512 ms at the 500 Hz of the simulated worlds.
"""

from acts_sim.shared.compiling import COMPILING, telling_of_compiling
from acts_sim.shared.lines import LineSession
from acts_sim.shared.options import add_settings, number, require_within, settings_from, whole_number
from acts_sim.shared.run_folder import FileClaim, default_run_dir
from acts_sim.shared.timed_ring import JOINT_RING_WIDTH, TimedRingReader, TimedRingWriter

__all__ = [
    "COMPILING",
    "JOINT_RING_WIDTH",
    "FileClaim",
    "LineSession",
    "TimedRingReader",
    "TimedRingWriter",
    "add_settings",
    "default_run_dir",
    "number",
    "require_within",
    "settings_from",
    "telling_of_compiling",
    "whole_number",
]
