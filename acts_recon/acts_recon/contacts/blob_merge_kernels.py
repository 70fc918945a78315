# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Track merge and split: contacts that become one, and part again; in numba, without allocation.

The strongest of merged tracks is the host: it has the contact, at the contact's centre of pressure c. Track i of the
contact is expected at p_i. With the offset d_i = p_i - p_host and the share w_i of the force,
``p_host = c - sum(w_i d_i)`` over the other merged tracks.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_recon.contacts.blob_tracks import ACTIVE, MAX_TRACKS, MERGED, NONE


@kernel
def own_part(t: int, tracks: NDArray[Any]) -> tuple[float, float]:
    """Expected position of a track: that of its contact less ``sum(share * offset)`` of the tracks merged into it."""
    x, y = tracks[t].x, tracks[t].y
    for other in range(MAX_TRACKS):
        if tracks[other].state == MERGED and tracks[other].host == t:
            x -= tracks[other].share * tracks[other].dx
            y -= tracks[other].share * tracks[other].dy
    return x, y


@kernel
def count_merged(t: int, tracks: NDArray[Any]) -> int:
    """Number of tracks merged into this one."""
    count = 0
    for other in range(MAX_TRACKS):
        if tracks[other].state == MERGED and tracks[other].host == t:
            count += 1
    return count


@kernel
def leave(t: int, tracks: NDArray[Any]) -> None:
    """Scale the force shares of the tracks that stay merged when `t` leaves, so that they and the host add up to 1."""
    rest = max(1.0 - tracks[t].share, 1e-3)
    for other in range(MAX_TRACKS):
        if other != t and tracks[other].state == MERGED and tracks[other].host == tracks[t].host:
            tracks[other].share = min(tracks[other].share / rest, 1.0)


@kernel
def part(tracks: NDArray[Any]) -> None:
    """Split: make every merged track active that has a contact of its own again."""
    for t in range(MAX_TRACKS):
        track = tracks[t]
        if track.state != MERGED or track.blob == NONE:
            continue
        host = tracks[track.host]
        host_vx = host.vx - track.share * track.dvx
        host_vy = host.vy - track.share * track.dvy
        track.vx = host_vx + track.dvx
        track.vy = host_vy + track.dvy
        # The position follows from the contact, see `blob_motion_kernels.update`.
        track.x = track.y = math.inf
        # Expected position of the host when this one has left.
        host_x, host_y = host.x - track.share * track.dx, host.y - track.share * track.dy
        leave(t, tracks)
        host.vx, host.vy = host_vx, host_vy
        host.x, host.y = host_x, host_y
        track.state = ACTIVE
        track.host = NONE


@kernel
def covering(n: int, t: int, overlap: NDArray[np.int32], track_of: NDArray[np.int64]) -> int:
    """The track whose contact covers most of the taxels that were those of `t`; NONE without one."""
    host = NONE
    most = 0
    for b in range(n):
        if track_of[b] != NONE and overlap[b, t] > most:
            most = overlap[b, t]
            host = track_of[b]
    return host


@kernel
def merge(time_s: float, t: int, h: int, blobs: NDArray[Any], tracks: NDArray[Any]) -> None:
    """Merge track `t` into `h`, whose contact covers the taxels of `t`."""
    track, host = tracks[t], tracks[h]
    if host.x == math.inf:
        # The host has just split from this track, which now merges into it: its position is its contact's.
        host.x, host.y = blobs[host.blob].x_m, blobs[host.blob].y_m
    x, y = own_part(t, tracks)
    host_x, host_y = own_part(h, tracks)
    share = track.force_n / max(track.force_n + host.force_n, 1e-30)
    own = 1.0
    for other in range(MAX_TRACKS):
        guest = tracks[other]
        if guest.state != MERGED:
            continue
        if guest.host == t:
            own -= guest.share
            guest.host = h
            guest.share *= share
            guest.dx += x - host_x
            guest.dy += y - host_y
            guest.dvx = guest.dvy = 0.0
        elif guest.host == h:
            guest.share *= 1.0 - share
            guest.dvx = guest.dvy = 0.0
    track.state = MERGED
    track.host = h
    track.merged_s = time_s
    track.share = share * max(own, 0.0)
    track.dx, track.dy = x - host_x, y - host_y
    track.dvx, track.dvy = track.vx - host.vx, track.vy - host.vy
    host.vx += share * track.dvx
    host.vy += share * track.dvy
    if count_merged(h, tracks) > 1:
        # The second moments of one contact cannot locate more than two tracks: their offsets stay as they are.
        track.dvx = track.dvy = 0.0
    host.x = host.y = math.inf
