# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Conditions of the cable, and its counts."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Conditions:
    """Conditions of the cable, the same in both directions.

    Attributes
    ----------
    delay_s : float
        Delay from one end to the other [s].
    loss : float
        Share of frames that are lost, 0 to 1.
    cut : bool
        Whether all frames are lost.
    """

    delay_s: float = 0.0
    loss: float = 0.0
    cut: bool = False


@dataclass
class Traffic:
    """Counts of Ethernet frames that entered one end of the cable since its start.

    Attributes
    ----------
    frames, sent_bytes : int
        All frames, and their bytes with headers, as an interface counts them.
    dropped : int
        Frames that did not reach the other end.
    """

    frames: int = 0
    sent_bytes: int = 0
    dropped: int = 0
