"""Contacts with numbers that become one contact, and part again, in numba, without allocation.

A merged track stands at an offset from its host's own part. The host's position is that of the whole contact: its own
part, and the parts of its guests by their shares in the force.
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
    """Where a track itself is, without those merged with it."""
    x, y = tracks[t].x, tracks[t].y
    for other in range(MAX_TRACKS):
        if tracks[other].state == MERGED and tracks[other].host == t:
            x -= tracks[other].share * tracks[other].dx
            y -= tracks[other].share * tracks[other].dy
    return x, y


@kernel
def count_merged(t: int, tracks: NDArray[Any]) -> int:
    """How many tracks are merged with this one."""
    count = 0
    for other in range(MAX_TRACKS):
        if tracks[other].state == MERGED and tracks[other].host == t:
            count += 1
    return count


@kernel
def leave(t: int, tracks: NDArray[Any]) -> None:
    """Share the force anew among those that stay with the host of `t`."""
    rest = max(1.0 - tracks[t].share, 1e-3)
    for other in range(MAX_TRACKS):
        if other != t and tracks[other].state == MERGED and tracks[other].host == tracks[t].host:
            tracks[other].share = min(tracks[other].share / rest, 1.0)


@kernel
def part(tracks: NDArray[Any]) -> None:
    """Make active what was merged and has a contact of its own again."""
    for t in range(MAX_TRACKS):
        track = tracks[t]
        if track.state != MERGED or track.blob == NONE:
            continue
        host = tracks[track.host]
        host_vx = host.vx - track.share * track.dvx
        host_vy = host.vy - track.share * track.dvy
        track.vx = host_vx + track.dvx
        track.vy = host_vy + track.dvy
        # The position follows from the contact, see `_update`.
        track.x = track.y = math.inf
        # Where the host is, without this one.
        host_x, host_y = host.x - track.share * track.dx, host.y - track.share * track.dy
        leave(t, tracks)
        host.vx, host.vy = host_vx, host_vy
        host.x, host.y = host_x, host_y
        track.state = ACTIVE
        track.host = NONE


@kernel
def covering(n: int, t: int, overlap: NDArray[np.int32], track_of: NDArray[np.int64]) -> int:
    """The track whose contact covers most of what was `t`'s."""
    host = NONE
    most = 0
    for b in range(n):
        if track_of[b] != NONE and overlap[b, t] > most:
            most = overlap[b, t]
            host = track_of[b]
    return host


@kernel
def merge(time_s: float, t: int, h: int, blobs: NDArray[Any], tracks: NDArray[Any]) -> None:
    """Make track `t` part of `h`, whose contact covers what was its own."""
    track, host = tracks[t], tracks[h]
    if host.x == math.inf:
        # It has just parted from this very track, which is now gone into it.
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
        # Of more than two nobody says where they are in the contact: they stay as they were when they joined.
        track.dvx = track.dvy = 0.0
    host.x = host.y = math.inf
