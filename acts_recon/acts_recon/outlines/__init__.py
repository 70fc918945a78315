# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Outlines: closed contours of contacts, finer than the taxels, frame by frame.

In come samples and the image; out come outlines with area, perimeter, orientation and growth, each with a number that
stays while it lasts. Outlines over time are a surface, as a file that viewers of 3D models open.
"""

from acts_recon.outlines.config import OutlinesConfig
from acts_recon.outlines.contours import area, contours
from acts_recon.outlines.outline import Outline, mean_distance_m
from acts_recon.outlines.surface import Surface, surface_of, write_ply
from acts_recon.outlines.tracer import OutlineTracer, load

__all__ = [
    "Outline",
    "OutlineTracer",
    "OutlinesConfig",
    "Surface",
    "area",
    "contours",
    "load",
    "mean_distance_m",
    "surface_of",
    "write_ply",
]
