# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the tests call: the installed files of this package, and its core as Python functions."""

from __future__ import annotations

import ctypes
import os
from functools import lru_cache
from pathlib import Path
from types import TracebackType

import numpy as np
from numpy.typing import NDArray

from acts_core.frames import SampleFrame
from acts_core.sampling import SamplingConfig, SkinMap
from acts_core.wire import BoardSettings

U16 = np.dtype("<u2")


FOLDERS = ("lib/acts_firmware", "libexec/acts_firmware/test")
"""Programs of this package, and those of its tests."""


def installed(name: str) -> Path:
    """A file of this package in the first prefix that has it."""
    prefixes = [Path(prefix) for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(":") if prefix]
    for prefix in prefixes:
        # Those of the tests first: an earlier release installed them beside the others.
        for folder in reversed(FOLDERS):
            path = prefix / folder / name
            if path.exists():
                return path
    raise FileNotFoundError(f"{name} of acts_firmware is in none of {prefixes}; build the workspace first")


@lru_cache(maxsize=1)
def library() -> ctypes.CDLL:
    lib = ctypes.CDLL(str(installed("libcore_probe.so")))
    u16, u8, i32 = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int
    u32, u64, size = ctypes.c_uint32, ctypes.c_uint64, ctypes.c_size_t
    signatures = {
        "probe_new": (ctypes.c_void_p, [u8]),
        "probe_arrange": (i32, [ctypes.c_void_p, i32, i32, i32, u32, u8]),
        "probe_free": (None, [ctypes.c_void_p]),
        "probe_sample": (i32, [ctypes.c_void_p, u16, u16, u16]),
        "probe_division_order": (i32, [i32, i32, u16]),
        "probe_spacing": (None, [i32, i32, i32, ctypes.POINTER(i32)]),
        "probe_quota_of": (i32, [ctypes.c_double, i32]),
        "probe_published_sample_us": (ctypes.c_double, [u8]),
        "probe_random": (None, [u64, u64, u32, i32, ctypes.c_void_p]),
        "probe_cobs_encode": (size, [u8, size, ctypes.c_void_p]),
        "probe_cobs_decode": (size, [u8, size, ctypes.c_void_p]),
        "probe_encode": (size, [u32, u64, u32, u32, i32, i32, i32, i32, u16, u16, ctypes.c_void_p]),
    }
    for name, (result, arguments) in signatures.items():
        function = getattr(lib, name)
        function.restype, function.argtypes = result, arguments
    return lib


class CoreSampler:
    """`acts_core.sampling.Sampler` in C++, measuring through the model of the board's wiring."""

    def __init__(self, config: SamplingConfig, skin_map: SkinMap | None = None) -> None:
        self._size = config.rows * config.cols
        self._probe = library().probe_new(BoardSettings.from_sampling(config).to_bytes())
        assert self._probe, f"the core refuses {config}"
        if skin_map is not None:
            assert library().probe_arrange(
                self._probe, skin_map.rows, skin_map.cols, skin_map.no_skin, skin_map.crc32, skin_map.entries()
            ), "the core refuses the map"

    def __enter__(self) -> CoreSampler:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        library().probe_free(self._probe)

    def frame(self, field: NDArray[np.integer]) -> tuple[NDArray[np.uint16], NDArray[np.uint16]]:
        values = np.ascontiguousarray(field, dtype=U16)
        assert values.size == self._size
        indices, counts = np.zeros(self._size, dtype=U16), np.zeros(self._size, dtype=U16)
        m = library().probe_sample(self._probe, values.ctypes.data, indices.ctypes.data, counts.ctypes.data)
        return indices[:m], counts[:m]


def division_order(rows: int, cols: int) -> NDArray[np.uint16]:
    order = np.zeros(rows * cols, dtype=U16)
    assert library().probe_division_order(rows, cols, order.ctypes.data) == rows * cols
    return order


def uniform_spacing(rows: int, cols: int, m: int) -> tuple[int, int] | None:
    pair = (ctypes.c_int * 2)()
    library().probe_spacing(rows, cols, m, pair)
    return (pair[0], pair[1]) if pair[0] else None


def quota_of(share: float, m: int) -> int:
    return int(library().probe_quota_of(share, m))


def published_sample_us(config: SamplingConfig) -> float:
    """What the virtual board takes for one measurement."""
    return float(library().probe_published_sample_us(BoardSettings.from_sampling(config).to_bytes()))


def random_numbers(seed: int, stream: int, bound: int, count: int) -> list[int]:
    """`count` numbers below `bound`; below 2**32 where `bound` is 0."""
    numbers = np.zeros(count, dtype=np.uint32)
    library().probe_random(seed, stream, bound, count, numbers.ctypes.data)
    return numbers.tolist()


def cobs_encode(data: bytes) -> bytes:
    out = ctypes.create_string_buffer(len(data) + len(data) // 254 + 1)
    length = library().probe_cobs_encode(data, len(data), out)
    return out.raw[:length]


def cobs_decode(data: bytes) -> bytes:
    out = ctypes.create_string_buffer(len(data) + 1)
    length = library().probe_cobs_decode(data, len(data), out)
    return out.raw[:length]


def encode_samples(frame: SampleFrame) -> bytes:
    """The packet, before stuffing."""
    indices, counts = (np.ascontiguousarray(values, dtype=U16) for values in (frame.indices, frame.counts))
    out = ctypes.create_string_buffer(36 + 4 * len(indices))
    length = library().probe_encode(
        frame.sequence,
        frame.board_us,
        frame.duration_us,
        frame.overruns,
        int(frame.scheme),
        frame.rows,
        frame.cols,
        len(indices),
        indices.ctypes.data,
        counts.ctypes.data,
        out,
    )
    return out.raw[:length]
