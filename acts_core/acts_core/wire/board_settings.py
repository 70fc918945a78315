"""Settings of a board, and their bytes on the wire."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import IntEnum

from acts_core.array import COUNT_MAX, MAX_SIDE
from acts_core.errors import SettingsError
from acts_core.sampling import NEIGHBOURS, SCHEMES, SamplingConfig, uniform_spacing
from acts_core.settings import setting, validate
from acts_core.wire.packets import version_mismatch

OUTPUTS = ("samples", "image", "object")
"""What the board sends; numbered from 0 on the wire."""

LEDS = ("off", "on", "frames", "touch")
"""What the board's LED shows; numbered from 0 on the wire."""

FRAME_PERIOD_MAX_US = 1_000_000

_NEIGHBOUR_ORDERS = tuple(NEIGHBOURS)
_SCHEME_NAMES = {int(scheme): name for name, scheme in SCHEMES.items()}

# rows, cols, scheme, neighbour_order, m, threshold, search_quota, adaptive_quota, touch, output, led, period, seed
_LAYOUT = struct.Struct("<BBBBHHHHHBBIQ")

SETTINGS_SIZE = _LAYOUT.size
"""Bytes of the settings in a packet."""


class SettingField(IntEnum):
    """Number of a setting on the wire, as a board names the one it refuses."""

    ROWS = 1
    COLS = 2
    SCHEME = 3
    NEIGHBOUR_ORDER = 4
    M = 5
    THRESHOLD_COUNTS = 6
    SEARCH_QUOTA = 7
    ADAPTIVE_QUOTA = 8
    TOUCH_COUNTS = 9
    OUTPUT = 10
    LED = 11
    FRAME_PERIOD_US = 12
    SEED = 13


@dataclass(frozen=True)
class BoardSettings:
    """Settings of a board: how to sample, how fast, what to send besides samples, what its LED shows.

    A board takes them over as a whole or refuses them as a whole, by the same rules as this class.
    """

    rows: int = setting(32, "rows of the array", minimum=1, maximum=MAX_SIDE)
    cols: int = setting(32, "columns of the array", minimum=1, maximum=MAX_SIDE)
    scheme: str = setting("adaptive", "how the taxels of a frame are chosen", choices=tuple(SCHEMES))
    neighbour_order: str = setting("columns", "order of the neighbour search", choices=_NEIGHBOUR_ORDERS)
    m: int = setting(55, "taxels measured per frame; raster measures all", minimum=1, maximum=MAX_SIDE**2)
    threshold_counts: int = setting(
        180,
        "counts above which adaptive and hybrid search a taxel's neighbours and tracking follows it",
        minimum=0,
        maximum=COUNT_MAX,
    )
    search_quota: int = setting(
        11, "taxels of a tracking frame that are kept for the search, 1 to m there", minimum=0, maximum=MAX_SIDE**2
    )
    adaptive_quota: int = setting(
        28, "taxels of a hybrid frame that are chosen adaptively, 1 to m there", minimum=0, maximum=MAX_SIDE**2
    )
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
    seed: int = setting(1, "seed of random and hybrid sampling", minimum=0, maximum=2**64 - 1)

    def __post_init__(self) -> None:
        validate(self)
        if self.m > self.rows * self.cols and self.scheme != "raster":
            raise SettingsError(
                f"m = {self.m}: an array of {self.rows} x {self.cols} has {self.rows * self.cols} taxels"
            )
        if self.scheme == "uniform":
            uniform_spacing(self.rows, self.cols, self.m)
        for scheme, name in (("tracking", "search_quota"), ("hybrid", "adaptive_quota")):
            if self.scheme == scheme and not 1 <= getattr(self, name) <= self.m:
                raise SettingsError(f"{name} = {getattr(self, name)}: allowed is 1 to m = {self.m} of a {scheme} frame")

    @classmethod
    def from_sampling(
        cls,
        config: SamplingConfig,
        *,
        frame_period_us: int = 1000,
        touch_counts: int = 60,
        output: str = "samples",
        led: str = "frames",
    ) -> BoardSettings:
        """The settings that make a board sample as `config` says."""
        return cls(
            rows=config.rows,
            cols=config.cols,
            scheme=config.scheme,
            neighbour_order=config.neighbour_order,
            m=config.m,
            threshold_counts=config.threshold_counts,
            search_quota=config.search_quota,
            adaptive_quota=config.adaptive_quota,
            touch_counts=touch_counts,
            output=output,
            led=led,
            frame_period_us=frame_period_us,
            seed=config.seed,
        )

    @property
    def frame_size(self) -> int:
        """Taxels that a frame holds."""
        return self.rows * self.cols if self.scheme == "raster" else self.m

    def to_bytes(self) -> bytes:
        """The settings as they stand in a packet."""
        return _LAYOUT.pack(
            self.rows,
            self.cols,
            int(SCHEMES[self.scheme]),
            _NEIGHBOUR_ORDERS.index(self.neighbour_order),
            self.m,
            self.threshold_counts,
            self.search_quota,
            self.adaptive_quota,
            self.touch_counts,
            OUTPUTS.index(self.output),
            LEDS.index(self.led),
            self.frame_period_us,
            self.seed,
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
        rows, cols, scheme, order, m, threshold, search, adaptive, touch, output, led, period, seed = _LAYOUT.unpack(
            data
        )
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
                search_quota=search,
                adaptive_quota=adaptive,
                touch_counts=touch,
                output=OUTPUTS[output],
                led=LEDS[led],
                frame_period_us=period,
                seed=seed,
            )
        except SettingsError as error:
            raise version_mismatch(f"settings that cannot be ({error})") from error
