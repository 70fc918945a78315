# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""State of a track, for the kernels that follow it."""

from __future__ import annotations

import numpy as np

from acts_recon.contacts.blob_kernels import MAX_BLOBS

MAX_TRACKS = 2 * MAX_BLOBS
"""Tracks at most: active, away and merged."""

FREE, ACTIVE, AWAY, MERGED = 0, 1, 2, 3
NONE = -1

TRACK = np.dtype(
    [
        ("number", "i8"),
        ("state", "i8"),
        ("host", "i8"),
        ("blob", "i8"),
        # Of its contacts, see `acts_recon.contacts.blob_kernels.BLOB`.
        ("patch", "i8"),
        # Kalman filter of position and velocity, and its covariances, axis by axis [m, s].
        ("x", "f8"),
        ("y", "f8"),
        ("vx", "f8"),
        ("vy", "f8"),
        ("x_pp", "f8"),
        ("x_pv", "f8"),
        ("x_vv", "f8"),
        ("y_pp", "f8"),
        ("y_pv", "f8"),
        ("y_vv", "f8"),
        # Force of its contact, and the contact's second moments when no other track was merged into it.
        ("force_n", "f8"),
        ("xx_m2", "f8"),
        ("xy_m2", "f8"),
        ("yy_m2", "f8"),
        ("began_s", "f8"),
        ("seen_s", "f8"),
        # Merged: since when; offset from the host and its rate; share of the whole contact's force.
        ("merged_s", "f8"),
        ("dx", "f8"),
        ("dy", "f8"),
        ("dvx", "f8"),
        ("dvy", "f8"),
        ("share", "f8"),
    ]
)
"""State of a track."""
