# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where the authors' firmware measures in its uniform scheme."""

PUBLISHED_SPACING = {
    36: (6, 6),
    42: (6, 5),
    48: (6, 4),
    49: (5, 5),
    56: (5, 4),
    64: (4, 4),
    66: (6, 3),
    77: (5, 3),
    88: (4, 3),
    96: (6, 2),
    112: (5, 2),
    121: (3, 3),
    128: (4, 2),
    160: (7, 1),
    176: (3, 2),
    192: (6, 1),
    224: (5, 1),
    256: (2, 2),
    352: (3, 1),
    512: (2, 1),
    1024: (1, 1),
}
"""Spacing (rows, columns) on 32 x 32 for each number of samples."""
