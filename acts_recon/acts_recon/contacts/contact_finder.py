# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The contact in one image after another, without allocation."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.skin import ForceResponse, MeasuredForceResponse, force_table
from acts_recon.contacts import contact_kernels
from acts_recon.contacts.contact import NO_CONTACT, Contact
from acts_recon.images import ERR_TOGETHER, NOISE_COUNTS, Borders, borders_of, root_deviation, slope_table

_UNKNOWN = np.empty(0, dtype=np.float32)


class ContactFinder:
    """Finds the contact in images of one array, as `acts_recon.contacts.contact.find_contact` does.

    Parameters
    ----------
    geometry : ArrayGeometry
        Of the images.
    response : ForceResponse or MeasuredForceResponse
        From counts to newtons.
    touch_counts : float
        A taxel above it is pressed.
    noise_counts, err_together : float
        See `acts_recon.images.uncertainty`.
    borders : Borders, optional
        What lies behind one is not beside the contact.
    """

    def __init__(
        self,
        geometry: ArrayGeometry,
        response: ForceResponse | MeasuredForceResponse,
        touch_counts: float,
        noise_counts: float = NOISE_COUNTS,
        err_together: float = ERR_TOGETHER,
        borders: Borders | None = None,
    ) -> None:
        self._bounds = (borders or borders_of(geometry.rows, geometry.cols)).bounds()
        self._cols = geometry.cols
        self._pitches_m = geometry.pitch_m, geometry.pitch_y_m
        self._taxel_area_m2 = geometry.taxel_area_m2
        self._thresholds = touch_counts, noise_counts, err_together
        force_n = force_table(response)
        self._tables = force_n, slope_table(force_n)
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
        """
        results, taxel_area_m2 = self._results, self._taxel_area_m2
        contact_kernels.find_contact(
            image,
            _UNKNOWN if sigma is None else sigma,
            self._bounds,
            self._cols,
            *self._thresholds,
            *self._tables,
            *self._pitches_m,
            results,
        )
        x_m, y_m, force_n, peak, pressed, spread_square, *variances = results.tolist()
        if pressed == 0:
            return NO_CONTACT
        x_var, y_var, force_var, taxels_var, spread_square_var = variances
        return Contact(
            in_contact=True,
            x_m=x_m,
            y_m=y_m,
            force_n=force_n,
            peak_counts=peak,
            area_m2=pressed * taxel_area_m2,
            active_taxels=int(pressed),
            spread_m=spread_square**0.5,
            x_sd_m=x_var**0.5,
            y_sd_m=y_var**0.5,
            force_sd_n=force_var**0.5,
            area_sd_m2=taxels_var**0.5 * taxel_area_m2,
            spread_sd_m=root_deviation(spread_square, spread_square_var),
        )
