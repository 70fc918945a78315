# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings: how a baseline is measured, and follows drift."""

from __future__ import annotations

from dataclasses import dataclass

from acts_core.array import COUNT_MAX
from acts_core.settings import setting, validate
from acts_core.skin import TAXELS_RULE


@dataclass(frozen=True)
class BaselineConfig:
    """Settings of `BaselineTracker`.

    The driver sets `touch_counts`, `tau_s` and `dead_taxels` alone; the others are no parameters, and shorter in tests.
    """

    touch_counts: int = setting(
        60, "counts above its baseline at which a taxel is pressed", minimum=1, maximum=COUNT_MAX
    )
    tare_s: float = setting(
        0.25, "shortest time a tare is averaged over [s]; up to twice as long", minimum=0.01, maximum=10.0
    )
    calibration_blocks: int = setting(
        8, "shortest untouched time a calibration is made from, in times tare_s", minimum=1, maximum=100
    )
    tau_s: float = setting(
        60.0, "time constant of following the drift of untouched taxels [s]; 0: the baseline stays", minimum=0.0
    )
    hold_s: float = setting(1.0, "how long a baseline stays frozen after the touch [s]", minimum=0.0)
    dead_taxels: str = setting("", f"taxels that are never taken for touched: {TAXELS_RULE}")

    def __post_init__(self) -> None:
        validate(self)
