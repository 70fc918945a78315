# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""When a touch is an impact, a tap, a press, a step or a slide."""

from __future__ import annotations

from dataclasses import dataclass, replace

from acts_core.settings import setting, validate

_JOIN_M = 0.025
# Heel and toes are one touch.
_SOLE_M = 0.3
_STEP_M2 = 0.0025
_NO_STEP_M2 = 1.0


@dataclass(frozen=True)
class ImpactConfig:
    """Settings of impacts. All become parameters of the reconstruction node."""

    impact_longest_s: float = setting(0.04, "longest duration of an impact [s]", minimum=0.005, maximum=0.5)
    impact_rise_s: float = setting(
        0.02, "the force of an impact that stays is largest within this time [s]", minimum=0.001, maximum=0.5
    )
    impact_quiet_s: float = setting(
        0.003, "a touch is over when nothing was felt for this time and a frame [s]", minimum=0.0, maximum=0.5
    )
    impact_join_m: float = setting(
        0.0,
        f"contacts nearer than this are one impact [m]; 0: {_JOIN_M:g}, and {_SOLE_M:g} where the layout is stood on",
        minimum=0.0,
        maximum=1.0,
    )
    impact_tap_s: float = setting(0.3, "what touches for longer than this is no tap [s]", minimum=0.01, maximum=10.0)
    impact_slide_m: float = setting(
        0.015, "what moves further than this, and than its own size, slides [m]", minimum=0.001, maximum=1.0
    )
    impact_step_m2: float = setting(
        0.0,
        f"what is larger than this, and no impact, is a step [m^2]; 0: {_STEP_M2:g}, and nothing where the layout is "
        "not stood on",
        minimum=0.0,
        maximum=1.0,
    )

    impact_foam_spread_m: float = setting(
        0.002,
        "how far pressure spreads sideways in the skin's foam, for the onset of slow touches [m]",
        minimum=0.0,
        maximum=0.05,
    )

    def __post_init__(self) -> None:
        validate(self)

    def on(self, *, stood_on: bool | None) -> ImpactConfig:
        """With what is left to the skin in its place.

        Parameters
        ----------
        stood_on : bool or None
            As of `acts_core.skin.Layout`.
        """
        return replace(
            self,
            impact_join_m=self.impact_join_m or (_SOLE_M if stood_on else _JOIN_M),
            impact_step_m2=self.impact_step_m2 or (_NO_STEP_M2 if stood_on is False else _STEP_M2),
        )
