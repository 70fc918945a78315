# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings of a board, and their bytes on the wire."""

from __future__ import annotations

import struct
from dataclasses import dataclass, fields
from enum import IntEnum
from inspect import get_annotations
from typing import Any

from acts_core.array import COUNT_MAX
from acts_core.errors import SettingsError
from acts_core.registry import FromRegistry
from acts_core.sampling import (
    BOARD_OWN_SETTINGS,
    NEIGHBOURS,
    SCHEME_NUMBERS,
    SCHEMES,
    OwnSetting,
    SamplingConfig,
    check_names,
    check_sampling,
    frame_size,
    with_fields,
)
from acts_core.sampling.basis import CommonSettings
from acts_core.settings import setting
from acts_core.wire.packets import version_mismatch

OUTPUTS = ("samples", "image", "object")
"""What the board sends; numbered from 0 on the wire."""

LEDS = ("off", "on", "frames", "touch")
"""What the board's LED shows; numbered from 0 on the wire."""

FRAME_PERIOD_MAX_US = 1_000_000

_NEIGHBOUR_ORDERS = tuple(NEIGHBOURS)
_SCHEME_NAMES = {number: name for name, number in SCHEME_NUMBERS.items()}

# Two own settings of schemes lie in the midst of the others, the rest behind them: uint16 each.
_OWN_IN_THE_MIDST = 2
_OWN_BEHIND = len(BOARD_OWN_SETTINGS) - _OWN_IN_THE_MIDST

# rows, cols, scheme, neighbour_order, m, threshold, own (2), touch, output, led, period, seed, own (the rest)
_LAYOUT = struct.Struct(f"<BBBBHHHHHBBIQ{_OWN_BEHIND}H")

SETTINGS_SIZE = _LAYOUT.size
"""Bytes of the settings in a packet."""


_NUMBERS = {
    "rows": 1,
    "cols": 2,
    "scheme": 3,
    "neighbour_order": 4,
    "m": 5,
    "threshold_counts": 6,
    "touch_counts": 9,
    "output": 10,
    "led": 11,
    "frame_period_us": 12,
    "seed": 13,
    **{own.name: number for number, own in BOARD_OWN_SETTINGS.items()},
}


class SettingField(IntEnum, metaclass=FromRegistry):
    """Number of a setting on the wire, as a board names the one it refuses."""

    _ignore_ = "_name _number"

    for _name, _number in sorted(_NUMBERS.items(), key=lambda item: item[1]):
        vars()[_name.upper()] = _number


_Own: Any = with_fields("_Own", {own.name: own.as_board_setting() for own in BOARD_OWN_SETTINGS.values()})


@dataclass(frozen=True)
class BoardSettings(_Own, CommonSettings):  # type: ignore[misc]
    """Settings of a board: how to sample, how fast, what to send besides samples, what its LED shows.

    The schemes' own settings are among them, by their names. A board takes all over as a whole or refuses them as a
    whole, by the same rules as this class.
    """

    scheme: str = setting("adaptive", "how the taxels of a frame are chosen", choices=tuple(SCHEME_NUMBERS))
    touch_counts: int = setting(
        60,
        "counts above which recovery on the board and the LED take a taxel for touched",
        minimum=0,
        maximum=COUNT_MAX,
    )
    output: str = setting("samples", "what the board sends besides samples", choices=OUTPUTS)
    led: str = setting("frames", "what the board's LED shows", choices=LEDS)
    frame_period_us: int = setting(
        1000, "frames start no closer than this [us]; 0: as close as they can", minimum=0, maximum=FRAME_PERIOD_MAX_US
    )

    def __post_init__(self) -> None:
        check_sampling(self.scheme, self)

    @classmethod
    def from_sampling(cls, config: SamplingConfig) -> BoardSettings:
        """The settings that make a board sample as `config` says; what is not about sampling has its default."""
        values: dict[str, Any] = {field.name: getattr(config, field.name) for field in fields(CommonSettings)}
        values.update({setting.name: config.own(setting) for setting in BOARD_OWN_SETTINGS.values()})
        return cls(**values)

    def own(self, setting: OwnSetting) -> int:
        """See `CommonSettings.own`: here it has the name that it has on the board."""
        return int(getattr(self, setting.name))

    @property
    def frame_size(self) -> int:
        """Taxels that a frame holds."""
        return frame_size(self.scheme, self.rows, self.cols, self.m)

    def to_bytes(self) -> bytes:
        """The settings as they stand in a packet."""
        own = [self.own(setting) for setting in BOARD_OWN_SETTINGS.values()]
        return _LAYOUT.pack(
            self.rows,
            self.cols,
            SCHEME_NUMBERS[self.scheme],
            _NEIGHBOUR_ORDERS.index(self.neighbour_order),
            self.m,
            self.threshold_counts,
            *own[:_OWN_IN_THE_MIDST],
            self.touch_counts,
            OUTPUTS.index(self.output),
            LEDS.index(self.led),
            self.frame_period_us,
            self.seed,
            *own[_OWN_IN_THE_MIDST:],
        )

    @classmethod
    def from_bytes(cls, data: bytes) -> BoardSettings:
        """Read what `to_bytes` wrote.

        Raises
        ------
        PacketError
            When the bytes are no settings that this release knows.
        """
        if len(data) != SETTINGS_SIZE:
            raise version_mismatch(f"settings of {len(data)} bytes; this release knows {SETTINGS_SIZE}")
        rows, cols, scheme, order, m, threshold, first, second, touch, output, led, period, seed, *rest = (
            _LAYOUT.unpack(data)
        )
        own = zip((own.name for own in BOARD_OWN_SETTINGS.values()), (first, second, *rest), strict=True)
        if scheme not in _SCHEME_NAMES or order >= len(_NEIGHBOUR_ORDERS) or output >= len(OUTPUTS) or led >= len(LEDS):
            raise version_mismatch(
                f"settings with scheme {scheme}, neighbour order {order}, output {output}, LED {led}"
            )
        try:
            return cls(
                rows=rows,
                cols=cols,
                scheme=_SCHEME_NAMES[scheme],
                neighbour_order=_NEIGHBOUR_ORDERS[order],
                m=m,
                threshold_counts=threshold,
                touch_counts=touch,
                output=OUTPUTS[output],
                led=LEDS[led],
                frame_period_us=period,
                seed=seed,
                **dict(own),
            )
        except SettingsError as error:
            raise version_mismatch(f"settings that cannot be ({error})") from error


# A setting that a class declares itself takes the place of one that it inherits: the scheme's would be lost.
check_names(SCHEMES.values(), dict.fromkeys(get_annotations(BoardSettings), "the board"))
