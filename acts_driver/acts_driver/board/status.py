# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is known of a board."""

from __future__ import annotations

from dataclasses import dataclass, replace

from acts_core.wire import BoardState


@dataclass(frozen=True)
class BoardStatus:
    """What is known of the board.

    Attributes
    ----------
    state : BoardState or None
        What it said last; None before its first answer and when it has stopped answering.
    is_wrong_version : bool
        Whether its firmware is of another version, so that nothing it sends is to be used.
    problem : str
        Why it is not as the parameters want it, for a person; empty where it is.
    is_silent : bool
        Whether it was asked and did not answer.
    """

    state: BoardState | None = None
    is_wrong_version: bool = False
    problem: str = ""
    is_silent: bool = False

    @property
    def lasting(self) -> BoardStatus:
        """Of this, what is no time or counter: 0 in their places."""
        if self.state is None:
            return self
        return replace(self, state=replace(self.state, uptime_us=0, overruns=0, bad_commands=0))
