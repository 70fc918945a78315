# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What sampling schemes are made of.

A scheme takes from here what it inherits (`SamplingScheme`), its settings (`CommonSettings`, `OwnSetting`), the skin's
map and the orders and random numbers that the board has, too.
"""

from acts_core.sampling.basis.dither_order import dither_order
from acts_core.sampling.basis.division_order import division_order
from acts_core.sampling.basis.pcg32 import Pcg32
from acts_core.sampling.basis.scheme import Measure, Samples, SamplingScheme
from acts_core.sampling.basis.settings import NEIGHBOURS, CommonSettings, OwnSetting, Share, quota_of, with_fields
from acts_core.sampling.basis.skin_map import SkinMap

__all__ = [
    "NEIGHBOURS",
    "CommonSettings",
    "Measure",
    "OwnSetting",
    "Pcg32",
    "Samples",
    "SamplingScheme",
    "Share",
    "SkinMap",
    "dither_order",
    "division_order",
    "quota_of",
    "with_fields",
]
