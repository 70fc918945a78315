# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames with the time of their measurement: which are new, which are missing, when each was measured.

In come decoded frames and the time of their arrival; out come frames with the host's time, and statistics
of the stream. `ClockFilter` maps the board's clock onto the host's.
"""

from acts_driver.stream.backlog import BacklogWatch
from acts_driver.stream.clock import ClockFilter
from acts_driver.stream.stream import FrameStream

__all__ = ["BacklogWatch", "ClockFilter", "FrameStream"]
