# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings: when a foot has made a step."""

from __future__ import annotations

from dataclasses import dataclass

from acts_core.errors import SettingsError
from acts_core.settings import setting, validate


@dataclass(frozen=True)
class GaitConfig:
    """Settings of gait. Shares are of the way from the force under the lifted foot to that under the loaded one."""

    lifted_share: float = setting(
        0.25, "a foot below this share of its load is lifted; steps begin and end there", minimum=0.02, maximum=0.9
    )
    loaded_share: float = setting(
        0.40, "a touch is a step where the load rises above this share", minimum=0.05, maximum=0.95
    )
    least_change: float = setting(
        0.7,
        "a foot is only taken to lift where its force falls by this share: who stands on both feet and then on one "
        "doubles the force; an object in the shoe may press with the rest",
        minimum=0.05,
        maximum=0.99,
    )
    shortest_s: float = setting(0.08, "stances and swings that are shorter are no steps [s]", minimum=0.0, maximum=1.0)
    longest_gap_s: float = setting(
        0.5, "what a foot did while no sample came for longer is not known [s]", minimum=0.01, maximum=10.0
    )
    longest_stride_s: float = setting(
        10.0, "longer from strike to strike is a pause, not a stride [s]", minimum=0.5, maximum=60.0
    )
    learning_s: float = setting(
        30.0, "how long the forces under the lifted and the loaded foot are remembered [s]", minimum=5.0, maximum=600.0
    )
    summary_s: float = setting(
        30.0, "time over which cadence and the like are computed [s]", minimum=2.0, maximum=3600.0
    )

    def __post_init__(self) -> None:
        validate(self)
        if self.loaded_share <= self.lifted_share:
            raise SettingsError(
                f"loaded_share = {self.loaded_share:g}: allowed is above lifted_share ({self.lifted_share:g})"
            )
