# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Parameters of the driver about baseline and calibration."""

from __future__ import annotations

from dataclasses import dataclass

from acts_core.array import COUNT_MAX
from acts_core.settings import Changeable, default_of, setting
from acts_driver.baseline.baseline_config import BaselineConfig


@dataclass(frozen=True)
class BaselineParameters:
    """See the descriptions; `docs/calibration.md` explains them."""

    calibration_file: str = setting(
        "",
        "npz file of the baseline: read at the start where it exists, written by ~/calibrate; empty or none: no file",
        changeable=Changeable.UNCONFIGURED,
    )
    calibration_touch_counts: int = setting(
        default_of(BaselineConfig, "touch_counts"),
        "counts above its baseline at which a taxel counts as pressed, for ~/calibrate to refuse",
        minimum=1,
        maximum=COUNT_MAX,
        changeable=Changeable.UNCONFIGURED,
    )
    baseline_tau_s: float = setting(
        default_of(BaselineConfig, "tau_s"),
        "time constant of following the drift of untouched taxels [s]; 0: the baseline stays",
        minimum=0.0,
        maximum=86_400.0,
        changeable=Changeable.UNCONFIGURED,
    )

    def baseline_config(self) -> BaselineConfig:
        """The settings of the tracker."""
        return BaselineConfig(touch_counts=self.calibration_touch_counts, tau_s=self.baseline_tau_s)
