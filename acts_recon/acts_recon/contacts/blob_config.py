# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings of how contacts are told from one another and followed."""

from __future__ import annotations

from dataclasses import dataclass

from acts_core.array import COUNT_MAX, TOUCH_COUNTS
from acts_core.settings import setting, validate
from acts_recon.images import ERR_TOGETHER, NOISE_COUNTS


@dataclass(frozen=True)
class BlobConfig:
    """Settings of contacts with numbers; the node sets all but `err_together`, which is no parameter."""

    touch_counts: int = setting(
        TOUCH_COUNTS, "counts above which a taxel becomes pressed", minimum=0, maximum=COUNT_MAX
    )
    hysteresis_counts: int = setting(
        10, "a pressed taxel is released at this many counts less; never below 0", minimum=0, maximum=COUNT_MAX
    )
    noise_counts: float = setting(
        NOISE_COUNTS,
        "standard deviation of a reading; what an image's is beyond it is that of a guess [counts]",
        minimum=0.0,
        maximum=100.0,
    )
    err_together: float = setting(
        ERR_TOGETHER, "guesses that err together: as many as this are one independent error", minimum=1.0, maximum=100.0
    )
    bridge_s: float = setting(
        0.02, "a contact that comes back within this time keeps its number [s]", minimum=0.0, maximum=10.0
    )
    memory_s: float = setting(
        10.0, "contacts that became one get their numbers back within this time [s]", minimum=0.0, maximum=1000.0
    )

    def __post_init__(self) -> None:
        validate(self)

    @property
    def release_counts(self) -> int:
        """Counts at or below which a pressed taxel ceases to be."""
        return max(self.touch_counts - self.hysteresis_counts, 0)
