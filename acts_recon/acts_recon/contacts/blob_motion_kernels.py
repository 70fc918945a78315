# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Prediction and update of tracks, in numba, without allocation; for `blob_track_kernels`.

A track is a Kalman filter of constant velocity for each axis, with white acceleration as process noise. The offset
between two merged tracks is an alpha-beta filter.
"""

from __future__ import annotations

import math
from typing import Any

from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_recon.contacts.blob_merge_kernels import count_merged, leave
from acts_recon.contacts.blob_tracks import ACTIVE, AWAY, FREE, MAX_TRACKS, MERGED, NONE

# Process noise: spectral density of the acceleration, that is the variance by which a velocity grows per second; and
# standard deviation of the velocity of a new track.
ACCELERATION_DENSITY_M2_S3 = 0.4
FIRST_SPEED_M_S = 0.7
# After a pause of the frames this long nothing is known of a track's velocity: it is expected where it was.
PAUSE_S = 0.1
# Error of the centre of pressure by sampling the skin in taxels: a taxel's side over sqrt(12) for one taxel, less for
# more; and what is assumed where the uncertainty of the image is not known.
SAMPLING_TAXELS = 0.29
UNKNOWN_TAXELS = 0.2
# Alpha-beta filter of the offset between two merged tracks, and the time constant with which its rate fades.
OFFSET_GAIN = 0.3
OFFSET_RATE_GAIN = 0.03
OFFSET_RATE_DECAY_S = 0.3


@kernel
def predict(time_s: float, dt_s: float, bridge_s: float, memory_s: float, tracks: NDArray[Any]) -> None:
    """Predict every track to the time of the frame, and drop those that were away or merged for too long."""
    gained = ACCELERATION_DENSITY_M2_S3 * dt_s
    decay = math.exp(-dt_s / OFFSET_RATE_DECAY_S)
    for t in range(MAX_TRACKS):
        track = tracks[t]
        track.blob = NONE
        if track.state == AWAY and time_s - track.seen_s > bridge_s:
            track.state = FREE
            for other in range(MAX_TRACKS):
                if tracks[other].state == MERGED and tracks[other].host == t:
                    tracks[other].state = FREE
        elif track.state == MERGED:
            track.dx += track.dvx * dt_s
            track.dy += track.dvy * dt_s
            track.dvx *= decay
            track.dvy *= decay
            if time_s - track.merged_s > memory_s:
                leave(t, tracks)
                track.state = FREE
        if track.state == ACTIVE or track.state == AWAY:
            if dt_s > PAUSE_S:
                track.vx = track.vy = track.x_pv = track.y_pv = 0.0
                track.x_vv = track.y_vv = FIRST_SPEED_M_S**2
            track.x += track.vx * dt_s
            track.y += track.vy * dt_s
            track.x_pp += dt_s * (2.0 * track.x_pv + dt_s * (track.x_vv + gained / 3.0))
            track.x_pv += dt_s * (track.x_vv + gained / 2.0)
            track.x_vv += gained
            track.y_pp += dt_s * (2.0 * track.y_pv + dt_s * (track.y_vv + gained / 3.0))
            track.y_pv += dt_s * (track.y_vv + gained / 2.0)
            track.y_vv += gained


@kernel
def update(
    time_s: float,
    dt_s: float,
    blob: Any,
    pitch_m: float,
    pitch_y_m: float,
    sigma_known: bool,
    t: int,
    tracks: NDArray[Any],
) -> None:
    """Update a track by its contact."""
    track = tracks[t]
    floor = SAMPLING_TAXELS / blob.taxels
    square = floor * floor + (0.0 if sigma_known else UNKNOWN_TAXELS**2)
    x_var = blob.x_var + square * pitch_m**2
    y_var = blob.y_var + square * pitch_y_m**2
    jump = track.x == math.inf
    if not jump:
        dx, dy = blob.x_m - track.x, blob.y_m - track.y
        jump = abs(dx) > 0.5 * pitch_m + 3.0 * math.sqrt(track.x_pp + x_var)
        jump = jump or abs(dy) > 0.5 * pitch_y_m + 3.0 * math.sqrt(track.y_pp + y_var)
    if jump:
        # New, merged or split: the innovation is no motion, so the position is set and the velocity stays.
        track.x, track.y = blob.x_m, blob.y_m
        track.x_pp, track.y_pp = x_var, y_var
        track.x_pv = track.y_pv = 0.0
        track.x_vv = track.y_vv = FIRST_SPEED_M_S**2
    else:
        total = track.x_pp + x_var
        gain, rate_gain = track.x_pp / total, track.x_pv / total
        track.x += gain * dx
        track.vx += rate_gain * dx
        track.x_vv -= rate_gain * track.x_pv
        track.x_pv *= 1.0 - gain
        track.x_pp *= 1.0 - gain
        total = track.y_pp + y_var
        gain, rate_gain = track.y_pp / total, track.y_pv / total
        track.y += gain * dy
        track.vy += rate_gain * dy
        track.y_vv -= rate_gain * track.y_pv
        track.y_pv *= 1.0 - gain
        track.y_pp *= 1.0 - gain
    track.state = ACTIVE
    track.seen_s = time_s
    track.force_n = blob.force_n
    guests = count_merged(t, tracks)
    if guests == 0:
        track.xx_m2, track.xy_m2, track.yy_m2 = blob.xx_m2, blob.xy_m2, blob.yy_m2
    elif guests == 1 and not jump and dt_s > 0.0:
        _follow_offset(dt_s, blob, pitch_m, t, tracks)


@kernel
def _follow_offset(dt_s: float, blob: Any, pitch_m: float, t: int, tracks: NDArray[Any]) -> None:
    """Update the offset between the two tracks of one contact, by the contact's second moments.

    Along an axis, the contact's second moment is ``(1 - w) m_host + w m_guest + w (1 - w) d^2``, with d the distance of
    the two and w the guest's share of the force. That gives d but not its sign, which is taken from the frame before;
    where they pass through one another, from their velocities.
    """
    for g in range(MAX_TRACKS):
        if tracks[g].state == MERGED and tracks[g].host == t:
            break
    guest, host = tracks[g], tracks[t]
    w = guest.share
    xx = blob.xx_m2 - (1.0 - w) * host.xx_m2 - w * guest.xx_m2
    xy = blob.xy_m2 - (1.0 - w) * host.xy_m2 - w * guest.xy_m2
    yy = blob.yy_m2 - (1.0 - w) * host.yy_m2 - w * guest.yy_m2
    largest = 0.5 * (xx + yy) + math.hypot(0.5 * (xx - yy), xy)
    distance = math.sqrt(max(largest, 0.0) / max(w * (1.0 - w), 1e-3))
    if distance < pitch_m:
        return
    angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
    x, y = distance * math.cos(angle), distance * math.sin(angle)
    if x * guest.dx + y * guest.dy < 0.0:
        x, y = -x, -y
    x -= guest.dx
    y -= guest.dy
    guest.dx += OFFSET_GAIN * x
    guest.dy += OFFSET_GAIN * y
    guest.dvx += OFFSET_RATE_GAIN * x / dt_s
    guest.dvy += OFFSET_RATE_GAIN * y / dt_s
