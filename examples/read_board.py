# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Read a board over its serial port, and tell once a second, and at the end, what it sends and what presses.

python3 examples/read_board.py auto                                # the only Teensy that is plugged in
python3 examples/read_board.py /dev/ttyUSB0 --ascii 16 16          # lines of text from an array of 16 x 16
"""

from __future__ import annotations

import argparse
import signal
import sys
import time

from acts_core.array import ArrayGeometry
from acts_core.errors import ActsError
from acts_core.wire import RasterDecoder, StreamDecoder
from acts_driver.port import SerialSource
from acts_recon.contacts import Contact
from acts_recon.methods import Fusion, Recovery, SkinSetup


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("port", help="a path, auto, or serial:NUMBER")
    parser.add_argument("--ascii", nargs=2, type=int, metavar=("ROWS", "COLS"), help="text lines (docs/own_array.md)")
    parser.add_argument("--baud", type=int, default=115200, help="of no effect on boards with USB of their own")
    parser.add_argument("--seconds", type=float, default=float("inf"))
    arguments = parser.parse_args()

    source = SerialSource(arguments.port, arguments.baud)
    decoder = RasterDecoder(*arguments.ascii) if arguments.ascii else StreamDecoder()
    source.open()
    try:
        read(source, decoder, arguments.seconds)
    finally:
        source.close()


def read(source: SerialSource, decoder: RasterDecoder | StreamDecoder, seconds: float) -> None:
    recovery: Recovery | None = None
    contact: Contact | None = None
    begin_s = told_s = time.monotonic()
    frames = 0
    try:
        while (now_s := time.monotonic()) < begin_s + seconds:
            # At most 0.1 s, then empty. PortError, should the board be unplugged; open() may then be tried again.
            for frame in decoder.feed(source.read()):
                if recovery is None:
                    print(
                        f"an array of {frame.rows} x {frame.cols}; compiling takes some ten seconds, once", flush=True
                    )
                    skin = SkinSetup(ArrayGeometry(frame.rows, frame.cols), touch_counts=60)
                    recovery = Recovery(Fusion(skin), skin)
                    begin_s = told_s = time.monotonic()  # to compile it the first time has taken a while
                frames += 1
                end_s = frame.board_us * 1e-6
                frame = frame.once()  # where a board measures some taxels again and again, the last of each
                contact = recovery.step(frame.indices, frame.counts, end_s, frame.duration_us * 1e-6)
            if now_s >= told_s + 1.0:
                told_s = now_s
                tell(decoder, frames, contact)
    except KeyboardInterrupt:  # Ctrl-C ends it, too; once more changes nothing
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    if frames == 0:
        sys.exit(f"error: no frame from {source.name} in {min(seconds, time.monotonic() - begin_s):.2g} s")
    tell(decoder, frames, contact)


def tell(decoder: RasterDecoder | StreamDecoder, frames: int, contact: Contact | None) -> None:
    damaged = decoder.crc_errors + decoder.malformed
    print(f"{frames} frames, {damaged} packets damaged", end="")
    if frames + damaged == 0:
        print(" (does the board's sketch run, and print?)", end="")
    if decoder.last_error:
        print(f" (the last: {decoder.last_error})", end="")
    if contact is not None and contact.in_contact:
        print(f"; touched at x {1000 * contact.x_m:.1f} mm, y {1000 * contact.y_m:.1f} mm", end="")
    print(flush=True)


if __name__ == "__main__":
    try:
        main()
    except ActsError as error:
        sys.exit(f"error: {error}")
