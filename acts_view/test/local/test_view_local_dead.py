# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A board with dead taxels that is shown without nodes."""

from __future__ import annotations

import os

import numpy as np

from acts_core.frames import SampleFrame, Scheme
from acts_driver.settings import DriverSettings
from acts_view.local.sources import BoardSource

SIDE = 16
OPEN_ROW = 5


def test_an_open_row_does_not_keep_the_rows_beside_it_from_following_their_drift() -> None:
    far, near = os.openpty()
    driver = DriverSettings(port=os.ttyname(near), protocol="raster_ascii", rows=SIDE, cols=SIDE, baseline_tau_s=2.0)
    source = BoardSource("/board", driver, "square", lambda level, words: None, dead_taxels=f"row={OPEN_ROW}")
    indices, rng, number = np.arange(SIDE * SIDE, dtype=np.uint16), np.random.default_rng(4), 0
    try:
        for seconds, counts in ((1.0, 40), (20.0, 55)):
            for _ in range(round(100 * seconds)):
                readings = np.full((SIDE, SIDE), counts, dtype=np.uint16)
                readings[OPEN_ROW] = rng.integers(0, 1024, SIDE)
                frame = SampleFrame(
                    number, 10_000 * number, 900, Scheme.RASTER, SIDE, SIDE, 0, indices, readings.ravel()
                )
                source._take([(frame, 10_000_000 * (200 + number))], None)
                number += 1
            if counts == 40:
                assert source._tare() == f"tared {SIDE * SIDE} of {SIDE * SIDE} taxels"
        newest = source.skin.newest()
        assert newest is not None
        assert newest[0].image is not None
        assert newest[0].image.max() <= 2
    finally:
        source.stop()
        os.close(near)
        os.close(far)
