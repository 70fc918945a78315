# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Communication of simulated processes: a private folder, rings in shared memory, lines of text over sockets.

In come arrays with their times; out come those of any time in the last 128 ms.
"""

from acts_sim.shared.lines import LineSession
from acts_sim.shared.run_folder import Claim, default_run_dir, make_private
from acts_sim.shared.timed_ring import TimedRingReader, TimedRingWriter

__all__ = ["Claim", "LineSession", "TimedRingReader", "TimedRingWriter", "default_run_dir", "make_private"]
