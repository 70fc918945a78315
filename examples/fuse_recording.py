# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Go through a recording and estimate at every frame the image out of all samples so far, and how sure it is.

    python3 examples/fuse_recording.py FILE.npz

The file holds samples (`indices`, `counts`, `stamp_ns` or `rate_hz`) or full frames (`frames`, `rate_hz`), which are
sampled as a board would: docs/driver.md, "Replaying a recording". The size of the array is that of the file.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from acts_core.array import ArrayGeometry
from acts_core.errors import ActsError
from acts_core.sampling import SamplingConfig
from acts_driver.replay import ReplayOptions, open_recording
from acts_recon.methods import Fusion, Recovery, SkinSetup


def sampling(rows: int, cols: int) -> SamplingConfig:
    """How full frames are sampled."""
    return SamplingConfig(scheme="tracking", rows=rows, cols=cols, m=min(55, rows * cols), threshold_counts=15)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path, help="an .npz file; a bag (folder or .mcap), where ROS is installed")
    recording = open_recording(ReplayOptions(parser.parse_args().file, sampling=sampling))

    recovery: Recovery | None = None
    pressed, told = 0, -50
    # Counted here: the board's own numbers begin anew where it was restarted.
    for number, frame in enumerate(recording.frames()):
        frame = frame.once()  # where a board measured some taxels again and again, the last of each
        if recovery is None:
            skin = SkinSetup(ArrayGeometry(frame.rows, frame.cols), touch_counts=60)
            recovery = Recovery(Fusion(skin), skin)
        end_s, duration_s = frame.board_us * 1e-6, frame.duration_us * 1e-6
        contact = recovery.step(frame.indices, frame.counts, end_s, duration_s)
        # recovery.image and recovery.sigma are (rows, cols) float32 [counts]; overwritten by the next step.
        pressed += contact.in_contact
        if contact.in_contact and number >= told + 50:
            told = number
            x_mm, y_mm = 1000 * contact.x_m, 1000 * contact.y_m
            print(f"{end_s:7.3f} s: x {x_mm:6.2f} mm, y {y_mm:6.2f} mm, {contact.force_n:5.2f} N, ", end="")
            print(f"x uncertain by {1000 * contact.x_sd_m:.2f} mm")
    if not pressed:
        print("no contact: none of the taxels measured is above 60 counts, of 1023")


if __name__ == "__main__":
    try:
        main()
    except BrokenPipeError:  # `| head` has read enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except ActsError as error:
        sys.exit(f"error: {error}")
