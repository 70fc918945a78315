# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recordings of a SDH-2 hand with six Weiss DSA arrays: github.com/peter-kiechle/tactile-sensors.

A file is XML compressed by bzip2. A frame is a text of big-endian 32-bit floats in hexadecimal digits: a number -n
stands for n zeros, any other for the 12 bits of one texel. The six arrays follow one another, each row by row.
"""

from __future__ import annotations

import bz2
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import RecordingError

SIDE = 32
RATE_HZ = 31.0

SLIPS = (
    "frequency_analysis/sliptest_highspeed_xmasball.dsa",
    "slip-detection/slip_and_rotation_teapot_handle.dsa",
    "slip-detection/slip_hockey_ball.dsa",
    "slip-detection/slip_test.dsa",
    "video/slip_detection_tactile_not_even_lifting.dsa",
)
"""Objects that slip and turn, in `pressure_profiles`."""

OBJECTS = (
    "aerosol_can",
    "christmas_ball",
    "coffee_mug_violet",
    "foam_ball",
    "golf_ball",
    "green_plastic_ball_small",
    "hammer",
    "hockey_ball",
    "jug_white_handle",
    "pen_medium",
    "pen_thick",
    "plastic_cup_handle",
    "saucer",
    "teapot_large_body",
    "teapot_large_handle",
    "teapot_small_body",
    "wooden_block_flat",
    "wooden_block_small",
)
"""18 of the 36 objects in `python/classification/training_grasp_profiles_thesis`, which docs/recovery.md uses."""

# Rows, columns, and position of the first texel in the picture; apart, so that no contact spans two arrays.
_ARRAYS = ((14, 6, 17, 2), (13, 6, 2, 2), (14, 6, 17, 13), (13, 6, 2, 13), (14, 6, 17, 24), (13, 6, 2, 24))
_PLACES = np.concatenate(
    [((top + np.arange(rows)[:, None]) * SIDE + left + np.arange(cols)).ravel() for rows, cols, top, left in _ARRAYS]
)
_UNPACKED_BYTES_MAX = 64_000_000


def live() -> NDArray[np.bool_]:
    """Mask of the picture's texels; np.ndarray [shape=(32, 32), dtype=bool]."""
    result = np.zeros(SIDE * SIDE, dtype=bool)
    result[_PLACES] = True
    return result.reshape(SIDE, SIDE)


def read(path: Path) -> NDArray[np.uint16]:
    """Frames of one recording.

    Returns
    -------
    np.ndarray [shape=(n, 32, 32), dtype=uint16]
        Counts of 10 bits; 0 where there is no texel.

    Raises
    ------
    RecordingError
        When the file cannot be read, or is of another format or another sensor.
    """
    try:
        with bz2.open(path) as file:
            content = file.read(_UNPACKED_BYTES_MAX + 1)
        if len(content) > _UNPACKED_BYTES_MAX:
            raise RecordingError(f"{path}: more than {_UNPACKED_BYTES_MAX} bytes unpacked; no recording is that long")
        texts = [element.text or "" for element in ET.fromstring(content).iterfind("data/frame/frame_data")]
        values = [_frame("".join(text.split())) for text in texts]
    except (OSError, EOFError, ET.ParseError, ValueError) as error:
        raise RecordingError(f"{path}: cannot be read as a recording of Weiss DSA arrays ({error})") from error
    if not values:
        raise RecordingError(f"{path}: no frames")
    frames = np.zeros((len(values), SIDE * SIDE), dtype=np.uint16)
    frames[:, _PLACES] = np.array(values) // 4
    return frames.reshape(-1, SIDE, SIDE)


def _frame(digits: str) -> NDArray[np.uint16]:
    words = np.frombuffer(bytes.fromhex(digits), dtype=">f4")
    frame = np.zeros(_PLACES.size, dtype=np.uint16)
    at = 0
    for word in words.tolist():
        if -frame.size <= word < 0:
            at -= int(word)
        elif at < frame.size and 0 <= word <= 4095:
            frame[at] = int(word)
            at += 1
        else:
            raise ValueError(f"value {word} of texel {at}: there are {frame.size} of 12 bits")
    if at != frame.size:
        raise ValueError(f"a frame of {at} texels, not {frame.size}")
    return frame
