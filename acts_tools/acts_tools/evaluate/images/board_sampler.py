"""The firmware's own sampler, measuring in recorded frames: what a board would have sampled of them."""

from __future__ import annotations

import ctypes
import os
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ArrayError, SettingsError
from acts_core.sampling import NEIGHBOURS, SCHEMES, SamplingConfig

_LIBRARY = "libacts_sampler.so"


@lru_cache(maxsize=1)
def _library() -> ctypes.CDLL:
    prefixes = [Path(prefix) for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(":") if prefix]
    path = next((p for prefix in prefixes if (p := prefix / "lib" / _LIBRARY).is_file()), None)
    if path is None:
        raise SettingsError(f"{_LIBRARY} of package acts_firmware is in none of {prefixes}: build the workspace")
    library = ctypes.CDLL(str(path))
    pointer, integer, size, real = ctypes.c_void_p, ctypes.c_int, ctypes.c_size_t, ctypes.c_double
    library.acts_sampler_new.restype = pointer
    library.acts_sampler_new.argtypes = [*[integer] * 6, ctypes.c_uint64, integer, integer, real]
    library.acts_sampler_free.restype = None
    library.acts_sampler_free.argtypes = [pointer]
    library.acts_sampler_frame.restype = integer
    library.acts_sampler_frame.argtypes = [pointer, pointer, size, real, real, pointer, pointer]
    return library


class BoardSampler:
    """The C++ implementation of `acts_core.sampling.schemes.Sampler`, a hundred times as fast, on recordings.

    Parameters
    ----------
    config : SamplingConfig
    noise_counts : float
        Standard deviation of normal noise that is added to every measurement, drawn from the seed of `config`.

    Raises
    ------
    SettingsError
        When the firmware refuses the settings, or its library is not built.
    """

    def __init__(self, config: SamplingConfig, noise_counts: float = 0.0) -> None:
        self.config = config
        taxels = config.rows * config.cols
        self._indices = np.zeros(taxels, dtype=np.uint16)
        self._counts = np.zeros(taxels, dtype=np.uint16)
        self._sampler = _library().acts_sampler_new(
            config.rows,
            config.cols,
            int(SCHEMES[config.scheme]),
            config.m,
            config.threshold_counts,
            list(NEIGHBOURS).index(config.neighbour_order),
            config.seed,
            config.search_quota,
            config.adaptive_quota,
            noise_counts,
        )
        if not self._sampler:
            raise SettingsError(f"the firmware refuses {config}")

    def __del__(self) -> None:
        if getattr(self, "_sampler", None):
            _library().acts_sampler_free(self._sampler)

    def frame(
        self, frames: NDArray[np.uint16], position: float, step: float
    ) -> tuple[NDArray[np.uint16], NDArray[np.uint16]]:
        """Sample one frame while the recording goes on.

        Parameters
        ----------
        frames : np.ndarray [shape=(n, rows, cols), dtype=uint16, C-contiguous]
            Counts, 0 to 1023; interpolated linearly in time, the first and last held.
        position : float
            Where in the recording the first measurement is made, in frames.
        step : float
            How much later each following measurement is made, in frames.

        Returns
        -------
        indices, counts : np.ndarray [shape=(m,), dtype=uint16]
            As in `acts_core.sampling.schemes.Sampler.frame`; overwritten by the next call.
        """
        shape = (self.config.rows, self.config.cols)
        if frames.dtype != np.uint16 or frames.shape[1:] != shape or not len(frames) or not frames.flags.c_contiguous:
            raise ArrayError(
                f"frames {frames.shape}, {frames.dtype}: needed are C-contiguous uint16 (n, {shape[0]}, {shape[1]})"
            )
        m = _library().acts_sampler_frame(
            self._sampler,
            frames.ctypes.data,
            len(frames),
            position,
            step,
            self._indices.ctypes.data,
            self._counts.ctypes.data,
        )
        return self._indices[:m], self._counts[:m]
