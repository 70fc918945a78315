# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings: where the edge of a contact is taken to be, and how it may move."""

from __future__ import annotations

from dataclasses import dataclass

from acts_core.settings import setting, validate


@dataclass(frozen=True)
class OutlinesConfig:
    """Settings of outlines. All become parameters of the reconstruction node."""

    outlines_level: float = setting(
        0.32,
        "edge of a contact: force of a taxel there, relative to the 60th percentile of the contact's taxels",
        minimum=0.05,
        maximum=0.9,
    )
    outlines_fast_s: float = setting(
        0.05,
        "younger contacts are followed as round or three-cornered shapes that move fast; older ones have any shape [s]",
        minimum=0.0,
        maximum=10.0,
    )

    def __post_init__(self) -> None:
        validate(self)
