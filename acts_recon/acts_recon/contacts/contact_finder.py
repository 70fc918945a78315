# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The contact in one image after another, without allocation."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.kernels import as_compiled
from acts_core.skin import Response
from acts_recon.contacts import contact_kernels
from acts_recon.contacts.contact import NO_CONTACT, Contact
from acts_recon.contacts.grid import Grid, Thresholds
from acts_recon.images import ERR_TOGETHER, NOISE_COUNTS, Borders, require_image

_UNKNOWN = np.empty(0, dtype=np.float32)


class ContactFinder:
    """Finds the contact in images of one array, see `acts_recon.contacts.contact_kernels.find_contact`.

    Parameters
    ----------
    geometry : ArrayGeometry
        Of the images.
    response : Response
        From counts to newtons.
    touch_counts : float
        A taxel above it is pressed.
    noise_counts : float
        See `acts_recon.images.uncertainty`.
    borders : Borders, optional
        What lies behind one is not beside the contact.

    Raises
    ------
    ArrayError
        When the borders are of a picture of another size.
    """

    def __init__(
        self,
        geometry: ArrayGeometry,
        response: Response,
        touch_counts: float,
        noise_counts: float = NOISE_COUNTS,
        borders: Borders | None = None,
    ) -> None:
        self._shape = (geometry.size,)
        self._grid = Grid.of(geometry, response, borders)
        self._thresholds = Thresholds(float(touch_counts), noise_counts, ERR_TOGETHER)
        self._results = np.zeros(contact_kernels.RESULTS)
        self.find(np.zeros(geometry.size, dtype=np.float32))  # compiles, or loads from the cache

    def find(self, image: NDArray[np.float32], sigma: NDArray[np.float32] | None = None) -> Contact:
        """Describe the contact in an image.

        Parameters
        ----------
        image : np.ndarray [shape=(rows * cols,), dtype=float32]
            Counts, 0 to 1023.
        sigma : np.ndarray [shape=(rows * cols,), dtype=float32], optional
            Standard deviations of the taxels [counts]; without them those of the contact are 0.

        Raises
        ------
        ArrayError
            When image or sigma are of another kind or size.
        """
        require_image("image", image, self._shape)
        if sigma is None:
            sigma = _UNKNOWN
        else:
            require_image("sigma", sigma, self._shape)
        contact_kernels.find_contact(
            as_compiled(image),
            as_compiled(sigma),
            self._grid,
            self._thresholds,
            self._results,
        )
        x_m, y_m, force_n, peak_counts, area_m2, active_taxels, *others = self._results.tolist()
        if not active_taxels:
            return NO_CONTACT
        return Contact(True, x_m, y_m, force_n, peak_counts, area_m2, int(active_taxels), *others)
