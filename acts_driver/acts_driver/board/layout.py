# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Keeps a board's layout of the skin equal to the parameters."""

from __future__ import annotations

from concurrent.futures import Future
from functools import partial

from acts_core.runtime import LogCallback, begin, is_done
from acts_core.sampling import SkinMap
from acts_core.wire import BoardState
from acts_driver.board.dialogue import BoardLink
from acts_driver.board.parameters import BoardParameters


class BoardLayout:
    """Part of a `acts_driver.board.session.BoardSession`.

    Parameters
    ----------
    link : BoardLink
    log : callable
        See `acts_core.runtime.LogCallback`.
    """

    def __init__(self, link: BoardLink, log: LogCallback) -> None:
        self._link = link
        self._log = log
        self._map: SkinMap | None = None
        self._map_of: tuple[str, str, tuple[int, int]] | None = None
        self._reading: Future[SkinMap | None] | None = None
        self._is_told = False
        # Whether the board has, or may have, a layout from here in place of its own.
        self._has_arranged = False

    def begin_anew(self) -> None:
        """Note that the board was replaced or reset."""
        self._is_told = False
        self._has_arranged = False

    def read_again(self) -> None:
        """Note that the file may have changed."""
        self._map_of = None
        self._reading = None

    def bring(self, parameters: BoardParameters, state: BoardState) -> BoardState:
        """Bring the board from a state to the layout that is wanted; its state then.

        Where the layout's file takes long to read, the board stays as it is until a later call.

        Raises
        ------
        BoardError, PortError
            As `BoardLink.query`.
        SettingsError, ArrayError
            When the layout cannot be read, or cannot be the board's.
        """
        name, dead = parameters.layout, parameters.dead_taxels.strip()
        size = state.settings.rows, state.settings.cols
        if not (name or dead):
            return self._give_back(state)
        if self._map_of != (name, dead, size):
            self._map_of, self._reading = (name, dead, size), begin(partial(parameters.skin_map, *size))
        if self._reading is not None:
            if not is_done(self._reading):
                return state
            self._map, self._reading = self._reading.result(), None
        wanted = 0 if self._map is None else self._map.crc32
        if state.map_crc32 is None:
            if wanted and not self._is_told:
                self._is_told = True
                self._log(
                    "warning",
                    f"the board's firmware knows no layouts: {_unknown(name, dead)}; load the firmware of the "
                    "driver's release onto the board",
                )
            return state
        if state.map_crc32 != wanted:
            # Before: it may have it though its last reply is lost.
            self._has_arranged = True
            state = self._link.arrange(self._map).state
            taken = (f"the layout {name}" if name else "", "the dead taxels" if dead else "")
            self._log("info", f"the board has taken {' and '.join(filter(None, taken))}")
        return state

    def _give_back(self, state: BoardState) -> BoardState:
        """Bring the board to its own layout, which is the matrix: a board keeps none over a reset."""
        if self._has_arranged:
            state = self._link.arrange(None).state
            self._has_arranged = False
            self._log("info", "the board has its own layout again")
        return state


def _unknown(name: str, dead_taxels: str) -> str:
    """What follows from that a board knows no layouts."""
    neighbours = f"it looks for neighbours in the matrix, not as {name} has them" if name else ""
    touched = "it may take dead taxels for touched" if dead_taxels else ""
    return ", and ".join(filter(None, (neighbours, touched)))
