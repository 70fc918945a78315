# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Slip on patches with dead taxels: of whole frames and from what was measured in turn."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from test_slip import by_lstsq, motion_between, press
from test_slip_sampled import HAND, TIP, skin

from acts_core.array import ArrayGeometry
from acts_core.frames import SampleFrame, Scheme
from acts_core.skin import SkinPatch, taxels_in_words, taxels_named
from acts_recon.frame_recovery import FrameRecovery
from acts_recon.images import DeadTaxels
from acts_recon.settings import ReconstructionSettings
from acts_recon.slip import SlipWatch

SIDE = 8
PATCH = SkinPatch("one", 0, SIDE, 0, SIDE, pitch_m=0.003, row_pitch_m=0.003)


@pytest.mark.parametrize("seed", range(5))
def test_a_dead_taxel_has_no_part_in_the_least_squares(seed: int) -> None:
    rng = np.random.default_rng(seed)
    reference = rng.uniform(0, 900, (7, 9)).astype(np.float32)
    image = (reference + rng.normal(0, 20, (7, 9))).astype(np.float32)
    is_dead = rng.random((7, 9)) < 0.3
    motion = motion_between(reference, image, is_dead=is_dead)
    assert motion is not None
    found = np.array([motion.cols, motion.rows, motion.gain, motion.growth])
    np.testing.assert_allclose(found, by_lstsq(reference, image, ~is_dead), rtol=1e-2, atol=1e-2)


def told_s(words: str, *, is_known: bool, moved_m_s: float = 0.01, begin_s: float = 0.2) -> float:
    """When slip is first told of a contact that begins to move along its columns; inf: never."""
    dead = taxels_named(words, SIDE, SIDE)
    watch = SlipWatch(SIDE, SIDE, [PATCH], dead=DeadTaxels(dead, ArrayGeometry(SIDE, SIDE)) if is_known else None)
    age_s = np.where(dead, np.float32(np.inf), np.float32(0.0))
    for k in range(150):
        time_s = 0.004 * k
        moved = max(time_s - begin_s, 0.0) * moved_m_s / PATCH.pitch_m
        values = np.where(dead, np.float32(0.0), press(3.6, 2.9 + moved))
        (slip,) = watch.step(time_s, values, np.array([values.sum()], dtype=float), age_s)
        if slip.slipping:
            return time_s - begin_s
    return math.inf


@pytest.mark.parametrize("words", ["3,3", "row=3", "col=4", "2,2 5,5 3,4"])
def test_slip_is_told_as_soon_as_on_a_sound_patch(words: str) -> None:
    sound_s = told_s("", is_known=False)
    assert 0 < sound_s < 0.05
    assert told_s(words, is_known=True) == pytest.approx(sound_s, abs=0.013)
    assert told_s(words, is_known=True, moved_m_s=0.0) == math.inf
    # A patch of which a taxel is never measured is not watched.
    assert told_s(words, is_known=False) == math.inf


def whole(number: int, picture: NDArray[np.float64], dead: NDArray[np.bool_]) -> SampleFrame:
    """A frame of all taxels of the hand, of which the dead ones read 0."""
    counts = np.where(dead, 0, np.rint(np.clip(HAND.matrix(picture), 0, 1023))).astype(np.uint16)
    return SampleFrame(
        number, 4000 * number, 3900, Scheme.RASTER, 32, 32, 0, np.arange(1024, dtype=np.uint16), counts.ravel()
    )


def test_slip_is_told_of_a_hand_whose_finger_tip_has_a_dead_row() -> None:
    in_picture = np.zeros((HAND.rows, HAND.cols), dtype=bool)
    HAND.patches[TIP].of(in_picture)[4] = True
    dead = np.asarray(HAND.matrix(in_picture), dtype=bool)
    recovery = FrameRecovery(ReconstructionSettings(layout="leap_right", dead_taxels=taxels_in_words(dead)))
    slipping = []
    for number in range(1, 100):
        moved_m = 0.01 * max(0.004 * number - 0.2, 0.0)
        recovery.step(whole(number, skin(moved_m), dead), 4_000_000 * number)
        slipping.append([region.slipping for region in recovery.regions])
    assert not np.any(slipping[:50])
    assert np.array(slipping[50:])[:, TIP].any()
    assert not np.delete(np.array(slipping), TIP, axis=1).any()
