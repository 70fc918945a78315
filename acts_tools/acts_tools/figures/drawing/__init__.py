# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures as pictures, all in one style: colours tell the scheme of sampling, lines tell whose a curve is.

No legend lies on a diagram: it has a place of its own, one for the whole figure where its panels agree.
"""

from acts_tools.figures.drawing.page import draw

__all__ = ["draw"]
