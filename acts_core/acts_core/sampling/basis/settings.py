# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The settings of sampling: those that several schemes share, and what a scheme's own setting is."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from acts_core.array import COUNT_MAX, MAX_SIDE
from acts_core.errors import SettingsError
from acts_core.settings import SettingValue, setting

NEIGHBOURS: dict[str, tuple[tuple[int, int], ...]] = {
    # Columns outer, the taxel's own first: the published sketches.
    "columns": ((-1, 0), (1, 0), (-1, -1), (0, -1), (1, -1), (-1, 1), (0, 1), (1, 1)),
    # Rows outer: fits the adaptive frames of the paper's figures 4 and 5.
    "rows": ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)),
}
"""Steps (rows, columns) to the eight neighbours of a taxel in the order of search, by neighbour order."""

# Smaller shares would all mean the same: one taxel of even the largest array.
SHARE_MIN = 0.0001

# More than the product of a share and of the largest array's taxels is off in binary: 0.55 * 100 is 55.00000000000001.
_ROUNDING = 1e-9


def quota_of(share: float, m: int) -> int:
    """The number of taxels that is a share (above 0, up to 1) of `m`, rounded up; as acts_firmware has it."""
    return max(math.ceil(share * m - _ROUNDING), 1)


@dataclass(frozen=True)
class Share:
    """How a user gives a number of taxels: as a share of the frame, `SHARE_MIN` to 1.

    Attributes
    ----------
    name : str
        Of the parameter and, with hyphens, of the option.
    description : str
    default : float
    """

    name: str
    description: str
    default: float


@dataclass(frozen=True)
class OwnSetting:
    """A setting that only one scheme has: a whole number of 0 to 65535.

    Attributes
    ----------
    name : str
        Of the board's setting, and of the parameter and option unless there is a `share`.
    description : str
    default, minimum, maximum : int
        What a board has after a reset, and what it takes.
    number : int or None
        On the wire: 7, 8, then 14 and on, each given once. None: no board has it.
    share : Share, optional
        How a user gives it: the setting is that share of `m`, rounded up, and 1 to `m` in a frame of its scheme.
    below : str
        "rows" or "cols": less than that in a frame of its scheme. Empty: no such limit.
    """

    name: str
    description: str
    default: int
    minimum: int
    maximum: int
    number: int | None = None
    share: Share | None = None
    below: str = ""

    @property
    def parameter(self) -> str:
        """Name of what a user gives."""
        return self.share.name if self.share else self.name

    @property
    def parameter_description(self) -> str:
        """Description of what a user gives."""
        return self.share.description if self.share else self.description

    @property
    def parameter_default(self) -> float:
        """Default of what a user gives: a float for a share."""
        return self.share.default if self.share else self.default

    def as_parameter(self) -> Any:
        """What a user gives, as a field of a settings class."""
        if self.share:
            return setting(self.share.default, self.share.description, minimum=SHARE_MIN, maximum=1.0)
        return self.as_board_setting()

    def as_board_setting(self) -> Any:
        """What a board is told, as a field of a settings class."""
        return setting(self.default, self.description, minimum=self.minimum, maximum=self.maximum)

    def board_value(self, given: float, m: int) -> int:
        """What a board is told where a user gives this."""
        return quota_of(given, m) if self.share else int(given)

    def check(self, value: int, rows: int, cols: int, m: int, scheme: str) -> None:
        """Check what a board is told in frames of the setting's scheme.

        Raises
        ------
        SettingsError
        """
        if self.share and not 1 <= value <= m:
            raise SettingsError(f"{self.name} = {value}: allowed is 1 to m = {m} of a {scheme} frame")
        side = {"rows": rows, "cols": cols}.get(self.below)
        if side is not None and value >= side:
            raise SettingsError(
                f"{self.name} = {value}: allowed is 0 to {side - 1} of a {scheme} frame of {rows} x {cols} taxels"
            )


def with_fields(name: str, fields: Mapping[str, Any], **namespace: Any) -> Any:
    """A frozen dataclass of fields made by `setting`, to be inherited from; given by their names only.

    Parameters
    ----------
    name : str
    fields : mapping of str to field
    **namespace
        Further attributes, such as properties.
    """
    given: list[tuple[str, type, SettingValue]] = [(key, type(field.default), field) for key, field in fields.items()]
    return dataclasses.make_dataclass(name, given, namespace=namespace, frozen=True, kw_only=True)


@dataclass(frozen=True)
class CommonSettings:
    """The settings that all schemes or several have."""

    scheme: str = "adaptive"
    rows: int = setting(32, "rows of the array", minimum=1, maximum=MAX_SIDE)
    cols: int = setting(32, "columns of the array", minimum=1, maximum=MAX_SIDE)
    m: int = setting(55, "taxels measured per frame; raster measures all", minimum=1, maximum=MAX_SIDE**2)
    threshold_counts: int = setting(
        180,
        "counts above which adaptive and hybrid search a taxel's neighbours and tracking follows it",
        minimum=0,
        maximum=COUNT_MAX,
    )
    neighbour_order: str = setting("columns", "order of the neighbour search", choices=tuple(NEIGHBOURS))
    seed: int = setting(1, "seed of random and hybrid sampling", minimum=0, maximum=2**64 - 1)

    def own(self, setting: OwnSetting) -> int:
        """The value of a scheme's own setting, as a board has it."""
        return setting.board_value(getattr(self, setting.parameter), self.m)
