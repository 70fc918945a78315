# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is done with the frames of a stream that come late."""

from __future__ import annotations

import enum

_LATE_NS = 20_000_000
_OLD_NS = 60_000_000
_VERY_OLD_NS = 100_000_000

_TOKEN = 10
"""What one late frame takes, in units of what a punctual one adds."""
_MOST = 100 * _TOKEN


class Use(enum.Enum):
    """What a frame is used for."""

    PUBLISH = enum.auto()
    """It is recovered, and what was found is published."""

    RECOVER = enum.auto()
    """It only updates the image."""

    NOTHING = enum.auto()
    """It is left out."""


class LateFrames:
    """Decides for each frame whether it is worth its time, by its age and by how many were late before it.

    A token bucket: a late frame (more than 20 ms old) is published for one token. The bucket holds 100 tokens; each
    punctual frame adds a tenth of one. So what stalls have held up is published, as long as stalls are rare. With too
    little CPU all frames are late and the bucket is empty: then a late frame only updates the image, and one more than
    60 ms old is left out. One more than 100 ms old is always left out.
    """

    def __init__(self) -> None:
        self._saved = _MOST

    def use(self, age_ns: int) -> Use:
        """What the next frame is used for.

        Parameters
        ----------
        age_ns : int
            Since its last measurement [ns].
        """
        if age_ns <= _LATE_NS:
            if self._saved < _MOST:
                self._saved += 1
            return Use.PUBLISH
        if age_ns > _VERY_OLD_NS:
            return Use.NOTHING
        if self._saved >= _TOKEN:
            self._saved -= _TOKEN
            return Use.PUBLISH
        return Use.RECOVER if age_ns <= _OLD_NS else Use.NOTHING
