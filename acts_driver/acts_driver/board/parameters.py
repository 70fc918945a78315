# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The driver's parameters for the board: each sets a setting of the board, or leaves the board's own."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from inspect import get_annotations
from typing import Any

from acts_core.array import COUNT_MAX, MAX_SIDE
from acts_core.errors import SettingsError
from acts_core.sampling import (
    BOARD_OWN_SETTINGS,
    NEIGHBOURS,
    SCHEME_NUMBERS,
    SCHEMES,
    OwnSetting,
    SamplingConfig,
    SkinMap,
    check_names,
    quota_of,
    with_fields,
)
from acts_core.settings import Changeable, setting
from acts_core.skin import LAYOUTS, TAXELS_RULE, dead_taxels_named, layout, layout_path
from acts_core.wire import LEDS, OUTPUTS, BoardSettings

RATE_MIN_HZ = 1.0
"""Slowest frame rate that a board accepts."""

# In microseconds, so that a rate of 1 / (333 us) does not become one of 1 / (334 us).
_ROUNDING_US = 1e-6

_OWN = tuple(BOARD_OWN_SETTINGS.values())
_SAMPLING = (
    *("scheme", "m", "threshold_counts", "neighbour_order", "seed"),
    *(own.parameter for own in _OWN),
)


def _own_parameter(own: OwnSetting) -> Any:
    """The parameter of a scheme's own setting: 0, or -1 where 0 could be meant, leaves the board's own."""
    unset: float = 0.0 if own.share else -1
    return setting(
        unset,
        f"{own.parameter_description}; {unset:g}: the board's own",
        minimum=unset,
        maximum=1.0 if own.share else own.maximum,
        changeable=Changeable.RUNNING,
    )


_Own: Any = with_fields("_Own", {own.parameter: _own_parameter(own) for own in _OWN})


@dataclass(frozen=True)
class BoardParameters(_Own):  # type: ignore[misc]
    """Parameters that the board is told. The default of each leaves what the board does by itself.

    The schemes' own settings are among them, by their names.
    """

    scheme: str = setting(
        "",
        "how the board chooses the taxels of a frame, a scheme that it has; empty: the board's own",
        choices=("", *SCHEME_NUMBERS),
        changeable=Changeable.RUNNING,
    )
    m: int = setting(
        0,
        "taxels measured per frame; 0: the board's own",
        minimum=0,
        maximum=MAX_SIDE**2,
        changeable=Changeable.RUNNING,
    )
    threshold_counts: int = setting(
        -1,
        "counts above which a taxel's neighbours are searched, or tracking follows it; -1: the board's own",
        minimum=-1,
        maximum=COUNT_MAX,
        changeable=Changeable.RUNNING,
    )
    neighbour_order: str = setting(
        "",
        "order of the neighbour search; empty: the board's own",
        choices=("", *NEIGHBOURS),
        changeable=Changeable.RUNNING,
    )
    rate_cap_hz: float = setting(
        0.0,
        "largest number of frames per second; 0: the board's own",
        minimum=0.0,
        maximum=1e6,
        changeable=Changeable.RUNNING,
    )
    seed: int = setting(
        -1,
        "seed of random and hybrid sampling; -1: the board's own",
        minimum=-1,
        maximum=2**63 - 1,
        changeable=Changeable.RUNNING,
    )

    touch_counts: int = setting(
        -1,
        "counts above which recovery on the board and its LED take a taxel for touched; -1: the board's own",
        minimum=-1,
        maximum=COUNT_MAX,
        changeable=Changeable.RUNNING,
    )
    led: str = setting(
        "", "what the board's LED shows; empty: the board's own", choices=("", *LEDS), changeable=Changeable.RUNNING
    )
    output: str = setting(
        "",
        "what the board sends besides samples; empty: the board's own",
        choices=("", *OUTPUTS),
        changeable=Changeable.RUNNING,
    )
    layout: str = setting(
        "",
        "how the matrix of taxels lies on the skin, so that the board looks for neighbours there: "
        f"{', '.join(LAYOUTS)}, or the path of a layout file; empty: the board's own",
        changeable=Changeable.RUNNING,
    )
    dead_taxels: str = setting(
        "",
        f"broken taxels of the matrix, the same as of reconstruction: {TAXELS_RULE}; no reading of theirs is a touch, "
        "which a board would follow, for which ~/calibrate is refused, and beside which baselines stay; empty: none",
        changeable=Changeable.UNCONFIGURED,
    )
    model: str = setting(
        "",
        "dictionary or object library (.npz) to upload to the board; empty or none: the board keeps what it has",
        changeable=Changeable.RUNNING,
    )

    def check_board_parameters(self) -> None:
        """Check what ranges alone cannot tell.

        Raises
        ------
        SettingsError, ArrayError
            Naming the parameter.
        """
        if self.layout:
            layout_path(self.layout)  # refuses what is neither a name nor a path
        if 0 < self.rate_cap_hz < RATE_MIN_HZ:
            raise SettingsError(
                f"rate_cap_hz = {self.rate_cap_hz:g}: allowed is 0 (the board's own) or {RATE_MIN_HZ:g} and more"
            )

    def given(self) -> dict[str, Any]:
        """The parameters that set something, by name."""
        return {
            field.name: getattr(self, field.name)
            for field in fields(BoardParameters)
            if getattr(self, field.name) != field.default
        }

    def wanted(self, own: BoardSettings) -> BoardSettings:
        """The settings that a board is to have.

        Parameters
        ----------
        own : BoardSettings
            What the board has by itself; kept where nothing is asked. Where only `m` is asked, the shares of a frame
            stay what they were.

        Raises
        ------
        SettingsError
            When the whole cannot be, naming the setting.
        """
        asked = self.given()
        m = asked.get("m", own.m)
        scheme = asked.get("scheme", own.scheme)
        period_us = own.frame_period_us
        if "rate_cap_hz" in asked:
            # Up, as a rate that is the largest is not to be exceeded.
            period_us = math.ceil(1e6 / self.rate_cap_hz - _ROUNDING_US)
        plain = ("scheme", "neighbour_order", "m", "threshold_counts", "touch_counts", "output", "led", "seed")
        own_values: dict[str, Any] = {setting.name: self._own_value(setting, own, m, scheme) for setting in _OWN}
        return replace(
            own,
            frame_period_us=period_us,
            **own_values,
            **{name: asked[name] for name in plain if name in asked},
        )

    def _own_value(self, setting: OwnSetting, own: BoardSettings, m: int, scheme: str) -> int:
        """What the board is told of a scheme's own setting, in frames of `m` taxels of `scheme`."""
        given = getattr(self, setting.parameter)
        held = own.own(setting)
        if setting.share:
            return _quota(given, held, own.m, m, is_used=setting in SCHEMES[scheme].own_settings)
        return held if given < 0 else int(given)

    def skin_map(self, rows: int, cols: int) -> SkinMap | None:
        """How the taxels of a board of this size are to lie on the skin; None: as in the matrix.

        Raises
        ------
        SettingsError, ArrayError
            When the layout cannot be read, is made for another matrix, as are the dead taxels, or has too many patches
            for a board.
        """
        arranged = layout(self.layout or "square", rows, cols)
        dead = dead_taxels_named(self.dead_taxels, rows, cols)
        return None if arranged.is_matrix and not dead.any() else SkinMap.of(arranged, dead)

    def sampling(self, rows: int, cols: int) -> SamplingConfig:
        """How a board would sample that has the defaults of `SamplingConfig` where nothing is asked.

        Raises
        ------
        SettingsError
            When the parameters do not fit together or do not fit an array of `rows` x `cols`.
        """
        asked = {name: value for name, value in self.given().items() if name in _SAMPLING}
        return SamplingConfig(rows=rows, cols=cols, **asked)


# As in BoardSettings: the parameter that is declared here would take the place of the scheme's.
check_names(SCHEMES.values(), dict.fromkeys(get_annotations(BoardParameters), "the driver"))

BOARD_PARAMETERS = tuple(field.name for field in fields(BoardParameters))
"""Names of these parameters."""


def _quota(share: float, own: int, own_m: int, m: int, *, is_used: bool) -> int:
    """Taxels of a frame of `m`: a share of it, or as many as the board's own are of its frame."""
    if share <= 0 and not is_used:
        return own
    quota = quota_of(share, m) if share > 0 else -(-own * m // own_m)
    return min(max(quota, 1), m)
