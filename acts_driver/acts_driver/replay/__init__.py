# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recordings that stand in for a board.

In come files of frames, bags and npz; out come the bytes that a board would send, at the recording's pace.
"""

from acts_driver.replay.recordings import ReplayOptions, SeekableRecording, open_recording
from acts_driver.replay.replay import ReplaySource

__all__ = ["ReplayOptions", "ReplaySource", "SeekableRecording", "open_recording"]
