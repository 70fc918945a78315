# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the samples of a frame must be for recovery, and what is said where they are not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.skin import NO_PATCH, Layout
from acts_recon.images.frame_check_kernels import COUNT_OUT_OF_RANGE, INDEX_OUT_OF_RANGE

# Three hundred years, as ROS can stamp: later are nanoseconds or microseconds where seconds are needed.
_LATEST_S = 1e10

LONGEST_PAUSE_S = 0.5
"""After a gap this long between frames nothing of the earlier ones counts on, unless a setting says otherwise."""


def require_rows(indices: NDArray[np.uint16], counts: NDArray[np.uint16]) -> None:
    """Raise `ArrayError` unless these are two rows of uint16, each of any length."""
    # Lists come from callers without types.
    if not (isinstance(indices, np.ndarray) and isinstance(counts, np.ndarray)):
        kinds = f"indices {type(indices).__name__} and counts {type(counts).__name__}"
        raise ArrayError(f"{kinds}: needed are two arrays of numpy, rows of uint16")
    if indices.dtype != np.uint16 or counts.dtype != np.uint16 or indices.ndim != 1 or counts.ndim != 1:
        raise ArrayError(f"indices {_kind(indices)} and counts {_kind(counts)}: needed are two rows of uint16")


def require_samples(indices: NDArray[np.uint16], counts: NDArray[np.uint16]) -> None:
    """Raise `ArrayError` unless these are two rows of uint16, shape (m,), as long as one another and not empty."""
    require_rows(indices, counts)
    if indices.size != counts.size or indices.size == 0:
        raise ArrayError(f"{indices.size} indices and {counts.size} counts: needed are as many, at least one")


def require_image(
    name: str, image: NDArray[np.float32], shape: tuple[int, ...], *, must_be_contiguous: bool = False
) -> None:
    """Raise `ArrayError` unless this is an array of numpy, of this shape and float32.

    Parameters
    ----------
    name : str
        What it is, for the message.
    image : np.ndarray [shape=shape, dtype=float32]
    shape : tuple of int
    must_be_contiguous : bool
        Whether an array is refused that is not C-contiguous.
    """
    # Lists come from callers without types.
    if not isinstance(image, np.ndarray):
        raise ArrayError(f"{name} {type(image).__name__}: needed is an array of numpy of shape {shape}, float32")
    if image.shape != shape or image.dtype != np.float32:
        raise ArrayError(f"{name} {_kind(image)}: needed is {shape}, float32")
    if must_be_contiguous and not image.flags.c_contiguous:
        raise ArrayError(f"{name} {_kind(image)}: needed is a C-contiguous one; take np.ascontiguousarray of it")


def require_times(end_s: float, duration_s: float) -> None:
    """Raise `ArrayError` unless a frame that ended then and took so long [s] can be."""
    # Written so that NaN is refused, too.
    if not (abs(end_s) < _LATEST_S and 0 <= duration_s < _LATEST_S):
        raise ArrayError(
            f"end {end_s} s and duration {duration_s} s: needed are finite times, none negative, below {_LATEST_S:g} s"
        )


def require_recovered(
    shape: tuple[int, int], end_s: float, duration_s: float, **images: NDArray[np.float32] | None
) -> None:
    """Raise `ArrayError` unless a frame can be at these times [s], and its images have this shape and are finite.

    None stands for no image. `age_s` may be infinite, for never, but not below 0.
    """
    require_times(end_s, duration_s)
    for name, given in images.items():
        if given is None:
            continue
        if not isinstance(given, np.ndarray):
            raise ArrayError(f"{name} {type(given).__name__}: needed is an array of numpy of shape {shape}")
        if given.shape != shape:
            raise ArrayError(f"{name} {given.shape}: needed is {shape}")
        # Written so that NaN is refused, too.
        if name == "age_s" and not (given >= 0).all():
            raise ArrayError(
                "age_s with NaN or below 0: needed is how long ago each taxel was measured [s], inf: never"
            )
        if name != "age_s" and not np.isfinite(given).all():
            raise ArrayError(f"{name} with NaN or infinity: needed are finite counts; leave the frame out")


def why_refused(code: int, indices: NDArray[np.uint16], counts: NDArray[np.uint16], rows: int, cols: int) -> str:
    """What is wrong with a frame for a matrix of `rows` x `cols`, by the code of the kernel that refused it."""
    if code == INDEX_OUT_OF_RANGE:
        return f"index {indices.max()}: an array of {rows} x {cols} has 0 to {rows * cols - 1}"
    if code == COUNT_OUT_OF_RANGE:
        return f"count {counts.max()}: the board reads 0 to {COUNT_MAX}"
    values, times = np.unique(indices, return_counts=True)
    return f"index {values[np.argmax(times)]} occurs twice in a frame; each taxel is measured at most once"


def place_table(layout: Layout, geometry: ArrayGeometry) -> NDArray[np.uint16]:
    """Places in the picture by matrix index; an index that is out of range stays so. Shape (65536,), uint16.

    Raises
    ------
    ArrayError
        The picture of the layout is not as large as the geometry.
    """
    if (layout.rows, layout.cols) != (geometry.rows, geometry.cols):
        raise ArrayError(
            f"geometry of {geometry.rows} x {geometry.cols}: the layout {layout.name} is {layout.rows} x {layout.cols}"
        )
    table = np.arange(2**16, dtype=np.uint16)
    table[: layout.places.size] = layout.places
    return table


def skin_table(layout: Layout) -> NDArray[np.uint16] | None:
    """1 for matrix indices with skin, 0 for those without, which count as untouched; None where all have it.

    Shape (65536,), uint16.
    """
    if not (layout.patch_of == NO_PATCH).any():
        return None
    table = np.ones(2**16, dtype=np.uint16)
    table[: layout.places.size] = layout.patch_of_taxel.ravel() != NO_PATCH
    return table


def _kind(array: NDArray) -> str:
    return f"of shape {array.shape}, {array.dtype}"
