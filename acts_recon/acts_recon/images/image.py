# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Tactile images as bytes: raw counts for programs, coloured and enlarged for people."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX

# A black-to-white table after D. A. Green's "cubehelix" (Bulletin of the Astronomical Society of India 39, 289-295,
# 2011): its lightness grows evenly, so equal steps of pressure look equal, also in print and to the colour-blind.
_START = 0.5
_ROTATIONS = -1.2
_SATURATION = 1.3


def colour_table() -> NDArray[np.uint8]:
    """Colours from black (0) to white, of evenly growing lightness; np.ndarray [shape=(256, 3), dtype=uint8]."""
    light = np.linspace(0, 1, 256)[:, None]
    angle = 2 * np.pi * (_START / 3 + 1 + _ROTATIONS * light)
    amplitude = _SATURATION * light * (1 - light) / 2
    towards_cos = np.array([-0.14861, -0.29227, 1.97294])
    towards_sin = np.array([1.78277, -0.90649, 0.0])
    rgb = light + amplitude * (towards_cos * np.cos(angle) + towards_sin * np.sin(angle))
    return np.rint(255 * np.clip(rgb, 0, 1)).astype(np.uint8)


_TABLE = colour_table()


def mono16(image: NDArray[np.float32]) -> bytes:
    """Pixels of a ``mono16`` image (little-endian): the counts, rounded.

    Parameters
    ----------
    image : np.ndarray [shape=(rows, cols), dtype=float32]
        0 to 1023.
    """
    return (image + np.float32(0.5)).astype("<u2").tobytes()


def rgb8(image: NDArray[np.float32], *, scale: int, full_scale_counts: float = COUNT_MAX) -> bytes:
    """Pixels of an ``rgb8`` image, each taxel a square of `scale` x `scale` pixels.

    The scale of colours is absolute: the same pressure has the same colour in every frame.

    Parameters
    ----------
    image : np.ndarray [shape=(rows, cols), dtype=float32]
        Counts, finite.
    scale : int
        At least 1.
    full_scale_counts : float
        Counts that are shown white, as is everything above.
    """
    level = np.clip(image * np.float32((len(_TABLE) - 1) / full_scale_counts), 0, len(_TABLE) - 1)
    pixels = _TABLE[np.rint(level).astype(np.intp)]
    return pixels.repeat(scale, axis=0).repeat(scale, axis=1).tobytes()
