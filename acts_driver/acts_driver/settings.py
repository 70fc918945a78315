"""Parameters of the driver."""

from __future__ import annotations

from dataclasses import dataclass

from acts_core.array import MAX_SIDE
from acts_core.delimited import DelimitedDecoder
from acts_core.raster_ascii import RasterDecoder
from acts_core.settings import setting, validate
from acts_core.wire import StreamDecoder
from acts_driver.port_choice import check_port


@dataclass(frozen=True)
class DriverSettings:
    """See the descriptions; `docs/driver.md` lists them."""

    port: str = setting(
        "auto", "serial port of the board: a path, auto (the only Teensy), or serial:NUMBER (its USB serial number)"
    )
    protocol: str = setting(
        "binary",
        "what the board speaks: binary (ACTS) or raster_ascii (the published raster sketch)",
        choices=("binary", "raster_ascii"),
    )
    frame_id: str = setting("", "frame of the skin in the messages' headers; empty for the node's namespace")
    rows: int = setting(32, "rows of the array; frames of another size are dropped", minimum=1, maximum=MAX_SIDE)
    cols: int = setting(32, "columns of the array; frames of another size are dropped", minimum=1, maximum=MAX_SIDE)
    # Below 1200 some boards take the speed as the order to enter their boot loader (134 on a Teensy).
    baud: int = setting(115200, "bits per second; of no effect on USB boards", minimum=2400, maximum=12_000_000)
    reconnect_s: float = setting(
        0.5, "longest wait between two attempts to open a missing port [s]", minimum=0.02, maximum=60.0
    )
    autostart: bool = setting(
        True, "configure and activate without being asked, waiting for the port where it is missing"
    )

    def __post_init__(self) -> None:
        validate(self)
        check_port(self.port)

    def make_decoder(self) -> DelimitedDecoder:
        """The decoder of the protocol."""
        if self.protocol == "raster_ascii":
            return RasterDecoder(self.rows, self.cols)
        return StreamDecoder()
