# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The samples of a frame, checked and with their places in the picture."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.kernels import as_compiled
from acts_core.skin import Layout
from acts_recon.images.frame_check import place_table, require_samples, skin_table, why_refused
from acts_recon.images.frame_check_kernels import OK, check_frame


class PlacedSamples:
    """Checks frames, and turns indices of the matrix into those of the picture.

    Parameters
    ----------
    geometry : ArrayGeometry
        Of the picture; without a layout that is the matrix itself.
    layout : Layout or None
        Where the taxels of the matrix lie in the picture.

    Raises
    ------
    ArrayError
        When the layout is of another size.
    """

    def __init__(self, geometry: ArrayGeometry, layout: Layout | None) -> None:
        self._matrix_size = (geometry.rows, geometry.cols)
        self._places: NDArray[np.uint16] | None = None
        self._skin: NDArray[np.uint16] | None = None
        if layout is not None:
            self._places = place_table(layout, geometry)
            self._skin = skin_table(layout)
            self._matrix_size = (layout.matrix_rows, layout.matrix_cols)
        self._seen = np.zeros(geometry.size, dtype=np.bool_)

    def of(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], *, may_repeat: bool = False
    ) -> tuple[NDArray[np.uint16], NDArray[np.uint16]]:
        """Places in the picture, and counts there, both as kernels take them; 0 where there is no skin.

        Parameters
        ----------
        indices, counts : np.ndarray [shape=(m,), dtype=uint16]
            Row-major taxel indices of the matrix, and what was measured there.
        may_repeat : bool
            Whether a taxel may be there several times; else that is an error.

        Raises
        ------
        ArrayError
            When the frame does not fit the array or holds impossible values.
        """
        require_samples(indices, counts)
        indices, counts = as_compiled(indices), as_compiled(counts)
        places = indices if self._places is None else self._places[indices]
        code = check_frame(places, counts, self._seen, may_repeat)
        if code != OK:
            raise ArrayError(why_refused(code, indices, counts, *self._matrix_size))
        return places, counts if self._skin is None else counts * self._skin[indices]
