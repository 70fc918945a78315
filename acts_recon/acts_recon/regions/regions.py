# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The contact on every patch of a skin, image after image."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from acts_core.array import TOUCH_COUNTS
from acts_core.kernels import as_compiled
from acts_core.skin import Layout, RegionContact, Response, SkinPatch, Vector, force_table
from acts_recon.images import NOISE_COUNTS, DeadTaxels, require_image, require_recovered
from acts_recon.regions import region_kernels as kernels
from acts_recon.regions.sharpness import Sharpness, SharpnessConfig
from acts_recon.slip import NO_SLIP, SMALLEST_SIDE, Slip, SlipConfig, SlipWatch

# Of a slip rate, so that a time that is a little early counts as due.
_EARLY = 0.9


class Regions:
    """Finds the contact on each patch of a layout, how it moves, and whether it slips.

    Motion and slip of patches of fewer than 3 x 3 taxels stay 0. A patch of which all taxels are dead is left out.

    Parameters
    ----------
    layout : Layout
    response : Response
        From counts to newtons.
    touch_counts : float
        A taxel above it is pressed.
    noise_counts : float
        Standard deviation of a measurement [counts].
    slip : SlipConfig, optional
    slip_rate_hz : float
        Motion and slip are looked for so often at most [Hz]; 0: in every image. Images half a second apart are not
        compared, so below 2 Hz nothing is found.
    sharpness : SharpnessConfig, optional
    dead : DeadTaxels, optional
        Those of the image: see `SlipWatch`.

    Raises
    ------
    ArrayError
        For noise that is not above 0, or dead taxels of another image.
    """

    def __init__(
        self,
        layout: Layout,
        response: Response,
        touch_counts: float = TOUCH_COUNTS,
        noise_counts: float = NOISE_COUNTS,
        slip: SlipConfig | None = None,
        slip_rate_hz: float = 250.0,
        sharpness: SharpnessConfig | None = None,
        dead: DeadTaxels | None = None,
    ) -> None:
        if dead is not None:
            dead.require_shape(layout.rows, layout.cols)
        patches = layout.patches if dead is None else _with_live_taxels(layout.patches, dead)
        self._shape = (layout.rows, layout.cols)
        self._sigmas = (SlipConfig() if slip is None else slip).slip_sigmas
        self._untouched = [RegionContact(patch.name, patch.link) for patch in patches]
        self._regions = list(self._untouched)
        self._bounds = np.array([patch.bounds for patch in patches], dtype=np.int64).reshape(-1, 4)
        self._points_m = np.zeros((*self._shape, 3))
        self._normals = np.zeros((*self._shape, 3))
        for patch in patches:
            patch.of(self._points_m)[:], patch.of(self._normals)[:] = patch.points_m(), patch.normals()
        self._areas_m2 = np.array([patch.geometry.taxel_area_m2 for patch in patches])
        self._touch_counts = float(touch_counts)
        self._force_n = force_table(response)
        self._sharpness = Sharpness(
            patches, self._force_n, self._touch_counts, noise_counts, sharpness or SharpnessConfig(), dead
        )
        self._results = np.zeros((len(patches), kernels.RESULTS))
        watched = [p for p, patch in enumerate(patches) if min(patch.rows, patch.cols) >= SMALLEST_SIDE]
        self._watched = np.array(watched, dtype=np.intp)
        self._slips = [NO_SLIP] * len(patches)
        self._watch = SlipWatch(
            *self._shape, [patches[p] for p in watched], slip, noise_counts, pressed_counts=touch_counts, dead=dead
        )
        self._slip_period_s = _EARLY / slip_rate_hz if slip_rate_hz else 0.0
        self._slip_s = -math.inf
        # Compiles, or loads from the cache.
        self._sharpness.of(np.zeros(self._shape, dtype=np.float32))
        self.step(0.0, np.zeros(self._shape, dtype=np.float32))
        self.reset()

    def reset(self) -> None:
        """Start anew, for instance after a pause."""
        self._watch.reset()
        self._slips = [NO_SLIP] * len(self._slips)
        self._slip_s = -math.inf

    def step(
        self,
        time_s: float,
        image: NDArray[np.float32],
        measured: NDArray[np.float32] | None = None,
        age_s: NDArray[np.float32] | None = None,
    ) -> list[RegionContact]:
        """Describe the patches in an image.

        Parameters
        ----------
        time_s : float
            Of the image; where it goes back, slip begins anew [s].
        image : np.ndarray [shape=(rows, cols), dtype=float32]
            Counts, 0 to 1023.
        measured, age_s : np.ndarray [shape=(rows, cols), dtype=float32], optional
            Where the image is made of more than one frame: the last measurement of every taxel [counts], and how long
            ago that was [s], inf: never. Without them all of the image was measured now.

        Returns
        -------
        list of RegionContact
            Of every patch that can feel, in the layout's order; overwritten by the next call, but not its entries.

        Raises
        ------
        ArrayError
            When an image has another shape or type, or it or the time is not finite.
        """
        require_image("image", image, self._shape)
        require_recovered(self._shape, time_s, 0.0, image=image)
        image = as_compiled(image)
        results, regions = self._results, self._regions
        touched = kernels.find_regions(
            image,
            self._bounds,
            self._points_m,
            self._normals,
            self._areas_m2,
            self._touch_counts,
            self._force_n,
            results,
        )
        if not self._slip_s <= time_s < self._slip_s + self._slip_period_s:
            self._look_for_slip(time_s, image if measured is None else measured, age_s)
        if not touched:
            regions[:] = self._untouched
            return regions
        sharpness = self._sharpness.of(image).tolist()
        for p, numbers in enumerate(results.tolist()):
            pressed = numbers[kernels.PRESSED]
            regions[p] = self._region(p, numbers, sharpness[p]) if pressed else self._untouched[p]
        return regions

    def _look_for_slip(self, time_s: float, values: NDArray[np.float32], age_s: NDArray[np.float32] | None) -> None:
        found = self._watch.step(time_s, values, self._results[self._watched, kernels.COUNTS], age_s)
        self._slip_s = time_s
        for p, slip in zip(self._watched.tolist(), found, strict=True):
            self._slips[p] = slip

    def _region(self, patch: int, numbers: list[float], sharpness: float) -> RegionContact:
        pressed, force_n, x, y, z, nx, ny, nz, area_m2, peak_n, spread_m, share, _, *steps_m = numbers
        slip = self._slips[patch]
        return RegionContact(
            *self._untouched[patch][:2],
            int(pressed),
            force_n,
            (x, y, z),
            (nx, ny, nz),
            area_m2,
            peak_n,
            spread_m,
            share,
            sharpness,
            self._velocity(slip, steps_m[:3], steps_m[3:]),
            slip.distance_m,
            slip.slipping,
        )

    def _velocity(self, slip: Slip, col_m: list[float], row_m: list[float]) -> Vector:
        """Along the skin in the link's frame [m/s]; given are steps of one taxel along the columns and the rows."""
        motion = slip.motion
        # Written so that it holds for no NaN, which counts beyond all that a board sends lead to.
        if motion is None or not motion.distance_taxels >= self._sigmas * motion.sd_taxels:
            return 0.0, 0.0, 0.0
        cols, rows = motion.cols / slip.elapsed_s, motion.rows / slip.elapsed_s
        return (
            cols * col_m[0] + rows * row_m[0],
            cols * col_m[1] + rows * row_m[1],
            cols * col_m[2] + rows * row_m[2],
        )


def _with_live_taxels(patches: Sequence[SkinPatch], dead: DeadTaxels) -> tuple[SkinPatch, ...]:
    return tuple(patch for patch in patches if not patch.of(dead.in_picture).all())
