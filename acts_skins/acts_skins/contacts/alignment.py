# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames of several skins at one common time, and which skins are stale or lost. Does not depend on ROS."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Generic, TypeVar

from acts_core.errors import SettingsError
from acts_core.runtime import NS_PER_S, Pace
from acts_core.settings import setting, validate

F = TypeVar("F")

# Limit of frames that wait for other skins: more than any `align_s` needs at 4 kHz.
_MAX_WAITING = 4096
# Intervals between the frames of a slow skin after which it is lost.
_LOST_INTERVALS = 5.0


@dataclass(frozen=True)
class AlignmentConfig:
    """Time limits for skins that are slow, stale or lost."""

    align_s: float = setting(
        0.02,
        "the common time lags behind the newest skin at most by this, for slower skins [s]",
        minimum=0.0,
        maximum=1.0,
    )
    stale_after_s: float = setting(
        0.1,
        "a skin is stale when its newest contacts are older than this [s], and than 2.5 intervals between its frames",
        minimum=0.001,
        maximum=10.0,
    )
    lost_after_s: float = setting(
        0.5,
        "a skin is lost, and its contacts are no longer published, when they are older than this [s], and than 5 "
        "intervals between its frames",
        minimum=0.001,
        maximum=60.0,
    )
    future_s: float = setting(
        0.05,
        "contacts whose stamp lies further ahead of the clock than this are dropped [s]",
        minimum=0.0,
        maximum=10.0,
    )

    def __post_init__(self) -> None:
        validate(self)
        if self.lost_after_s < self.stale_after_s:
            raise SettingsError(
                f"lost_after_s = {self.lost_after_s:g}: allowed is stale_after_s ({self.stale_after_s:g}) or more"
            )


class SkinState(Enum):
    """Age of a skin's newest data, in three levels; see acts_msgs/SkinState."""

    FRESH = 0
    STALE = 1
    LOST = 2


@dataclass(frozen=True)
class AlignedSkin(Generic[F]):
    """One skin at the common time.

    Attributes
    ----------
    name : str
    state : SkinState
    stamp_ns : int or None
        Of `frame`.
    age_s : float
        Present age of `stamp_ns` [s].
    frame : object or None
        The newest frame at or before the common time; None if and only if the skin is lost.
    silent_s : float or None
        Time since the newest stamp of the skin [s]; None where none of its frames was in time yet.
    stale_after_s : float
        The age from which on this skin is stale, by its rate [s].
    """

    name: str
    state: SkinState
    stamp_ns: int | None
    age_s: float
    frame: F | None
    silent_s: float | None
    stale_after_s: float


@dataclass(frozen=True)
class Aligned(Generic[F]):
    """All skins at one time [ns]."""

    time_ns: int
    skins: tuple[AlignedSkin[F], ...]


@dataclass
class Counters:
    """Frames of a skin since the start.

    Attributes
    ----------
    frames : int
        All that were received.
    future, out_of_order : int
        Of these, dropped: stamped further ahead of the clock than `future_s`; not newer than the newest.
    ahead_s : float
        How far the last of `future` was ahead [s].
    late_s : float
        How old the last frame was when it was received [s]; negative where its stamp was ahead.
    """

    frames: int = 0
    future: int = 0
    out_of_order: int = 0
    ahead_s: float = 0.0
    late_s: float = 0.0


@dataclass
class _Skin(Generic[F]):
    waiting: deque[tuple[int, F]] = field(default_factory=lambda: deque(maxlen=_MAX_WAITING))
    chosen: tuple[int, F] | None = None
    newest_ns: int | None = None
    pace: Pace = field(default_factory=Pace)


class Aligner(Generic[F]):
    """Aligns frames of several skins, each with its time of measurement, to a common time.

    Of the newest stamps t of all fresh skins, the common time is max(min t, max t - `align_s`), and max t once that is
    `align_s` ago. It never decreases, unless the clock was set back.

    Parameters
    ----------
    names : sequence of str
        The skins.
    config : AlignmentConfig

    Attributes
    ----------
    counters : dict of str to Counters
        By the skin's name.
    clock_resets : int
        How often the clock was set back.
    """

    def __init__(self, names: Sequence[str], config: AlignmentConfig) -> None:
        self._config = config
        self._align_ns = round(config.align_s * NS_PER_S)
        self._future_ns = round(config.future_s * NS_PER_S)
        self._skins: dict[str, _Skin[F]] = {name: _Skin() for name in names}
        self._now_ns: int | None = None
        self._time_ns = 0
        self.clock_resets = 0
        self.counters = {name: Counters() for name in names}

    def take(self, name: str, stamp_ns: int, frame: F, now_ns: int) -> None:
        """Queue a frame.

        Parameters
        ----------
        name : str
            Of its skin.
        stamp_ns : int
            When it was measured [ns].
        frame : object
            Returned by `step`.
        now_ns : int
            The present, by the same clock [ns].
        """
        self._look_at_clock(now_ns)
        skin, counters = self._skins[name], self.counters[name]
        counters.frames += 1
        counters.late_s = (now_ns - stamp_ns) / NS_PER_S
        if stamp_ns > now_ns + self._future_ns:
            counters.future += 1
            counters.ahead_s = -counters.late_s
        elif skin.newest_ns is not None and stamp_ns <= skin.newest_ns:
            counters.out_of_order += 1
        else:
            skin.newest_ns = stamp_ns
            skin.pace.step(stamp_ns / NS_PER_S)
            skin.waiting.append((stamp_ns, frame))

    def step(self, now_ns: int) -> Aligned[F]:
        """All skins at the common time, which is later than `now_ns` by at most `future_s`."""
        self._look_at_clock(now_ns)
        fresh = [
            skin.newest_ns
            for skin in self._skins.values()
            if skin.newest_ns is not None and now_ns - skin.newest_ns <= self._stale_after_s(skin) * NS_PER_S
        ]
        if not fresh:
            # The remaining frames are returned with the present time.
            time_ns = now_ns
        elif now_ns - max(fresh) >= self._align_ns:
            # The next frame of a slow skin is far: this one waits no longer for the others.
            time_ns = max(fresh)
        else:
            time_ns = max(min(fresh), max(fresh) - self._align_ns)
        self._time_ns = max(self._time_ns, time_ns)
        return Aligned(self._time_ns, tuple(self._aligned(name, skin, now_ns) for name, skin in self._skins.items()))

    def _stale_after_s(self, skin: _Skin[F]) -> float:
        return skin.pace.limit_s(self._config.stale_after_s)

    def _aligned(self, name: str, skin: _Skin[F], now_ns: int) -> AlignedSkin[F]:
        while skin.waiting and skin.waiting[0][0] <= self._time_ns:
            skin.chosen = skin.waiting.popleft()
        stale_after_s = self._stale_after_s(skin)
        silent_s = None if skin.newest_ns is None else max(now_ns - skin.newest_ns, 0) / NS_PER_S
        if silent_s is not None and silent_s > skin.pace.limit_s(self._config.lost_after_s, _LOST_INTERVALS):
            skin.chosen = None
        elif skin.chosen is None:
            # A skin has just come (again), and its first frame is newer than the common time. It is not fresh yet:
            # fresh and without contacts would mean untouched, which nobody knows.
            silent_s = None
        elif self._time_ns - skin.chosen[0] > stale_after_s * NS_PER_S:
            # Likewise of one that was silent for a while: what is given of it is from before.
            silent_s = max(now_ns - skin.chosen[0], 0) / NS_PER_S
        if silent_s is None or skin.chosen is None:
            return AlignedSkin(name, SkinState.LOST, None, 0.0, None, silent_s, stale_after_s)
        state = SkinState.FRESH if silent_s <= stale_after_s else SkinState.STALE
        stamp_ns, frame = skin.chosen
        age_s = max(now_ns - stamp_ns, 0) / NS_PER_S
        return AlignedSkin(name, state, stamp_ns, age_s, frame, silent_s, stale_after_s)

    def _look_at_clock(self, now_ns: int) -> None:
        """Reset where the clock was set back, since all stamps would lie in the future."""
        if self._now_ns is not None and now_ns < self._now_ns - self._future_ns:
            self._skins = {name: _Skin() for name in self._skins}
            self._time_ns = 0
            self.clock_resets += 1
        self._now_ns = now_ns
