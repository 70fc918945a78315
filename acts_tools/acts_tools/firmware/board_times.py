# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Times of the published board, from the model that the virtual board runs by (acts_firmware/virtual_board)."""

from __future__ import annotations

import ctypes
from functools import lru_cache

from acts_core.sampling import SCHEMES, SamplingConfig
from acts_core.wire import OUTPUTS, BoardSettings
from acts_tools.firmware.library import library_path

LIBRARY = "libacts_board_times.so"


@lru_cache(maxsize=1)
def _library() -> ctypes.CDLL:
    library = ctypes.CDLL(str(library_path(LIBRARY)))
    library.acts_board_sampling_us.restype = ctypes.c_double
    library.acts_board_sampling_us.argtypes = [ctypes.c_char_p, ctypes.c_size_t]
    library.acts_board_output_us.restype = ctypes.c_double
    library.acts_board_output_us.argtypes = [ctypes.c_int] * 5
    return library


def sampling_us(scheme: str, m: int) -> float:
    """Time in which the board measures a frame of 32 x 32 taxels [us].

    Raises
    ------
    SettingsError
        When the library is not built.
    """
    config = SamplingConfig(scheme=scheme, m=1024 if SCHEMES[scheme].measures_all else m)
    settings = BoardSettings.from_sampling(config).to_bytes()
    return float(_library().acts_board_sampling_us(settings, len(settings)))


def output_us(output: str, columns: int, m: int) -> float:
    """Time that the board takes besides for an ``"image"`` by `columns` atoms, or an ``"object"`` by a library [us].

    Raises
    ------
    SettingsError
        When the library is not built.
    """
    return float(_library().acts_board_output_us(OUTPUTS.index(output), columns, 32, 32, m))
