# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings: which vibrations are looked for, and in how long a time."""

from __future__ import annotations

from dataclasses import dataclass

from acts_core.settings import setting, validate


@dataclass(frozen=True)
class SpectraConfig:
    """Settings of spectra. All become parameters of the reconstruction node."""

    spectra_window_s: float = setting(
        1.0, "length of a spectrum's window; tones nearer than 2 over this are one [s]", minimum=0.1, maximum=10.0
    )
    spectra_lowest_hz: float = setting(
        5.0, "peaks below this are not reported, because hands and arms move so [Hz]", minimum=0.0, maximum=1000.0
    )
    spectra_peaks: int = setting(8, "largest number of peaks that are reported of one contact", minimum=1, maximum=50)
    spectra_of: str = setting(
        "contacts",
        "what has a spectrum of its own: each contact, or all that touches one patch of the layout",
        choices=("contacts", "patches"),
    )

    def __post_init__(self) -> None:
        validate(self)
