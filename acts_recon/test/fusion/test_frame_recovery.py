# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames recovered without the node: what is lost between them, and what a board that begins anew leaves behind."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.errors import ArrayError
from acts_core.frames import SampleFrame, Scheme
from acts_recon.frame_pipeline import FramePipeline, RepeatedFrameError
from acts_recon.frame_recovery import FrameRecovery
from acts_recon.settings import ReconstructionSettings

SIDE = 8


def frame(sequence: int, counts: int, side: int = SIDE) -> SampleFrame:
    """All taxels at once, a patch of 3 x 3 of them pressed."""
    image = np.zeros((side, side), np.uint16)
    image[2:5, 2:5] = counts
    indices = np.arange(side * side, dtype=np.uint16)
    return SampleFrame(sequence, 1000 * sequence, 900, Scheme.RASTER, side, side, 0, indices, image.ravel())


@pytest.fixture(scope="module")
def recovery() -> FrameRecovery:
    return FrameRecovery(ReconstructionSettings(rows=SIDE, cols=SIDE))


def test_a_press_is_one_contact_and_what_is_missing_before_it_is_counted(recovery: FrameRecovery) -> None:
    recovery.reset()
    lost = [recovery.step(frame(sequence, 500), 1_000_000 * sequence) for sequence in (5, 6, 9)]
    assert lost == [0, 0, 2]
    assert recovery.contact.in_contact
    (blob,) = recovery.blobs
    assert blob.x_m == pytest.approx(recovery.contact.x_m, abs=1e-3)
    assert recovery.regions == ()


def test_a_board_that_begins_anew_is_another_one(recovery: FrameRecovery) -> None:
    recovery.reset()
    number = 0
    for sequence in range(100, 110):
        recovery.step(frame(sequence, 500), 1_000_000 * sequence)
        number = recovery.blobs[0].number if recovery.blobs else number
    assert recovery.step(frame(0, 0), 200_000_000) == 0
    assert not recovery.recovery.image.any()
    assert not recovery.contact.in_contact
    # It is not the one of before, which would be bridged.
    for sequence in range(1, 5):
        recovery.step(frame(sequence, 500), 200_000_000 + 1_000_000 * sequence)
    assert recovery.blobs[0].number != number


def test_a_frame_that_comes_a_second_time_changes_nothing(recovery: FrameRecovery) -> None:
    recovery.reset()
    for sequence in range(100, 110):
        recovery.step(frame(sequence, 500), 1_000_000 * sequence)
    number = recovery.blobs[0].number
    image = recovery.recovery.image.copy()
    with pytest.raises(RepeatedFrameError, match="frame 109 came a second time"):
        recovery.step(frame(109, 0), 109_000_000)
    assert recovery.recovery.image.tolist() == image.tolist()
    assert recovery.step(frame(110, 500), 110_000_000) == 0
    assert recovery.blobs[0].number == number
    # After a reset nothing is known of it.
    recovery.reset()
    assert recovery.step(frame(110, 500), 110_000_000) == 0


def test_a_board_that_begins_anew_at_the_same_number_is_another_one(recovery: FrameRecovery) -> None:
    recovery.reset()
    recovery.step(frame(0, 500), 0)
    assert recovery.step(frame(0, 0)._replace(board_us=7), 200_000_000) == 0
    assert not recovery.recovery.image.any()


def test_a_frame_that_is_refused_is_not_missing_as_well(recovery: FrameRecovery) -> None:
    recovery.reset()
    recovery.step(frame(1, 500), 1_000_000)
    with pytest.raises(ArrayError, match="reads 0 to 1023"):
        recovery.step(frame(2, 1024), 2_000_000)
    assert recovery.step(frame(3, 500), 3_000_000) == 0
    assert recovery.lost == 0


def test_all_samples_of_a_taxel_that_is_measured_several_times_are_checked(recovery: FrameRecovery) -> None:
    recovery.reset()
    recovery.step(frame(1, 500), 1_000_000)
    image = recovery.recovery.image.copy()
    twice = np.array([5, 5], dtype=np.uint16)
    for counts, word in (([2000, 100], "count 2000: the board reads 0 to 1023"), ([100], "2 indices and 1 counts")):
        samples = np.array(counts, dtype=np.uint16)
        with pytest.raises(ArrayError, match=word):
            recovery.step(frame(2, 0)._replace(scheme=Scheme.FIXED, indices=twice, counts=samples), 2_000_000)
        recovery.reset()
    assert recovery.every is not None
    assert len(recovery.every.counts) == SIDE * SIDE
    recovery.step(frame(1, 500), 1_000_000)
    assert recovery.recovery.image.tolist() == image.tolist()


@pytest.mark.parametrize("method", ["fusion", "per_frame"])
def test_a_frame_that_took_less_than_no_time_is_refused(method: str) -> None:
    recovery = FrameRecovery(ReconstructionSettings(rows=SIDE, cols=SIDE, method=method))
    with pytest.raises(ArrayError, match=r"duration -1e-06 s: needed are finite times, none negative"):
        recovery.step(frame(1, 500)._replace(duration_us=-1), 1_000_000)
    assert recovery.step(frame(2, 500), 2_000_000) == 0
    assert recovery.contact.in_contact


def test_a_frame_of_another_size_is_refused(recovery: FrameRecovery) -> None:
    with pytest.raises(ArrayError, match="16 x 16 taxels, expected are 8 x 8"):
        recovery.step(frame(0, 0, side=16), 0)


def test_the_noise_of_a_baseline_is_that_of_its_taxels(recovery: FrameRecovery) -> None:
    recovery.reset()
    noise = np.where(np.arange(SIDE * SIDE) < 8, 12.0, 1.0).astype(np.float32)
    recovery.set_baseline(np.zeros(SIDE * SIDE, np.float32), noise, np.ones(SIDE * SIDE, dtype=np.bool_))
    recovery.step(frame(0, 0), 0)
    sigma = recovery.recovery.sigma
    assert sigma is not None
    assert sigma.ravel() == pytest.approx(noise, rel=0.01)
    recovery.set_baseline(np.zeros(SIDE * SIDE, np.float32), noise, noise < 0)


def test_a_baseline_that_comes_during_a_frame_is_in_force_with_the_next(recovery: FrameRecovery) -> None:
    recovery.reset()
    method, known = recovery.recovery.method, np.ones(SIDE * SIDE, dtype=np.bool_)
    threads: list[int] = []

    def set_noise(noise_counts: NDArray[np.float32], valid: NDArray[np.bool_]) -> None:
        threads.append(threading.get_ident())

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(method, "set_noise", set_noise)
        other = threading.Thread(target=recovery.set_baseline, args=(0 * known, np.ones(known.size), known))
        other.start()
        other.join()
        assert threads == []
        for sequence in range(2):
            recovery.step(frame(sequence, 500), 1_000_000 * sequence)
    assert threads == [threading.get_ident()]
    recovery.set_baseline(np.zeros(known.size, np.float32), np.zeros(known.size, np.float32), ~known)


def test_what_no_board_reads_is_refused_also_where_the_baseline_would_make_it_possible(recovery: FrameRecovery) -> None:
    recovery.reset()
    still = np.zeros(SIDE * SIDE, np.float32)
    recovery.set_baseline(still + 100, still, still == 0)
    # As of a converter of 12 bits.
    with pytest.raises(ArrayError, match="count 1100: the board reads 0 to 1023"):
        recovery.step(frame(0, 1100), 0)
    recovery.step(frame(1, 1023), 1_000_000)
    assert recovery.recovery.image.max() == 923
    recovery.set_baseline(still, still, still == 0)


def test_a_baseline_is_subtracted(recovery: FrameRecovery) -> None:
    recovery.reset()
    still = np.zeros(SIDE * SIDE, np.float32)
    recovery.set_baseline(still + 500, still, still == 0)
    recovery.step(frame(0, 500), 0)
    assert not recovery.recovery.image.any()
    recovery.set_baseline(still, still, still == 0)


@pytest.mark.parametrize(
    ("counts", "baseline_counts", "are_forgotten"),
    [(100, 50.0, True), (500, 50.0, False), (500, 61.0, True), (61, 1.0, False), (63, 3.0, True), (40, 3.0, False)],
)
def test_a_baseline_by_which_a_touch_is_none_forgets_all_frames(
    counts: int, baseline_counts: float, are_forgotten: bool
) -> None:
    forgotten: list[int] = []
    pipeline = FramePipeline(ReconstructionSettings(rows=SIDE, cols=SIDE), lambda: forgotten.append(1))
    still, valid = np.zeros(SIDE * SIDE, np.float32), np.ones(SIDE * SIDE, dtype=np.bool_)
    pipeline.step(frame(0, counts), 0)
    pipeline.set_baseline(still + np.float32(baseline_counts), still, valid)
    for sequence in (1, 2):
        pipeline.step(frame(sequence, counts), 1_000_000 * sequence)
    assert bool(forgotten) == are_forgotten
    # And back again, by a touch of the same counts.
    pipeline.set_baseline(still, still, valid)
    pipeline.step(frame(3, counts), 3_000_000)
    assert len(forgotten) == 2 * are_forgotten


@pytest.mark.parametrize("touch_counts", [0, 1])
def test_a_baseline_that_drifts_forgets_nothing_however_low_the_threshold(touch_counts: int) -> None:
    """Of a mat without noise each count is a touch: all contacts had new numbers with every baseline, once a second."""
    settings = ReconstructionSettings(rows=SIDE, cols=SIDE, touch_counts=touch_counts, contacts_hysteresis_counts=0)
    recovery = FrameRecovery(settings)
    still, valid = np.zeros(SIDE * SIDE, np.float32), np.ones(SIDE * SIDE, dtype=np.bool_)
    recovery.set_baseline(still, still, valid)
    recovery.step(frame(0, 500), 0)
    numbers = [blob.number for blob in recovery.blobs]
    for sequence in range(1, 5):
        recovery.set_baseline(still + np.float32(1.5 * (sequence % 2)), still, valid)
        recovery.step(frame(sequence, 500), 1_000_000 * sequence)
        assert [blob.number for blob in recovery.blobs] == numbers
    recovery.set_baseline(still + np.float32(4.0), still, valid)
    recovery.step(frame(5, 500), 5_000_000)
    assert [blob.number for blob in recovery.blobs] != numbers
