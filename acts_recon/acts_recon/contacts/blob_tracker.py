# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Contacts with numbers, frame after frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.kernels import as_compiled
from acts_core.skin import ForceResponse, Response, TrackedBlob
from acts_recon.contacts import blob_kernels, blob_track_kernels
from acts_recon.contacts.blob_config import BlobConfig
from acts_recon.contacts.blob_tracks import FREE, NONE
from acts_recon.contacts.grid import Grid, Thresholds
from acts_recon.images import Borders, require_image, require_times

_LONGEST_PAUSE_S = 1.0
_UNKNOWN = np.empty(0, dtype=np.float32)


class BlobTracker:
    """Finds the contacts in image after image, without allocation, and keeps their numbers.

    Parameters
    ----------
    geometry : ArrayGeometry
        Of the image.
    response : Response, optional
        From counts to newtons.
    config : BlobConfig, optional
    borders : Borders, optional
        No contact reaches over one, or goes from one side to the other.

    Raises
    ------
    ArrayError
        When the borders are of a picture of another size.
    """

    def __init__(
        self,
        geometry: ArrayGeometry,
        response: Response | None = None,
        config: BlobConfig | None = None,
        borders: Borders | None = None,
    ) -> None:
        self.geometry = geometry
        self.config = config or BlobConfig()
        self.dropped = 0
        """Contacts of the last frame that were left out because there were more than `MAX_BLOBS`: the weakest."""
        config = self.config
        self._grid = Grid.of(geometry, response or ForceResponse(), borders)
        self._thresholds = Thresholds(float(config.touch_counts), config.noise_counts, config.err_together)
        self._work = blob_kernels.Work.empty(geometry.size)
        self._memory = blob_track_kernels.Memory.empty(geometry.size)
        self._time_s: float | None = None
        self._warm_up()

    def step(
        self, image: NDArray[np.float32], time_s: float, sigma: NDArray[np.float32] | None = None
    ) -> tuple[TrackedBlob, ...]:
        """Find the contacts of the next frame.

        Parameters
        ----------
        image : np.ndarray [shape=(rows, cols), dtype=float32]
            Counts; C-contiguous.
        time_s : float
            Of the frame. Where it goes back, or on by more than a second, all contacts are new.
        sigma : np.ndarray [shape=(rows, cols), dtype=float32], optional
            Standard deviation of each taxel [counts]; C-contiguous. Without it standard deviations are 0.

        Returns
        -------
        tuple of TrackedBlob
            The oldest first; at most `MAX_BLOBS`.

        Raises
        ------
        ArrayError
            When image or sigma are of another kind or size, or the time is not finite. Everything is left as it was.
        """
        require_times(time_s, 0.0)
        time_s = float(time_s)
        flat = self._flat(image, "image")
        deviations = _UNKNOWN if sigma is None else self._flat(sigma, "sigma")
        dt_s = 0.0 if self._time_s is None else time_s - self._time_s
        if not 0.0 <= dt_s <= _LONGEST_PAUSE_S:
            self.reset()
            dt_s = 0.0
        self._time_s = time_s
        config, work = self.config, self._work
        n, self.dropped = blob_kernels.find_blobs(
            flat, deviations, self._grid, self._thresholds, float(config.release_counts), work
        )
        blob_track_kernels.follow(
            time_s,
            dt_s,
            n,
            work.blobs,
            work.members,
            self._grid.pitch_m,
            self._grid.pitch_y_m,
            sigma is not None,
            config.bridge_s,
            config.memory_s,
            self._memory,
        )
        return tuple(map(TrackedBlob._make, self._memory.found[:n].tolist()))

    def reset(self) -> None:
        """Forget all contacts; numbers go on."""
        self._work.state[:] = 0
        self._memory.tracks["state"] = FREE
        self._memory.owner[:] = NONE

    def _flat(self, image: NDArray[np.float32], name: str) -> NDArray[np.float32]:
        shape = (self.geometry.rows, self.geometry.cols)
        require_image(name, image, shape, must_be_contiguous=True)
        return as_compiled(image).reshape(-1)

    def _warm_up(self) -> None:
        """Compile, or load from the cache, what the first frame would otherwise wait seconds for."""
        image = np.zeros((self.geometry.rows, self.geometry.cols), dtype=np.float32)
        self.step(image, 0.0, image)
        self._time_s = None
