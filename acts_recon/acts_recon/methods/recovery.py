# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""From samples to image and contact, by any of the methods."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_recon.contacts import Contact, ContactFinder
from acts_recon.images import DeadTaxels, borders_of, require_image
from acts_recon.methods.method import Method, SkinSetup


class Recovery:
    """Recovers frame after frame, and finds the contact in the image.

    Parameters
    ----------
    method : Method
        Made for the same skin.
    skin : SkinSetup

    Attributes
    ----------
    method : Method
    skin : SkinSetup
    geometry : ArrayGeometry
        Of the image.
    borders : Borders
        Likewise.
    response : Response
        From counts to newtons.
    dead : DeadTaxels or None
        Those of the skin: `image` and `sigma` hold what the taxels around say of them.
    image, sigma, age_s, measured
        See `Method`.

    Raises
    ------
    ArrayError
        When an image of the method is of another kind or size than `Method` says, or the dead taxels of another matrix.
    """

    def __init__(self, method: Method, skin: SkinSetup) -> None:
        for name in ("image", "sigma", "age_s", "measured"):
            image = getattr(method, name)
            if image is not None or name == "image":
                # Kept as flat views: of other images these would be copies, which no frame changes.
                shape = (skin.geometry.rows, skin.geometry.cols)
                require_image(f"{type(method).__name__}.{name}", image, shape, must_be_contiguous=True)
        self.method = method
        self.skin = skin
        self.geometry = skin.geometry
        self.borders = borders_of(skin.geometry.rows, skin.geometry.cols, skin.layout)
        self.response = skin.response
        self.dead = None if skin.dead_taxels is None else DeadTaxels(skin.dead_taxels, skin.geometry, skin.layout)
        self.image = method.image
        self.sigma = method.sigma
        self.age_s = method.age_s
        self.measured = method.measured
        self._flat = method.image.ravel(), None if method.sigma is None else method.sigma.ravel()
        self._finder = ContactFinder(
            skin.geometry, skin.response, float(skin.touch_counts), skin.assumed_noise_counts, borders=self.borders
        )

    def reset(self) -> None:
        """See `Method.reset`."""
        self.method.reset()

    def step(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float) -> Contact:
        """Recover one frame, of live taxels alone, and find the contact in it; see `Method.step`."""
        self.method.step(indices, counts, end_s, duration_s)
        if self.dead is not None:
            self.dead.fill(self.image, self.sigma)
        return self._finder.find(*self._flat)

    def set_noise(self, noise_counts: NDArray[np.float32], valid: NDArray[np.bool_]) -> None:
        """See `Method.set_noise`."""
        self.method.set_noise(noise_counts, valid)

    def confidence(self) -> NDArray[np.uint8] | None:
        """See `Method.confidence`."""
        return self.method.confidence()
