# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings: when motion counts as slip."""

from __future__ import annotations

from dataclasses import dataclass

from acts_core.settings import setting, validate


@dataclass(frozen=True)
class SlipConfig:
    """When motion counts as slip."""

    slip_window_s: float = setting(
        0.05, "motion is measured between now and this long ago [s]", minimum=0.002, maximum=1.0
    )
    slip_distance_m: float = setting(
        0.00015, "motion of less than this within the window is no slip [m]", minimum=1e-6, maximum=0.02
    )
    slip_distance_taxels: float = setting(
        0.07, "motion of less than this part of a taxel within the window is no slip", minimum=0.001, maximum=5.0
    )
    slip_sigmas: float = setting(
        5.0, "motion of fewer standard deviations than this is no slip", minimum=1.0, maximum=100.0
    )
    slip_together_share: float = setting(
        1.0,
        "share of slip_distance_m, slip_distance_taxels and slip_sigmas that suffices where two patches move at once",
        minimum=0.1,
        maximum=1.0,
    )
    slip_max_gain: float = setting(
        1.6,
        "no slip is reported while the force changes by a larger factor within the window",
        minimum=1.01,
        maximum=100.0,
    )
    slip_cut_taxels: float = setting(
        2.0,
        "a contact that the border of the patch cuts must move by this many taxels, times the logarithm of the factor "
        "by which the force has changed, times the pressure along the border relative to the peak",
        minimum=0.0,
        maximum=100.0,
    )
    slip_min_counts: float = setting(
        300.0, "no slip is reported of a patch with fewer counts in all", minimum=1.0, maximum=1e6
    )
    slip_max_lag_s: float = setting(
        0.015,
        "taxels measured at different times are interpolated to one moment, at most this long ago [s]",
        minimum=0.0,
        maximum=1.0,
    )
    slip_hold_s: float = setting(
        0.03, "slip is over when none was reported for longer than this [s]", minimum=0.0, maximum=1.0
    )

    def __post_init__(self) -> None:
        validate(self)
