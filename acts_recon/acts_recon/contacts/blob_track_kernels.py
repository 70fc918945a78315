# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Tracking of contacts from frame to frame, in numba, without allocation.

A track is a contact with a number. It is active (seen in the last frame), away (not seen for a short while) or merged
(part of another track's contact, its host). `docs/reconstruction.md` says what becomes of the numbers. The steps:

1. Prediction of all tracks to the frame's time (`blob_motion_kernels`).
2. Data association: pairs of track and contact are chosen greedily, the nearest first. A pair is possible where the
   contact covers taxels of the track, or lies within a gate. Merged tracks take part where their host's taxels are now
   two contacts or more: a split.
3. An active track without a contact, whose taxels another track's contact covers, is merged into that
   (`blob_merge_kernels`). The stronger is the host.
4. Contacts without a track begin one.
5. Update of all tracks by their contacts.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_recon.contacts.blob_kernels import MAX_BLOBS
from acts_recon.contacts.blob_merge_kernels import count_merged, covering, leave, merge, own_part, part
from acts_recon.contacts.blob_motion_kernels import predict, update
from acts_recon.contacts.blob_tracks import ACTIVE, AWAY, FREE, MAX_TRACKS, MERGED, NONE, TRACK

NUMBERS = 2**32

FOUND = np.dtype(
    [
        ("number", "i8"),
        ("merged", "i8"),
        ("age_s", "f8"),
        ("x_m", "f8"),
        ("y_m", "f8"),
        ("vx_m_s", "f8"),
        ("vy_m_s", "f8"),
        ("force_n", "f8"),
        ("peak_counts", "f8"),
        ("area_m2", "f8"),
        ("active_taxels", "i8"),
        ("spread_m", "f8"),
        ("angle_rad", "f8"),
        ("x_sd_m", "f8"),
        ("y_sd_m", "f8"),
        ("vx_sd_m_s", "f8"),
        ("vy_sd_m_s", "f8"),
        ("force_sd_n", "f8"),
        ("area_sd_m2", "f8"),
        ("spread_sd_m", "f8"),
    ]
)
"""What `follow` says of each contact: the fields of `acts_core.skin.TrackedBlob`."""

# A pair without overlap is no further apart than this plus three standard deviations of the prediction, and no further
# than it gets at this speed.
GATE_TAXELS = 1.5
FASTEST_M_S = 2.5
# What parts from a contact is a merged one only if it has this part of the force expected of that.
LEAST_SHARE = 0.25
_ROUNDING = 1e-9


class Memory(NamedTuple):
    """State and buffers of `follow`.

    Attributes
    ----------
    tracks : np.ndarray [shape=(MAX_TRACKS,), dtype=TRACK]
        State.
    owner : np.ndarray [shape=(rows * cols,), dtype=int8]
        State: the track that a taxel belongs to, or -1.
    next_number : np.ndarray [shape=(1,), dtype=int64]
        State: the number of the next new contact.
    overlap : np.ndarray [shape=(MAX_BLOBS, MAX_TRACKS), dtype=int32]
    cost : np.ndarray [shape=(MAX_BLOBS, MAX_TRACKS), dtype=float64]
    track_of : np.ndarray [shape=(MAX_BLOBS,), dtype=int64]
        Work space: of every contact the taxels that it shares with each track, its cost with each, and its track.
    found : np.ndarray [shape=(MAX_BLOBS,), dtype=FOUND]
        Written: the contacts, the oldest first.
    """

    tracks: NDArray[Any]
    owner: NDArray[np.int8]
    next_number: NDArray[np.int64]
    overlap: NDArray[np.int32]
    cost: NDArray[np.float64]
    track_of: NDArray[np.int64]
    found: NDArray[Any]

    @classmethod
    def empty(cls, n_taxels: int) -> Memory:
        """At the start, without tracks."""
        return cls(
            tracks=np.zeros(MAX_TRACKS, dtype=TRACK),
            owner=np.full(n_taxels, NONE, dtype=np.int8),
            next_number=np.ones(1, dtype=np.int64),
            overlap=np.zeros((MAX_BLOBS, MAX_TRACKS), dtype=np.int32),
            cost=np.zeros((MAX_BLOBS, MAX_TRACKS)),
            track_of=np.zeros(MAX_BLOBS, dtype=np.int64),
            found=np.zeros(MAX_BLOBS, dtype=FOUND),
        )


@kernel
def follow(
    time_s: float,
    dt_s: float,
    n: int,
    blobs: NDArray[Any],
    members: NDArray[np.int32],
    pitch_m: float,
    pitch_y_m: float,
    sigma_known: bool,
    bridge_s: float,
    memory_s: float,
    memory: Memory,
) -> int:
    """Associate the contacts of a frame with tracks, and update these.

    Parameters
    ----------
    time_s, dt_s : float
        Of the frame, and since the frame before.
    n : int
        Contacts in `blobs`.
    blobs, members
        See `acts_recon.contacts.blob_kernels.Work`.
    pitch_m, pitch_y_m : float
    sigma_known : bool
        Whether the variances in `blobs` are known.
    bridge_s, memory_s : float
        How long a track may be away, and merged.
    memory : Memory

    Returns
    -------
    int
        Contacts written: `n`.
    """
    tracks, owner, overlap, track_of = memory.tracks, memory.owner, memory.overlap, memory.track_of
    predict(time_s, dt_s, bridge_s, memory_s, tracks)
    for b in range(n):
        track_of[b] = NONE
        for t in range(MAX_TRACKS):
            overlap[b, t] = 0
        for i in range(blobs[b].first, blobs[b].last):
            if owner[members[i]] >= 0:
                overlap[b, owner[members[i]]] += 1
    _weigh(time_s, bridge_s, n, blobs, pitch_m, pitch_y_m, tracks, overlap, memory.cost)
    _assign(n, tracks, memory.cost, track_of)
    _prefer_the_stronger(n, blobs, tracks, overlap, track_of)
    part(tracks)
    for t in range(MAX_TRACKS):
        if tracks[t].state == ACTIVE and tracks[t].blob == NONE:
            host = covering(n, t, overlap, track_of)
            if host == NONE:
                tracks[t].state = AWAY
            else:
                merge(time_s, t, host, blobs, tracks)
    for b in range(n):
        if track_of[b] == NONE:
            track_of[b] = _begin(time_s, b, blobs, tracks, memory.next_number)
    for b in range(n):
        update(time_s, dt_s, blobs[b], pitch_m, pitch_y_m, sigma_known, track_of[b], tracks)
    # The taxels of a track that is away stay its own until another contact covers them.
    for i in range(owner.shape[0]):
        if owner[i] >= 0 and tracks[owner[i]].state != AWAY:
            owner[i] = NONE
    for b in range(n):
        for i in range(blobs[b].first, blobs[b].last):
            owner[members[i]] = track_of[b]
    _report(time_s, n, blobs, pitch_m * pitch_y_m, sigma_known, tracks, track_of, memory.found)
    return n


@kernel
def _weigh(
    time_s: float,
    bridge_s: float,
    n: int,
    blobs: NDArray[Any],
    pitch_m: float,
    pitch_y_m: float,
    tracks: NDArray[Any],
    overlap: NDArray[np.int32],
    cost: NDArray[np.float64],
) -> None:
    """Cost of every pair of contact and track: their distance, infinite where they cannot belong together."""
    pitch = math.sqrt(pitch_m * pitch_y_m)
    for b in range(n):
        for t in range(MAX_TRACKS):
            cost[b, t] = math.inf
    for t in range(MAX_TRACKS):
        track = tracks[t]
        if track.state != ACTIVE and track.state != AWAY:
            continue
        covered = 0
        for b in range(n):
            if overlap[b, t] > 0:
                covered += 1
        parts = covered >= 2 and count_merged(t, tracks) > 0
        x, y = track.x, track.y
        if parts:
            x, y = own_part(t, tracks)
        reach = FASTEST_M_S * min(time_s - track.seen_s, bridge_s)
        further = min(3.0 * math.sqrt(max(track.x_pp, track.y_pp)), reach)
        for b in range(n):
            if blobs[b].patch != track.patch:
                continue
            dx, dy = blobs[b].x_m - x, blobs[b].y_m - y
            distance = math.hypot(dx, dy)
            # Rows may be farther apart than columns.
            taxels = math.hypot(dx / pitch_m, dy / pitch_y_m)
            if overlap[b, t] > 0:
                cost[b, t] = distance
            elif taxels < GATE_TAXELS or distance * (1.0 - GATE_TAXELS / taxels) < further:
                cost[b, t] = distance + pitch
        if not parts:
            continue
        for other in range(MAX_TRACKS):
            guest = tracks[other]
            if guest.state != MERGED or guest.host != t:
                continue
            for b in range(n):
                if overlap[b, t] > 0 and blobs[b].force_n > LEAST_SHARE * guest.share * track.force_n:
                    cost[b, other] = math.hypot(blobs[b].x_m - x - guest.dx, blobs[b].y_m - y - guest.dy)


@kernel
def _assign(n: int, tracks: NDArray[Any], cost: NDArray[np.float64], track_of: NDArray[np.int64]) -> None:
    """Give tracks to contacts, the pair of the least cost first, of equal ones the older track."""
    while True:
        best = math.inf
        best_b = best_t = NONE
        for b in range(n):
            if track_of[b] != NONE:
                continue
            for t in range(MAX_TRACKS):
                if cost[b, t] == math.inf or tracks[t].blob != NONE:
                    continue
                older = best_t != NONE and tracks[t].number < tracks[best_t].number
                if cost[b, t] < best or (cost[b, t] == best and older):
                    best, best_b, best_t = cost[b, t], b, t
        if best_b == NONE:
            return
        tracks[best_t].blob = best_b
        track_of[best_b] = best_t


@kernel
def _prefer_the_stronger(
    n: int, blobs: NDArray[Any], tracks: NDArray[Any], overlap: NDArray[np.int32], track_of: NDArray[np.int64]
) -> None:
    """Where two contacts became one, or one became two, let the stronger keep its number."""
    for t in range(MAX_TRACKS):
        track = tracks[t]
        if track.state != ACTIVE:
            continue
        if track.blob == NONE:
            # Two became one: its number is that of the stronger.
            for b in range(n):
                holder = track_of[b]
                if overlap[b, t] == 0 or holder == NONE or tracks[holder].state == MERGED:
                    continue
                weaker = tracks[holder].force_n < track.force_n
                if tracks[holder].force_n == track.force_n:
                    weaker = tracks[holder].number > track.number
                if weaker and overlap[b, holder] > 0:
                    tracks[holder].blob = NONE
                    track.blob = b
                    track_of[b] = t
                    break
        elif count_merged(t, tracks) == 0:
            # One became two: the stronger keeps its number.
            for b in range(n):
                if track_of[b] == NONE and overlap[b, t] > 0 and blobs[b].force_n > blobs[track.blob].force_n:
                    track_of[track.blob] = NONE
                    track.blob = b
                    track_of[b] = t


@kernel
def _begin(time_s: float, b: int, blobs: NDArray[Any], tracks: NDArray[Any], next_number: NDArray[np.int64]) -> int:
    """Begin a track of a contact, in a free place or that of the track that is gone for longest; return the place."""
    place = NONE
    for t in range(MAX_TRACKS):
        if tracks[t].state == FREE:
            place = t
            break
    if place == NONE:
        # There are twice as many places as active tracks; the one merged or away for longest goes. What comes back in
        # this frame is away until its update, but has a contact.
        longest = math.inf
        for t in range(MAX_TRACKS):
            since = tracks[t].merged_s if tracks[t].state == MERGED else tracks[t].seen_s
            if tracks[t].state != ACTIVE and tracks[t].blob == NONE and since < longest:
                longest = since
                place = t
        if tracks[place].state == MERGED:
            leave(place, tracks)
        for other in range(MAX_TRACKS):
            if tracks[other].state == MERGED and tracks[other].host == place:
                tracks[other].state = FREE
    track = tracks[place]
    track.number = next_number[0]
    next_number[0] = next_number[0] % (NUMBERS - 1) + 1
    track.state = ACTIVE
    track.host = NONE
    track.blob = b
    track.patch = blobs[b].patch
    track.x = track.y = math.inf
    track.vx = track.vy = 0.0
    track.began_s = time_s
    return place


@kernel
def direction(xx_m2: float, xy_m2: float, yy_m2: float, taxel_area_m2: float) -> float:
    """Direction of the longest extent, above -pi/2 to pi/2 [rad]; 0 where it is round within rounding."""
    rounding = _ROUNDING * (xx_m2 + yy_m2 + taxel_area_m2)
    if math.hypot(2.0 * xy_m2, xx_m2 - yy_m2) <= rounding:
        return 0.0
    # -pi/2 is the same direction as pi/2, and a negative zero would make it that.
    return 0.5 * math.atan2(2.0 * xy_m2 if abs(xy_m2) > rounding else 0.0, xx_m2 - yy_m2)


@kernel
def _report(
    time_s: float,
    n: int,
    blobs: NDArray[Any],
    taxel_area_m2: float,
    sigma_known: bool,
    tracks: NDArray[Any],
    track_of: NDArray[np.int64],
    found: NDArray[Any],
) -> None:
    """Write what is told of each contact into `found`, the oldest first."""
    for b in range(n):
        # The place by age is the number of older ones: numbers wrap, times do not.
        me = tracks[track_of[b]]
        place = 0
        for other in range(n):
            them = tracks[track_of[other]]
            if them.began_s < me.began_s or (them.began_s == me.began_s and them.number < me.number):
                place += 1
        blob, entry = blobs[b], found[place]
        entry.number = me.number
        entry.merged = count_merged(track_of[b], tracks)
        entry.age_s = time_s - me.began_s
        entry.x_m, entry.y_m = blob.x_m, blob.y_m
        entry.vx_m_s, entry.vy_m_s = me.vx, me.vy
        entry.force_n = blob.force_n
        entry.peak_counts = blob.peak_counts
        entry.area_m2 = blob.taxels * taxel_area_m2
        entry.active_taxels = blob.taxels
        entry.spread_m = math.sqrt(blob.xx_m2 + blob.yy_m2)
        entry.angle_rad = direction(blob.xx_m2, blob.xy_m2, blob.yy_m2, taxel_area_m2)
        entry.x_sd_m, entry.y_sd_m = math.sqrt(blob.x_var), math.sqrt(blob.y_var)
        entry.vx_sd_m_s = math.sqrt(max(me.x_vv, 0.0)) if sigma_known else 0.0
        entry.vy_sd_m_s = math.sqrt(max(me.y_vv, 0.0)) if sigma_known else 0.0
        entry.force_sd_n = math.sqrt(blob.force_var)
        entry.area_sd_m2 = taxel_area_m2 * math.sqrt(blob.taxels_var)
        entry.spread_sd_m = math.sqrt(entry.spread_m**2 + math.sqrt(blob.spread_square_var)) - entry.spread_m
