"""FastOMP in numba: the same as `acts_recon.fastomp`, in single precision and without allocation.

Nearly all of the time goes into the correlation of the residual with every atom. The dictionary is therefore kept with
a pixel's values for a block of atoms side by side (`in_blocks`), and the correlations of a block are summed over four
measured pixels at a time, which the compiler turns into wide multiply-adds on data that stay in the first cache.
"""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from acts_recon.fastomp import REGULARISATION

OK = 0
INDEX_OUT_OF_RANGE = 1
INDEX_TWICE = 2
COUNT_OUT_OF_RANGE = 3

BLOCK = 64
"""Atoms whose correlations are computed together: their 64 pixels fill half of a usual first cache."""

_REGULARISATION = np.float32(REGULARISATION)
_OPTIONS = {"cache": True, "nogil": True, "fastmath": {"nnan", "ninf", "nsz", "contract", "reassoc", "arcp"}}


@numba.njit(**_OPTIONS)  # type: ignore[untyped-decorator]
def _best_atom(
    blocks: NDArray[np.float32],
    pixels: NDArray[np.int64],
    residual: NDArray[np.float32],
    m: int,
    sums: NDArray[np.float32],
) -> int:
    """Return the atom whose correlation with the residual is largest in magnitude, -1 when all are 0."""
    best = np.float32(0.0)
    best_atom = -1
    for b in range(blocks.shape[0]):
        block = blocks[b]
        for k in range(BLOCK):
            sums[k] = np.float32(0.0)
        i = 0
        while i + 4 <= m:
            # Rows of constant length: without them the compiler sees possible negative indices and stays scalar.
            a0, a1, a2, a3 = block[pixels[i]], block[pixels[i + 1]], block[pixels[i + 2]], block[pixels[i + 3]]
            r0, r1, r2, r3 = residual[i], residual[i + 1], residual[i + 2], residual[i + 3]
            for k in range(BLOCK):
                sums[k] += r0 * a0[k] + r1 * a1[k] + r2 * a2[k] + r3 * a3[k]
            i += 4
        while i < m:
            a0 = block[pixels[i]]
            r0 = residual[i]
            for k in range(BLOCK):
                sums[k] += r0 * a0[k]
            i += 1
        # The maximum alone runs vectorised; where it lies is looked for only in the few blocks that improve it.
        top = np.float32(0.0)
        for k in range(BLOCK):
            size = abs(sums[k])
            top = size if size > top else top
        if top > best:
            best = top
            for k in range(BLOCK):
                if abs(sums[k]) == top:
                    best_atom = b * BLOCK + k
                    break
    return best_atom


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
    sums: NDArray[np.float32],
    chosen: NDArray[np.int64],
    coefficients: NDArray[np.float32],
) -> int:
    """`acts_recon.fastomp.fast_omp` on the measured `pixels` of a patch; returns the number of chosen atoms."""
    for i in range(m):
        residual[i] = y[i]
    s = 0
    for i in range(n_atoms):
        atom = _best_atom(blocks, pixels, residual, m, sums)
        if atom < 0:
            break
        chosen[i] = atom
        for p in range(m):
            Q[i, p] = atoms[atom, pixels[p]]
        for j in range(i):
            dot = np.float32(0.0)
            for p in range(m):
                dot += Q[j, p] * Q[i, p]
            R[j, i] = dot
            share = dot / R[j, j]
            for p in range(m):
                Q[i, p] -= share * Q[j, p]
        norm = _REGULARISATION
        dot = np.float32(0.0)
        for p in range(m):
            norm += Q[i, p] * Q[i, p]
            dot += Q[i, p] * residual[p]
        R[i, i] = norm
        share = dot / norm
        for p in range(m):
            residual[p] -= share * Q[i, p]
        s += 1
    for i in range(s - 1, -1, -1):
        value = np.float32(0.0)
        for p in range(m):
            value += Q[i, p] * y[p]
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
    sums: NDArray[np.float32],
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
        s = pursue(blocks, atoms, pixels, y, n, n_atoms, residual, Q, R, sums, chosen, coefficients)
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
    return np.ascontiguousarray(padded.reshape(n_pixels, n_blocks, BLOCK).transpose(1, 0, 2))


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
        self.measured_values = floats(n_patches, n_pixels)
        self.n_measured = np.zeros(n_patches, dtype=np.int32)
        self.pressed = np.zeros(n_patches, dtype=np.bool_)
        self.residual = floats(n_pixels)
        self.Q = floats(n_pixels, n_pixels)
        self.R = floats(n_pixels, n_pixels)
        self.sums = floats(BLOCK)
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
            self.sums,
            self.chosen,
            self.coefficients,
        )
