# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The core's recovery and classification as Python functions."""

from __future__ import annotations

import ctypes
from functools import lru_cache

import numpy as np
from core_library import U16, installed
from numpy.typing import NDArray

from acts_core.wire import OUTPUTS
from acts_recon.objects import Classification, ObjectLibrary

Values = NDArray[np.uint16]


@lru_cache(maxsize=1)
def library() -> ctypes.CDLL:
    lib = ctypes.CDLL(str(installed("libcore_probe.so")))
    pointer, i32 = ctypes.c_void_p, ctypes.c_int
    signatures = {
        "probe_recover": [pointer, i32, i32, i32, i32, i32, pointer, pointer, i32, i32, pointer],
        "probe_classify": [pointer, pointer, i32, i32, pointer, pointer, i32, i32, i32, pointer, pointer],
        "probe_atoms_limit": [i32],
    }
    lib.probe_published_recovery_us.argtypes = [i32] * 5
    lib.probe_published_recovery_us.restype = ctypes.c_double
    for name, arguments in signatures.items():
        getattr(lib, name).argtypes = arguments
    return lib


def recover(
    atoms: NDArray[np.float32],
    side: int,
    step: int,
    shape: tuple[int, int],
    indices: Values,
    counts: Values,
    *,
    touch_counts: int = 60,
) -> NDArray[np.float32] | None:
    """The image of the board's core; None where it finds that the patches do not fit the array."""
    dictionary = np.ascontiguousarray(atoms, dtype=np.float32)
    indices, counts = np.ascontiguousarray(indices, dtype=U16), np.ascontiguousarray(counts, dtype=U16)
    image = np.zeros(shape, dtype=np.float32)
    fits = library().probe_recover(
        dictionary.ctypes.data,
        dictionary.shape[1],
        side,
        step,
        *shape,
        indices.ctypes.data,
        counts.ctypes.data,
        len(indices),
        touch_counts,
        image.ctypes.data,
    )
    return image if fits else None


def classify(
    objects: ObjectLibrary, indices: Values, counts: Values, *, max_columns: int, touch_counts: int = 60
) -> Classification:
    """The classification of the board's core."""
    classes = objects.classes.astype(np.uint8)
    indices, counts = np.ascontiguousarray(indices, dtype=U16), np.ascontiguousarray(counts, dtype=U16)
    residuals = np.zeros(objects.n_classes, dtype=np.float32)
    confidence = ctypes.c_float()
    best = library().probe_classify(
        objects.columns.ctypes.data,
        classes.ctypes.data,
        objects.n_columns,
        objects.n_classes,
        indices.ctypes.data,
        counts.ctypes.data,
        len(indices),
        touch_counts,
        max_columns,
        residuals.ctypes.data,
        ctypes.byref(confidence),
    )
    return Classification(best >= 0, max(best, 0), residuals, confidence.value)


def atoms_limit(m: int) -> int:
    return int(library().probe_atoms_limit(m))


def published_recovery_us(output: str, columns: int, m: int, *, shape: tuple[int, int] = (32, 32)) -> float:
    """The virtual board's model of the time that recovery ("image") or classification ("object") takes."""
    return float(library().probe_published_recovery_us(OUTPUTS.index(output), columns, *shape, m))
