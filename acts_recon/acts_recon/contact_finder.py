"""The contact in one image after another, without allocation."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.force import ForceResponse, MeasuredForceResponse, force_table
from acts_recon import contact_kernels
from acts_recon.contact import NO_CONTACT, Contact


class ContactFinder:
    """Finds the contact in images of one array, as `acts_recon.contact.find_contact` does.

    Parameters
    ----------
    geometry : ArrayGeometry
        Of the images.
    response : ForceResponse or MeasuredForceResponse
        From counts to newtons.
    touch_counts : float
        A taxel above it is pressed.
    """

    def __init__(
        self, geometry: ArrayGeometry, response: ForceResponse | MeasuredForceResponse, touch_counts: float
    ) -> None:
        self._geometry = geometry
        self._touch_counts = touch_counts
        self._force_n = force_table(response)
        self._results = np.zeros(contact_kernels.RESULTS)
        self.find(np.zeros(geometry.size, dtype=np.float32))  # compiles, or loads from the cache

    def find(self, image: NDArray[np.float32]) -> Contact:
        """Describe the contact in an image.

        Parameters
        ----------
        image : np.ndarray [shape=(rows * cols,), dtype=float32]
            Counts, 0 to 1023.
        """
        geometry, results = self._geometry, self._results
        contact_kernels.find_contact(image, geometry.cols, self._touch_counts, self._force_n, results)
        col, row, force_n, peak, pressed, col_square, row_square = results.tolist()
        if pressed == 0:
            return NO_CONTACT
        x_pitch_m, y_pitch_m = geometry.pitch_m, geometry.pitch_y_m
        return Contact(
            in_contact=True,
            x_m=(col - (geometry.cols - 1) / 2) * x_pitch_m,
            y_m=((geometry.rows - 1) / 2 - row) * y_pitch_m,
            force_n=force_n,
            peak_counts=peak,
            area_m2=pressed * x_pitch_m * y_pitch_m,
            active_taxels=int(pressed),
            spread_m=(col_square * x_pitch_m**2 + row_square * y_pitch_m**2) ** 0.5,
        )
