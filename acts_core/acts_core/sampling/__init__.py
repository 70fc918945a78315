"""Which taxels of a frame are measured, and in which order: the schemes, as the board has them.

In come settings and, for schemes that follow touch, the counts so far; out come the indices of each frame. `SkinMap` is
what a board is told of the skin's layout.
"""

from acts_core.sampling.schemes import NEIGHBOURS, SCHEMES, Sampler, SamplingConfig, measure_in
from acts_core.sampling.skin_map import SkinMap
from acts_core.sampling.uniform import uniform_spacing

__all__ = ["NEIGHBOURS", "SCHEMES", "Sampler", "SamplingConfig", "SkinMap", "measure_in", "uniform_spacing"]
