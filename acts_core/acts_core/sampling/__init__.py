# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Which taxels of a frame are measured, and in which order: the schemes, as the board has them.

In come settings and, for schemes that follow touch, the counts so far; out come the indices of each frame. `SkinMap` is
the part of the skin's layout that is sent to a board.
"""

from acts_core.sampling.basis import (
    NEIGHBOURS,
    Measure,
    OwnSetting,
    Samples,
    SamplingScheme,
    Share,
    SkinMap,
    quota_of,
    with_fields,
)
from acts_core.sampling.registry import (
    BOARD_OWN_SETTINGS,
    OWN_SETTINGS,
    REPEATING,
    SCHEME_NUMBERS,
    SCHEMES,
    check_frame,
    check_names,
    check_sampling,
    frame_size,
)
from acts_core.sampling.sampler import MEASUREMENT_US, Sampler, SamplingConfig, measure_in

__all__ = [
    "BOARD_OWN_SETTINGS",
    "MEASUREMENT_US",
    "NEIGHBOURS",
    "OWN_SETTINGS",
    "REPEATING",
    "SCHEMES",
    "SCHEME_NUMBERS",
    "Measure",
    "OwnSetting",
    "Sampler",
    "Samples",
    "SamplingConfig",
    "SamplingScheme",
    "Share",
    "SkinMap",
    "check_frame",
    "check_names",
    "check_sampling",
    "frame_size",
    "measure_in",
    "quota_of",
    "with_fields",
]
