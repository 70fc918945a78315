"""FastOMP in numba: the same as `acts_recon.fastomp`, in single precision and without allocation.

Nearly all of the time goes into the correlation of the residual with every atom. The dictionary is therefore kept with
a pixel's values for a block of atoms side by side (`in_blocks`), for `acts_recon.fastomp_vectors`.
"""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

from acts_recon.fastomp import REGULARISATION
from acts_recon.fastomp_vectors import BLOCK, LANES, best_column, dot, padded, subtract

OK = 0
INDEX_OUT_OF_RANGE = 1
INDEX_TWICE = 2
COUNT_OUT_OF_RANGE = 3

_CACHE_LINE_BYTES = 64
_REGULARISATION = np.float32(REGULARISATION)
_OPTIONS = {"cache": True, "nogil": True, "fastmath": {"nnan", "ninf", "nsz", "contract", "reassoc", "arcp"}}


@numba.njit(**_OPTIONS)  # type: ignore[untyped-decorator]
def pursue(
    blocks: NDArray[np.float32],
    atoms: NDArray[np.float32],
    pixels: NDArray[np.int64],
    y: NDArray[np.float32],
    m: int,
    n_atoms: int,
    residual: NDArray[np.float32],
    Q: NDArray[np.float32],
    R: NDArray[np.float32],
    chosen: NDArray[np.int64],
    coefficients: NDArray[np.float32],
) -> int:
    """`acts_recon.fastomp.fast_omp` on the measured `pixels` of a patch; returns the number of chosen atoms.

    `y`, `residual` and the rows of `Q` must be as long as `padded` of the most pixels. `pixels` and `y` are reordered.
    """
    # Pixels that read 0 add nothing to the first correlations: they go to the end, and the first round leaves them out.
    relevant = 0
    for p in range(m):
        if y[p] != 0:
            y[p], y[relevant] = y[relevant], y[p]
            pixels[p], pixels[relevant] = pixels[relevant], pixels[p]
            relevant += 1
    n = (m + LANES - 1) // LANES * LANES
    for p in range(n):
        residual[p] = y[p] if p < m else np.float32(0.0)
    s = 0
    for i in range(n_atoms):
        atom = best_column(blocks, pixels, residual, relevant if i == 0 else m)
        if atom < 0:
            break
        chosen[i] = atom
        for p in range(m):
            Q[i, p] = atoms[atom, pixels[p]]
        for p in range(m, n):
            Q[i, p] = 0.0
        for j in range(i):
            R[j, i] = dot(Q, j, Q, i, n)
            subtract(Q, i, R[j, i] / R[j, j], Q, j, n)
        R[i, i] = dot(Q, i, Q, i, n) + _REGULARISATION
        subtract(residual, 0, dot(Q, i, residual, 0, n) / R[i, i], Q, i, n)
        s += 1
    for i in range(s - 1, -1, -1):
        value = dot(Q, i, y, 0, n)
        for j in range(i + 1, s):
            value -= R[i, j] * coefficients[j]
        coefficients[i] = value / R[i, i]
    return s


@numba.njit(**_OPTIONS)  # type: ignore[untyped-decorator]
def recover_image(
    blocks: NDArray[np.float32],
    atoms: NDArray[np.float32],
    taxels: NDArray[np.int32],
    overlap: NDArray[np.float32],
    entry_start: NDArray[np.int32],
    entry_patch: NDArray[np.int32],
    entry_pixel: NDArray[np.int32],
    indices: NDArray[np.uint16],
    counts: NDArray[np.uint16],
    touch_counts: int,
    count_max: int,
    ratio: float,
    keep_measured: bool,
    seen: NDArray[np.bool_],
    measured_pixels: NDArray[np.int64],
    measured_values: NDArray[np.float32],
    n_measured: NDArray[np.int32],
    pressed: NDArray[np.bool_],
    residual: NDArray[np.float32],
    Q: NDArray[np.float32],
    R: NDArray[np.float32],
    chosen: NDArray[np.int64],
    coefficients: NDArray[np.float32],
    image: NDArray[np.float32],
) -> int:
    """Check one frame and recover its image into `image`.

    `blocks` is the dictionary as `in_blocks` lays it out, `atoms` the same with an atom a row, then come the arrays of
    `PatchLayout`, the frame, the settings, and the buffers of `Workspace`. `image` is flat.
    Values are clipped to 0 to `count_max`. Returns a code; unless it is `OK` the image is left as it was.
    """
    size = image.shape[0]
    m = indices.shape[0]
    code = OK
    checked = 0
    for i in range(m):
        if indices[i] >= size:
            code = INDEX_OUT_OF_RANGE
        elif counts[i] > count_max:
            code = COUNT_OUT_OF_RANGE
        elif seen[indices[i]]:
            code = INDEX_TWICE
        if code != OK:
            break
        seen[indices[i]] = True
        checked += 1
    for i in range(checked):
        seen[indices[i]] = False
    if code != OK:
        return code

    n_patches, n_pixels = taxels.shape
    for patch in range(n_patches):
        n_measured[patch] = 0
        pressed[patch] = False
    for i in range(m):
        value = np.float32(counts[i]) if counts[i] > touch_counts else np.float32(0.0)
        for entry in range(entry_start[indices[i]], entry_start[indices[i] + 1]):
            patch = entry_patch[entry]
            n = n_measured[patch]
            measured_pixels[patch, n] = entry_pixel[entry]
            measured_values[patch, n] = value
            n_measured[patch] = n + 1
            if value > 0:
                pressed[patch] = True

    for t in range(size):
        image[t] = 0.0
    for patch in range(n_patches):
        if not pressed[patch]:
            continue
        n = n_measured[patch]
        pixels = measured_pixels[patch]
        y = measured_values[patch]
        n_atoms = max(1, int(ratio * n + 0.5))
        s = pursue(blocks, atoms, pixels, y, n, n_atoms, residual, Q, R, chosen, coefficients)
        for p in range(n_pixels):
            residual[p] = 0.0
        for j in range(s):
            coefficient = coefficients[j]
            for p in range(n_pixels):
                residual[p] += coefficient * atoms[chosen[j], p]
        for p in range(n_pixels):
            image[taxels[patch, p]] += residual[p]
    top = np.float32(count_max)
    for t in range(size):
        image[t] = min(max(image[t] / overlap[t], np.float32(0.0)), top)
    if keep_measured:
        for i in range(m):
            image[indices[i]] = np.float32(counts[i]) if counts[i] > touch_counts else np.float32(0.0)
    return OK


def in_blocks(atoms: NDArray[np.floating]) -> NDArray[np.float32]:
    """Lay a dictionary out for `recover_image`.

    Parameters
    ----------
    atoms : np.ndarray [shape=(n_pixels, n_atoms), dtype=float]

    Returns
    -------
    np.ndarray [shape=(n_blocks, n_pixels, BLOCK), dtype=float32]
        Filled up with atoms of zeros, which are never chosen.
    """
    n_pixels, n_atoms = atoms.shape
    n_blocks = -(-n_atoms // BLOCK)
    padded = np.zeros((n_pixels, n_blocks * BLOCK), dtype=np.float32)
    padded[:, :n_atoms] = atoms
    blocks = _aligned(n_blocks, n_pixels, BLOCK)
    blocks[:] = padded.reshape(n_pixels, n_blocks, BLOCK).transpose(1, 0, 2)
    return blocks


def _aligned(*shape: int) -> NDArray[np.float32]:
    """Zeros that begin where a line of the cache does: vectors that straddle two lines take half as long again."""
    buffer = np.zeros(4 * math.prod(shape) + _CACHE_LINE_BYTES, dtype=np.uint8)
    skip = -buffer.ctypes.data % _CACHE_LINE_BYTES
    return buffer[skip : skip + 4 * math.prod(shape)].view(np.float32).reshape(shape)


class Workspace:
    """The buffers that `recover_image` works in, allocated once.

    Parameters
    ----------
    n_taxels, n_patches, n_pixels : int
        Sizes of the array, of the layout and of a patch.
    """

    def __init__(self, n_taxels: int, n_patches: int, n_pixels: int) -> None:
        def floats(*shape: int) -> NDArray[np.float32]:
            return np.zeros(shape, dtype=np.float32)

        self.seen = np.zeros(n_taxels, dtype=np.bool_)
        self.measured_pixels = np.zeros((n_patches, n_pixels), dtype=np.int64)
        width = padded(n_pixels)
        self.measured_values = floats(n_patches, width)
        self.n_measured = np.zeros(n_patches, dtype=np.int32)
        self.pressed = np.zeros(n_patches, dtype=np.bool_)
        self.residual = floats(width)
        self.Q = floats(n_pixels, width)
        self.R = floats(n_pixels, n_pixels)
        self.chosen = np.zeros(n_pixels, dtype=np.int64)
        self.coefficients = floats(n_pixels)

    def arrays(self) -> tuple[NDArray, ...]:
        """The buffers in the order in which `recover_image` takes them."""
        return (
            self.seen,
            self.measured_pixels,
            self.measured_values,
            self.n_measured,
            self.pressed,
            self.residual,
            self.Q,
            self.R,
            self.chosen,
            self.coefficients,
        )
