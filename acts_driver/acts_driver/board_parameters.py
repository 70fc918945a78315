"""What the driver's parameters ask of a board: each either gives a setting or leaves the board's own."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from acts_core.array import COUNT_MAX, MAX_SIDE
from acts_core.errors import SettingsError
from acts_core.sampling import NEIGHBOURS, SCHEMES, SamplingConfig
from acts_core.settings import setting

RATE_MIN_HZ = 1.0
"""Slowest frame rate that a board can be told."""

_SAMPLING = ("scheme", "m", "threshold_counts", "neighbour_order", "search_share", "adaptive_share", "seed")


@dataclass(frozen=True)
class BoardParameters:
    """Parameters about sampling. The default of each leaves what the board does by itself."""

    scheme: str = setting(
        "", "how the board chooses the taxels of a frame; empty: the board's own", choices=("", *SCHEMES)
    )
    m: int = setting(0, "taxels measured per frame; 0: the board's own", minimum=0, maximum=MAX_SIDE**2)
    threshold_counts: int = setting(
        -1,
        "counts above which a taxel's neighbours are searched, or tracking follows it; -1: the board's own",
        minimum=-1,
        maximum=COUNT_MAX,
    )
    neighbour_order: str = setting(
        "", "order of the neighbour search; empty: the board's own", choices=("", *NEIGHBOURS)
    )
    search_share: float = setting(
        0.0, "share of a tracking frame that is kept for the search; 0: the board's own", minimum=0.0, maximum=1.0
    )
    adaptive_share: float = setting(
        0.0, "share of a hybrid frame that is chosen adaptively; 0: the board's own", minimum=0.0, maximum=1.0
    )
    rate_cap_hz: float = setting(
        0.0, "largest number of frames per second; 0: the board's own", minimum=0.0, maximum=1e6
    )
    seed: int = setting(-1, "seed of random and hybrid sampling; -1: the board's own", minimum=-1, maximum=2**63 - 1)

    def check_board_parameters(self) -> None:
        """Check what ranges alone cannot tell.

        Raises
        ------
        SettingsError
            Naming the parameter.
        """
        if 0 < self.rate_cap_hz < RATE_MIN_HZ:
            raise SettingsError(
                f"rate_cap_hz = {self.rate_cap_hz:g}: allowed is 0 (the board's own) or {RATE_MIN_HZ:g} and more"
            )

    def given(self) -> dict[str, Any]:
        """The parameters that ask for something, by name."""
        return {
            field.name: getattr(self, field.name)
            for field in fields(BoardParameters)
            if getattr(self, field.name) != field.default
        }

    def sampling(self, rows: int, cols: int) -> SamplingConfig:
        """How a board would sample that has the defaults of `SamplingConfig` where nothing is asked.

        Raises
        ------
        SettingsError
            When the parameters do not fit together or do not fit an array of `rows` x `cols`.
        """
        asked = {name: value for name, value in self.given().items() if name in _SAMPLING}
        return SamplingConfig(rows=rows, cols=cols, **asked)
