# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recover the whole picture of a skin from a few of its taxels, by the paper's method.

python3 examples/recover_frame.py
"""

from __future__ import annotations

import numpy as np

from acts_core.array import ArrayGeometry
from acts_core.sampling import Sampler, SamplingConfig, measure_in
from acts_recon.methods import PerFrame, PerFrameConfig, Recovery, SkinSetup


def main() -> None:
    geometry = ArrayGeometry(rows=32, cols=32)
    rows, cols = np.indices((32, 32))
    # A fingertip on the skin, in ADC counts.
    skin = np.rint(700 * np.exp(-((rows - 14) ** 2 + (cols - 20) ** 2) / (2 * 2.5**2))).astype(np.uint16)

    # What a board measures of it: row-major indices of the taxels, and their counts; both uint16.
    sampler = Sampler(SamplingConfig(scheme="adaptive", m=128, threshold_counts=60))
    indices, counts = sampler.frame(measure_in(skin))

    setup = SkinSetup(geometry, touch_counts=60)
    recovery = Recovery(PerFrame(setup, PerFrameConfig()), setup)
    contact = recovery.step(indices, counts, end_s=0.0, duration_s=0.001)
    image = recovery.image  # (32, 32) float32; overwritten by the next step

    error = np.linalg.norm(image - skin) / np.linalg.norm(skin)
    print(f"{len(indices)} of {skin.size} taxels measured, relative error of the image {error:.2f}")
    print(f"contact at row {geometry.row_of(contact.y_m):.1f}, column {geometry.col_of(contact.x_m):.1f}, ", end="")
    print(f"{contact.force_n:.1f} N, {contact.active_taxels} taxels pressed")


if __name__ == "__main__":
    main()
