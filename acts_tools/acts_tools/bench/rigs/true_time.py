# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The true time of measurement of a virtual board's frames, in the host's real time."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from acts_core.errors import PacketError
from acts_core.frames import SampleFrame


class TrueTime:
    """Converts the number of a frame to the true time of its last measurement.

    The virtual board reports the monotonic time of the host at the start of its clock, and its frames are evenly
    spaced. Stamps are in the host's real time, which may be slewed; each call of `observe_host` compares it with the
    monotonic time.

    Parameters
    ----------
    frames : sequence of SampleFrame
        Some frames of this run of the board; an even spacing of them is required.
    period_us : int
        Time between frames on the board's clock [us].
    epoch_monotonic_ns : int
        The host's monotonic time at board time 0 [ns].
    drift_ppm : float
        Relative speed of the board's clock to the host's, minus 1 [ppm].

    Raises
    ------
    PacketError
        When the frames are not evenly spaced.
    """

    def __init__(
        self, frames: Sequence[SampleFrame], period_us: int, epoch_monotonic_ns: int, drift_ppm: float
    ) -> None:
        phases = {frame.board_us - frame.sequence * period_us for frame in frames}
        if len(phases) != 1:
            raise PacketError(f"the board's frames are not {period_us} us apart; their phases are {sorted(phases)[:5]}")
        self._phase_us = phases.pop()
        self._period_us = period_us
        self._epoch_ns = epoch_monotonic_ns
        self._board_per_host = 1.0 + drift_ppm * 1e-6
        self._host: list[tuple[int, int]] = []
        self.observe_host()

    def observe_host(self) -> None:
        """Compare the host's two clocks; to be called at the beginning and the end of the measurement."""
        before, real, after = time.monotonic_ns(), time.time_ns(), time.monotonic_ns()
        monotonic = (before + after) // 2
        self._host.append((monotonic, real - monotonic))

    def at(self, sequence: ArrayLike) -> NDArray[np.int64]:
        """Real time at the end of the frames' last measurement.

        Parameters
        ----------
        sequence : array_like [shape=(n,), dtype=int]
            Frame numbers without wrap-around.

        Returns
        -------
        np.ndarray [shape=(n,), dtype=int64]
            Nanoseconds since the epoch, as `time.time_ns` counts them.
        """
        board_us = np.asarray(sequence, dtype=np.int64) * self._period_us + self._phase_us
        monotonic = self._epoch_ns + np.rint(board_us * 1000 / self._board_per_host).astype(np.int64)
        begin, origin = self._host[0]
        since = [float(time_ns - begin) for time_ns, _ in self._host]
        changes = [float(offset_ns - origin) for _, offset_ns in self._host]
        # Relative to the first, to keep the precision of doubles in the interpolation.
        change = np.interp((monotonic - begin).astype(np.float64), since, changes)
        return np.asarray(monotonic + origin + np.rint(change).astype(np.int64), dtype=np.int64)
