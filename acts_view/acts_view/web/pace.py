# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""When to look for the next image: shortly after it has come. Knows no ROS.

Images come at a rate of their own. Looked for at any other moment they wait for half a period on average, and up to a
whole one.
"""

from __future__ import annotations

from collections.abc import Iterable

# Images of 30 Hz are frames of 1 kHz, so the times between them differ by a frame; and a busy machine adds to it.
_AFTER_S = 0.003
# An image that has not waited was nearly missed, or is one of a faster stream, where every moment is as good.
_LARGEST_DELAY = 0.01
# An image that is late is looked for again so soon, and so often.
_AGAIN_S = 0.006
_TIMES = 3


class Pace:
    """The times at which images are looked for.

    Parameters
    ----------
    period_s : float
        From one look to the next [s].
    """

    def __init__(self, period_s: float) -> None:
        self._period_s = period_s
        self._missed = _TIMES

    def later_s(self, waited_s: Iterable[float]) -> float:
        """How much later than a period after this look the next one is due [s]; below 0: sooner.

        Parameters
        ----------
        waited_s : iterable of float
            How long each image that was found had waited [s]; what cannot be, such as NaN, does not count. Of several
            skins the last image decides.
        """
        waited_s = [one for one in waited_s if 0.0 <= one <= self._period_s]
        if waited_s:
            self._missed = 0
            return min(max(_AFTER_S - min(waited_s), -self._period_s), _LARGEST_DELAY * self._period_s)
        self._missed += 1
        return min(_AGAIN_S - self._period_s, 0.0) if self._missed <= _TIMES else 0.0
