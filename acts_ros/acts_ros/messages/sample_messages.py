# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Conversion of frames of samples to acts_msgs/TactileSamples and back."""

from __future__ import annotations

from array import array

import numpy as np

from acts_core.errors import PacketError
from acts_core.frames import SampleFrame, Scheme
from acts_core.runtime import NS_PER_S
from acts_msgs.msg import TactileSamples
from acts_ros.messages.stamps import ns_of, set_stamp

_US_PER_S = 1_000_000
_SCHEMES = {int(scheme): scheme for scheme in Scheme}


class SamplesMessage:
    """Reuses one message for all frames: building its nested parts takes longer than all the rest.

    Parameters
    ----------
    frame_id : str
        Of the header.
    """

    def __init__(self, frame_id: str) -> None:
        self._message = TactileSamples()
        self._message.header.frame_id = frame_id

    def fill(self, frame: SampleFrame, stamp_ns: int) -> TactileSamples:
        """Return the message of a frame; valid until the next call.

        Parameters
        ----------
        frame : SampleFrame
            The samples.
        stamp_ns : int
            ROS time at the end of the last measurement [ns].
        """
        message = self._message
        set_stamp(message.header.stamp, stamp_ns)
        message.sequence = frame.sequence
        message.scheme = int(frame.scheme)
        message.rows = frame.rows
        message.cols = frame.cols
        seconds, rest_us = divmod(frame.duration_us, _US_PER_S)
        message.duration.sec = seconds
        message.duration.nanosec = rest_us * 1000
        message.indices = array("H", frame.indices.tobytes())
        message.counts = array("H", frame.counts.tobytes())
        return message


def stamp_ns_of(message: TactileSamples) -> int:
    """ROS time at the end of the frame's last measurement [ns].

    Raises
    ------
    PacketError
        When its nanoseconds are more than a second.
    """
    stamp = message.header.stamp
    if stamp.nanosec >= NS_PER_S:
        raise PacketError(f"stamp of {stamp.nanosec} nanoseconds: a second has {NS_PER_S}")
    return ns_of(stamp)


def frame_of(message: TactileSamples) -> SampleFrame:
    """The frame of a message; its stamp becomes `board_us`, and an unknown scheme becomes UNKNOWN."""
    return SampleFrame(
        sequence=int(message.sequence),
        board_us=stamp_ns_of(message) // 1000,
        duration_us=message.duration.sec * _US_PER_S + message.duration.nanosec // 1000,
        scheme=_SCHEMES.get(int(message.scheme), Scheme.UNKNOWN),
        rows=int(message.rows),
        cols=int(message.cols),
        overruns=0,
        indices=np.asarray(message.indices, dtype=np.uint16),
        counts=np.asarray(message.counts, dtype=np.uint16),
    )
