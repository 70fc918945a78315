# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames of some seconds, kept for judging."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.frames import SampleFrame


class FrameRecord:
    """Keeps frames and when they arrived.

    Parameters
    ----------
    rows, cols : int
        Size of the array; frames of another size must not be added.
    """

    def __init__(self, rows: int, cols: int) -> None:
        self.rows = rows
        self.cols = cols
        self.frames: list[SampleFrame] = []
        self.arrivals_ns: list[int] = []

    def add(self, frame: SampleFrame, arrival_ns: int) -> None:
        """Keep a frame that was read at a time of the host's clock [ns]."""
        self.frames.append(frame)
        self.arrivals_ns.append(arrival_ns)

    def readings(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """All readings in order of taxels: where those of each taxel begin, and their counts.

        Returns
        -------
        start : np.ndarray [shape=(rows * cols + 1,), dtype=int64]
        counts : np.ndarray [shape=(n_readings,), dtype=float64]
        """
        size = self.rows * self.cols
        if not self.frames:
            return np.zeros(size + 1, dtype=np.int64), np.empty(0)
        indices = np.concatenate([frame.indices for frame in self.frames])
        counts = np.concatenate([frame.counts for frame in self.frames]).astype(np.float64)
        order = np.argsort(indices, kind="stable")
        return np.searchsorted(indices[order], np.arange(size + 1)), counts[order]

    def sweeps(self) -> NDArray[np.float32]:
        """Whole pictures, one after another, each from the frames in which every taxel was measured.

        A full frame is a picture. Of smaller ones as many make a picture as it takes until all taxels that are measured
        at all were measured again; of several readings the last counts.

        Returns
        -------
        np.ndarray [shape=(n, rows, cols), dtype=float32]
            Counts; NaN where a taxel was never measured.
        """
        size = self.rows * self.cols
        measured = np.zeros(size, dtype=bool)
        for frame in self.frames:
            measured[frame.indices] = True
        missing = measured.copy()
        picture = np.full(size, np.nan, dtype=np.float32)
        pictures = []
        for frame in self.frames:
            picture[frame.indices] = frame.counts
            missing[frame.indices] = False
            if not missing.any():
                pictures.append(picture.copy())
                missing = measured.copy()
        return np.array(pictures, dtype=np.float32).reshape(-1, self.rows, self.cols)
