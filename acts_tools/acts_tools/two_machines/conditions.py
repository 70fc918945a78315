"""What the cable does to frames, and what it has counted."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Conditions:
    """State of the cable, the same in both directions.

    Attributes
    ----------
    delay_s : float
        From one end to the other [s].
    loss : float
        Share of the frames that get lost, 0 to 1.
    cut : bool
        Whether nothing passes.
    """

    delay_s: float = 0.0
    loss: float = 0.0
    cut: bool = False


@dataclass
class Traffic:
    """Ethernet frames that entered one end of the cable since it was laid.

    Attributes
    ----------
    frames, sent_bytes : int
        All of them, header included, as an interface counts them.
    dropped : int
        Those that did not come out at the other end.
    """

    frames: int = 0
    sent_bytes: int = 0
    dropped: int = 0
