# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reference implementation of `blob_track_kernels` and of the kernels that it uses."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from blobs_reference import Blob, find_blobs
from contact_reference import root_deviation
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.skin import Response, TrackedBlob
from acts_recon.contacts import BlobConfig
from acts_recon.contacts.blob_motion_kernels import (
    ACCELERATION_DENSITY_M2_S3,
    FIRST_SPEED_M_S,
    OFFSET_GAIN,
    OFFSET_RATE_DECAY_S,
    OFFSET_RATE_GAIN,
    PAUSE_S,
    SAMPLING_TAXELS,
    UNKNOWN_TAXELS,
)
from acts_recon.contacts.blob_track_kernels import FASTEST_M_S, GATE_TAXELS, LEAST_SHARE, direction
from acts_recon.contacts.blob_tracks import MAX_TRACKS
from acts_recon.images import Borders

Vector = NDArray[np.float64]

ACTIVE, AWAY, MERGED = "active", "away", "merged"


def _nowhere() -> Vector:
    return np.zeros(2)


@dataclass(eq=False)
class Track:
    """A contact with a number, as `acts_recon.contacts.blob_tracks.TRACK`; vectors are x and y."""

    number: int
    began_s: float
    patch: int = 0
    state: str = ACTIVE
    blob: int | None = None
    # None: follows from the contact.
    position: Vector | None = None
    velocity: Vector = field(default_factory=_nowhere)
    position_var: Vector = field(default_factory=_nowhere)
    covariance: Vector = field(default_factory=_nowhere)
    velocity_var: Vector = field(default_factory=_nowhere)
    force_n: float = 0.0
    moments_m2: Vector = field(default_factory=lambda: np.zeros(3))
    seen_s: float = 0.0
    host: Track | None = None
    merged_s: float = 0.0
    offset: Vector = field(default_factory=_nowhere)
    offset_rate: Vector = field(default_factory=_nowhere)
    share: float = 0.0


class BlobTrackerReference:
    """Finds the contacts in image after image and keeps their numbers, as `blob_tracker.BlobTracker`.

    Parameters
    ----------
    geometry : ArrayGeometry
    response : Response
    config : BlobConfig
    borders : Borders, optional
    """

    def __init__(
        self,
        geometry: ArrayGeometry,
        response: Response,
        config: BlobConfig,
        borders: Borders | None = None,
    ) -> None:
        self._borders = borders
        self._geometry = geometry
        self._response = response
        self._config = config
        self._pitch = np.array([geometry.pitch_m, geometry.pitch_y_m])
        self._pressed = np.zeros((geometry.rows, geometry.cols), dtype=np.bool_)
        # Places are kept until they are needed again: where several of them could be meant, the first is.
        self._places: list[Track | None] = [None] * MAX_TRACKS
        self._owner: dict[int, Track] = {}
        self._next_number = 1

    def step(
        self, image: NDArray[np.float32], time_s: float, dt_s: float, sigma: NDArray[np.float32] | None = None
    ) -> list[TrackedBlob]:
        """Find the contacts of the next frame, `dt_s` after the one before."""
        config = self._config
        blobs = find_blobs(
            image,
            self._geometry,
            self._response,
            config,
            sigma=sigma,
            pressed_before=self._pressed,
            borders=self._borders,
        )
        self._pressed = image > np.where(self._pressed, config.release_counts, config.touch_counts)
        self._predict(time_s, dt_s)
        overlap = [self._count_owners(blob) for blob in blobs]
        track_of: list[Track | None] = [None] * len(blobs)
        self._assign(self._weigh(time_s, blobs, overlap), track_of)
        self._prefer_the_stronger(blobs, overlap, track_of)
        for track in self._in_state(MERGED):
            if track.blob is not None:
                self._part(track)
        for track in self._in_state(ACTIVE):
            if track.blob is not None:
                continue
            host = self._covering(track, overlap, track_of)
            if host is None:
                track.state = AWAY
            else:
                self._merge(time_s, track, host, blobs)
        named = [track_of[b] or self._begin(time_s, b, blob.patch) for b, blob in enumerate(blobs)]
        for track, blob in zip(named, blobs, strict=True):
            self._update(time_s, dt_s, track, blob, sigma is not None)
        # The taxels of a track that is away stay its own until another contact covers them.
        self._owner = {taxel: track for taxel, track in self._owner.items() if track.state == AWAY}
        for track, blob in zip(named, blobs, strict=True):
            self._owner.update(dict.fromkeys(blob.taxels.tolist(), track))
        pairs = sorted(zip(named, blobs, strict=True), key=lambda pair: (pair[0].began_s, pair[0].number))
        return [self._report(time_s, track, blob, sigma is not None) for track, blob in pairs]

    def _tracks(self) -> list[Track]:
        return [track for track in self._places if track is not None]

    def _in_state(self, *states: str) -> Iterable[Track]:
        """Those that still are in one of the states when it is their turn."""
        return (track for track in self._tracks() if track.state in states)

    def _guests(self, host: Track) -> list[Track]:
        return [track for track in self._tracks() if track.state == MERGED and track.host is host]

    def _forget(self, *tracks: Track) -> None:
        self._places = [None if any(place is track for track in tracks) else place for place in self._places]
        self._owner = {taxel: track for taxel, track in self._owner.items() if track not in tracks}

    def _own_part(self, track: Track) -> Vector:
        """Expected position of a track itself, without the tracks merged into it."""
        assert track.position is not None
        return track.position - sum((guest.share * guest.offset for guest in self._guests(track)), np.zeros(2))

    def _leave(self, track: Track) -> None:
        """Scale the force shares of the tracks that stay merged when this one leaves."""
        assert track.host is not None
        for other in self._guests(track.host):
            if other is not track:
                other.share = min(other.share / max(1 - track.share, 1e-3), 1.0)

    def _predict(self, time_s: float, dt_s: float) -> None:
        gained = ACCELERATION_DENSITY_M2_S3 * dt_s
        for track in self._tracks():
            track.blob = None
            if track.state == AWAY and time_s - track.seen_s > self._config.bridge_s:
                self._forget(track, *self._guests(track))
            elif track.state == MERGED:
                track.offset = track.offset + track.offset_rate * dt_s
                track.offset_rate = track.offset_rate * math.exp(-dt_s / OFFSET_RATE_DECAY_S)
                if time_s - track.merged_s > self._config.memory_s:
                    self._leave(track)
                    self._forget(track)
        for track in self._in_state(ACTIVE, AWAY):
            assert track.position is not None
            if dt_s > PAUSE_S:
                track.velocity, track.covariance = np.zeros(2), np.zeros(2)
                track.velocity_var = np.full(2, FIRST_SPEED_M_S**2)
            track.position = track.position + track.velocity * dt_s
            # With white acceleration in between.
            track.position_var = (
                track.position_var + 2 * dt_s * track.covariance + dt_s**2 * track.velocity_var + gained * dt_s**2 / 3
            )
            track.covariance = track.covariance + dt_s * track.velocity_var + gained * dt_s / 2
            track.velocity_var = track.velocity_var + gained

    def _count_owners(self, blob: Blob) -> dict[Track, int]:
        """How many taxels of a contact were whose."""
        counts: dict[Track, int] = {}
        for taxel in blob.taxels.tolist():
            if taxel in self._owner:
                counts[self._owner[taxel]] = counts.get(self._owner[taxel], 0) + 1
        return counts

    def _weigh(
        self, time_s: float, blobs: list[Blob], overlap: list[dict[Track, int]]
    ) -> list[tuple[float, int, int, Track]]:
        """Cost, number, contact and track of every pair that is possible."""
        pitch = math.sqrt(self._pitch[0] * self._pitch[1])
        pairs = []
        for track in self._in_state(ACTIVE, AWAY):
            assert track.position is not None
            covering = [b for b in range(len(blobs)) if track in overlap[b]]
            guests = self._guests(track)
            parts = len(covering) >= 2 and len(guests) > 0
            at = self._own_part(track) if parts else track.position
            reach = FASTEST_M_S * min(time_s - track.seen_s, self._config.bridge_s)
            further = min(3 * math.sqrt(track.position_var.max()), reach)
            for b, blob in enumerate(blobs):
                if blob.patch != track.patch:
                    continue
                away = np.array([blob.x_m, blob.y_m]) - at
                distance, taxels = math.hypot(*away), math.hypot(*(away / self._pitch))
                if b in covering:
                    pairs.append((distance, track.number, b, track))
                elif taxels < GATE_TAXELS or distance * (1 - GATE_TAXELS / taxels) < further:
                    pairs.append((distance + pitch, track.number, b, track))
            if not parts:
                continue
            for guest in guests:
                x, y = at + guest.offset
                for b in covering:
                    if blobs[b].force_n > LEAST_SHARE * guest.share * track.force_n:
                        pairs.append((math.hypot(blobs[b].x_m - x, blobs[b].y_m - y), guest.number, b, guest))
        return pairs

    def _assign(self, pairs: list[tuple[float, int, int, Track]], track_of: list[Track | None]) -> None:
        for _, _, b, track in sorted(pairs, key=lambda pair: pair[:3]):
            if track.blob is None and track_of[b] is None:
                track.blob, track_of[b] = b, track

    def _prefer_the_stronger(
        self, blobs: list[Blob], overlap: list[dict[Track, int]], track_of: list[Track | None]
    ) -> None:
        for track in self._in_state(ACTIVE):
            if track.blob is None:
                # Merge: the contact has the number of the stronger.
                for b in range(len(blobs)):
                    holder = track_of[b]
                    if track not in overlap[b] or holder is None or holder.state == MERGED:
                        continue
                    weaker = (holder.force_n, -holder.number) < (track.force_n, -track.number)
                    if weaker and holder in overlap[b]:
                        holder.blob = None
                        track.blob, track_of[b] = b, track
                        break
            elif not self._guests(track):
                # Split: the stronger contact keeps the number.
                for b, blob in enumerate(blobs):
                    if track_of[b] is None and track in overlap[b] and blob.force_n > blobs[track.blob].force_n:
                        track_of[track.blob] = None
                        track.blob, track_of[b] = b, track

    def _part(self, track: Track) -> None:
        """Split: make every merged track active that has a contact of its own again."""
        host = track.host
        assert host is not None
        host.velocity = host.velocity - track.share * track.offset_rate
        track.velocity = host.velocity + track.offset_rate
        track.position = None
        if host.position is not None:
            host.position = host.position - track.share * track.offset
        self._leave(track)
        track.state, track.host = ACTIVE, None

    def _covering(self, track: Track, overlap: list[dict[Track, int]], track_of: list[Track | None]) -> Track | None:
        """The track whose contact covers most of what was another's."""
        most, host = 0, None
        for holder, counts in zip(track_of, overlap, strict=True):
            if holder is not None and counts.get(track, 0) > most:
                most, host = counts[track], holder
        return host

    def _merge(self, time_s: float, track: Track, host: Track, blobs: list[Blob]) -> None:
        if host.position is None:
            # The host has just split from this track, which now merges into it: its position is its contact's.
            assert host.blob is not None
            host.position = np.array([blobs[host.blob].x_m, blobs[host.blob].y_m])
        apart = self._own_part(track) - self._own_part(host)
        share = track.force_n / max(track.force_n + host.force_n, 1e-30)
        own_guests, host_guests = self._guests(track), self._guests(host)
        own = max(1 - sum(guest.share for guest in own_guests), 0.0)
        for guest in own_guests:
            guest.host = host
            guest.share *= share
            guest.offset = guest.offset + apart
            guest.offset_rate = np.zeros(2)
        for guest in host_guests:
            guest.share *= 1 - share
            guest.offset_rate = np.zeros(2)
        track.state, track.host, track.merged_s = MERGED, host, time_s
        track.share = share * own
        track.offset, track.offset_rate = apart, track.velocity - host.velocity
        host.velocity = host.velocity + share * track.offset_rate
        if len(self._guests(host)) > 1:
            # The second moments of one contact cannot locate more than two tracks: their offsets stay as they are.
            track.offset_rate = np.zeros(2)
        host.position = None

    def _begin(self, time_s: float, b: int, patch: int) -> Track:
        if None not in self._places:
            # There are twice as many places as active tracks; the one merged or away for longest goes.
            oldest = min(
                (track for track in self._tracks() if track.state != ACTIVE and track.blob is None),
                key=lambda track: track.merged_s if track.state == MERGED else track.seen_s,
            )
            if oldest.state == MERGED:
                self._leave(oldest)
            self._forget(oldest, *self._guests(oldest))
        track = Track(self._next_number, time_s, patch, blob=b)
        self._next_number += 1
        self._places[self._places.index(None)] = track
        return track

    def _update(self, time_s: float, dt_s: float, track: Track, blob: Blob, sigma_known: bool) -> None:
        """Update a track by its contact."""
        found = np.array([blob.x_m, blob.y_m])
        sampling = (SAMPLING_TAXELS / blob.active_taxels) ** 2 + (0.0 if sigma_known else UNKNOWN_TAXELS**2)
        found_var = np.array([blob.x_var, blob.y_var]) + sampling * self._pitch**2
        jump = track.position is None or bool(
            (np.abs(found - track.position) > self._pitch / 2 + 3 * np.sqrt(track.position_var + found_var)).any()
        )
        if track.position is None or jump:
            # New, merged or split: the innovation is no motion, so the position is set and the velocity stays.
            track.position, track.position_var = found, found_var
            track.covariance, track.velocity_var = np.zeros(2), np.full(2, FIRST_SPEED_M_S**2)
        else:
            gain = track.position_var / (track.position_var + found_var)
            rate_gain = track.covariance / (track.position_var + found_var)
            error = found - track.position
            track.position = track.position + gain * error
            track.velocity = track.velocity + rate_gain * error
            track.velocity_var = track.velocity_var - rate_gain * track.covariance
            track.covariance = track.covariance * (1 - gain)
            track.position_var = track.position_var * (1 - gain)
        track.state, track.seen_s, track.force_n = ACTIVE, time_s, blob.force_n
        guests = self._guests(track)
        if not guests:
            track.moments_m2 = np.array(blob.moments_m2)
        elif len(guests) == 1 and not jump and dt_s > 0:
            self._follow_offset(dt_s, track, guests[0], blob)

    def _follow_offset(self, dt_s: float, host: Track, guest: Track, blob: Blob) -> None:
        """Update the offset between the two tracks of one contact; see `acts_recon.contacts.blob_motion_kernels`."""
        w = guest.share
        xx, xy, yy = np.array(blob.moments_m2) - (1 - w) * host.moments_m2 - w * guest.moments_m2
        values, directions = np.linalg.eigh([[xx, xy], [xy, yy]])
        distance = math.sqrt(max(values[1], 0.0) / max(w * (1 - w), 1e-3))
        if distance < self._pitch[0]:
            return
        apart = distance * directions[:, 1]
        along = float(apart @ guest.offset)
        if along < 0 or (along == 0 and apart[0] < 0):
            apart = -apart
        error = apart - guest.offset
        guest.offset = guest.offset + OFFSET_GAIN * error
        guest.offset_rate = guest.offset_rate + OFFSET_RATE_GAIN * error / dt_s

    def _report(self, time_s: float, track: Track, blob: Blob, sigma_known: bool) -> TrackedBlob:
        xx, xy, yy = blob.moments_m2
        deviations = np.sqrt(np.maximum(track.velocity_var, 0)) if sigma_known else np.zeros(2)
        area_m2 = self._geometry.taxel_area_m2
        return TrackedBlob(
            number=track.number,
            merged=len(self._guests(track)),
            age_s=time_s - track.began_s,
            x_m=blob.x_m,
            y_m=blob.y_m,
            vx_m_s=float(track.velocity[0]),
            vy_m_s=float(track.velocity[1]),
            force_n=blob.force_n,
            peak_counts=blob.peak_counts,
            area_m2=blob.active_taxels * area_m2,
            active_taxels=blob.active_taxels,
            spread_m=math.sqrt(xx + yy),
            angle_rad=direction(xx, xy, yy, area_m2),
            x_sd_m=math.sqrt(blob.x_var),
            y_sd_m=math.sqrt(blob.y_var),
            vx_sd_m_s=float(deviations[0]),
            vy_sd_m_s=float(deviations[1]),
            force_sd_n=math.sqrt(blob.force_var),
            area_sd_m2=math.sqrt(blob.taxels_var) * area_m2,
            spread_sd_m=root_deviation(xx + yy, blob.spread_square_var),
        )
