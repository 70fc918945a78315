# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Samplers for recorded frames: that of the firmware, and Python's for schemes that exist in Python only."""

from __future__ import annotations

import ctypes
import itertools
import math
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.errors import ArrayError, SettingsError
from acts_core.sampling import Sampler, SamplingConfig, SkinMap
from acts_core.wire import BoardSettings
from acts_tools.firmware.library import library_path

LIBRARY = "libacts_sampler.so"


@lru_cache(maxsize=4)
def _library(path: Path) -> ctypes.CDLL:
    library = ctypes.CDLL(str(path))
    pointer, integer, size, real = ctypes.c_void_p, ctypes.c_int, ctypes.c_size_t, ctypes.c_double
    library.acts_sampler_new.restype = pointer
    library.acts_sampler_new.argtypes = [ctypes.c_char_p, size, real]
    library.acts_sampler_schemes.restype = ctypes.c_char_p
    library.acts_sampler_takes.restype = integer
    library.acts_sampler_takes.argtypes = [integer] * 4
    library.acts_sampler_map.restype = integer
    library.acts_sampler_map.argtypes = [pointer, integer, integer, integer, ctypes.c_char_p, ctypes.c_uint32]
    library.acts_sampler_free.restype = None
    library.acts_sampler_free.argtypes = [pointer]
    library.acts_sampler_frame.restype = integer
    library.acts_sampler_frame.argtypes = [pointer, pointer, size, real, real, pointer, pointer]
    return library


class BoardSampler:
    """The board's samples of a recording: `acts_core.sampling.Sampler` in C++, about a hundred times as fast.

    Parameters
    ----------
    config : SamplingConfig
    noise_counts : float
        Standard deviation of normal noise that is added to every measurement, with the seed of `config`.
    library : Path, optional
        Library with the firmware's sampler; by default the installed one.
    skin_map : SkinMap, optional
        How the taxels lie on the skin; by default as in the matrix.

    Raises
    ------
    SettingsError
        When the firmware refuses the settings or the map, or the library is not built.
    """

    def __init__(
        self,
        config: SamplingConfig,
        noise_counts: float = 0.0,
        library: Path | None = None,
        skin_map: SkinMap | None = None,
    ) -> None:
        self.config = config
        self._library = _library(library or library_path(LIBRARY))
        taxels = config.rows * config.cols
        self._indices = np.zeros(taxels, dtype=np.uint16)
        self._counts = np.zeros(taxels, dtype=np.uint16)
        settings = BoardSettings.from_sampling(config).to_bytes()
        self._sampler = self._library.acts_sampler_new(settings, len(settings), noise_counts)
        if not self._sampler:
            raise SettingsError(f"the firmware refuses {config}")
        if skin_map is not None and not self._library.acts_sampler_map(
            self._sampler, skin_map.rows, skin_map.cols, skin_map.no_skin, skin_map.entries(), skin_map.crc32
        ):
            raise SettingsError(f"the firmware refuses a map of {skin_map.rows} x {skin_map.cols} places for {config}")

    def __del__(self) -> None:
        if getattr(self, "_sampler", None):
            self._library.acts_sampler_free(self._sampler)

    def frame(
        self, frames: NDArray[np.uint16], position: float, step: float
    ) -> tuple[NDArray[np.uint16], NDArray[np.uint16]]:
        """Sample one frame while the recording continues.

        Parameters
        ----------
        frames : np.ndarray [shape=(n, rows, cols), dtype=uint16, C-contiguous]
            Counts, 0 to 1023; interpolated linearly in time, constant before the first and after the last.
        position : float
            Time of the first measurement, in frames of the recording.
        step : float
            Time between measurements, in frames of the recording.

        Returns
        -------
        indices, counts : np.ndarray [shape=(m,), dtype=uint16]
            As in `acts_core.sampling.Sampler.frame`; overwritten by the next call.
        """
        _check_frames(self.config, frames)
        m = self._library.acts_sampler_frame(
            self._sampler,
            frames.ctypes.data,
            len(frames),
            position,
            step,
            self._indices.ctypes.data,
            self._counts.ctypes.data,
        )
        return self._indices[:m], self._counts[:m]


class PythonSampler:
    """`acts_core.sampling.Sampler` on recordings, for schemes that exist in Python only.

    Parameters
    ----------
    config, noise_counts, skin_map
        See `BoardSampler`.
    """

    def __init__(self, config: SamplingConfig, noise_counts: float = 0.0, skin_map: SkinMap | None = None) -> None:
        self.config = config
        self._sampler = Sampler(config, skin_map)
        self._noise_counts = noise_counts
        self._random = np.random.default_rng(config.seed)

    def frame(
        self, frames: NDArray[np.uint16], position: float, step: float
    ) -> tuple[NDArray[np.uint16], NDArray[np.uint16]]:
        """See `BoardSampler.frame`."""
        _check_frames(self.config, frames)
        later = itertools.count()
        last = len(frames) - 1

        def measure(row: int, col: int) -> int:
            at = min(max(position + next(later) * step, 0.0), float(last))
            before = min(int(at), last)
            first, second = float(frames[before, row, col]), float(frames[min(before + 1, last), row, col])
            counts = first + (at - before) * (second - first) + self._noise_counts * self._random.standard_normal()
            return min(max(math.floor(counts + 0.5), 0), COUNT_MAX)

        return self._sampler.frame(measure)


def sampler_of(
    config: SamplingConfig, noise_counts: float = 0.0, skin_map: SkinMap | None = None
) -> BoardSampler | PythonSampler:
    """The firmware's sampler if it has the scheme, else Python's."""
    in_firmware = any(line.split("\t")[0] == config.scheme for line in scheme_table().splitlines())
    return (BoardSampler if in_firmware else PythonSampler)(config, noise_counts, skin_map=skin_map)


def scheme_table(library: Path | None = None) -> str:
    """Table of the firmware's schemes; see `acts_sampler_schemes` in acts_firmware/host."""
    table: bytes = _library(library or library_path(LIBRARY)).acts_sampler_schemes()
    return table.decode()


def firmware_takes(scheme: int, rows: int, cols: int, m: int) -> bool:
    """Whether the firmware supports a scheme, by its number, with `m` taxels per frame."""
    return bool(_library(library_path(LIBRARY)).acts_sampler_takes(scheme, rows, cols, m))


def _check_frames(config: SamplingConfig, frames: NDArray[np.uint16]) -> None:
    shape = (config.rows, config.cols)
    if frames.dtype != np.uint16 or frames.shape[1:] != shape or not len(frames) or not frames.flags.c_contiguous:
        raise ArrayError(
            f"frames {frames.shape}, {frames.dtype}: needed are C-contiguous uint16 (n, {shape[0]}, {shape[1]})"
        )
