# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The baseline in the reconstruction: subtracted from the counts, and over real DDS (ROS_DOMAIN_ID 49)."""

from array import array
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from recon_bench import Bench

from acts_core.errors import ArrayError
from acts_msgs.msg import Baseline
from acts_recon.images import BaselineSubtraction
from acts_recon.sparse import Dictionary, save_dictionary
from acts_ros import qos

pytestmark = pytest.mark.slow

SIZE = 1024


def subtract_reference(
    indices: NDArray[np.uint16], counts: NDArray[np.uint16], baseline: NDArray[np.float32]
) -> NDArray[np.uint16]:
    """Reference implementation of `BaselineSubtraction.apply`, for frames that fit the array."""
    return np.floor(np.maximum(counts - baseline[indices] + np.float32(0.5), 0)).astype(np.uint16)


@settings(max_examples=100, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(0, SIZE))
def test_equals_the_plain_twin(seed: int, m: int) -> None:
    rng = np.random.default_rng(seed)
    subtraction = BaselineSubtraction(SIZE)
    indices = rng.permutation(SIZE)[:m].astype(np.uint16)
    counts = rng.integers(0, 1024, m).astype(np.uint16)
    assert (subtraction.apply(indices, counts) == counts).all()
    baseline, valid = rng.uniform(0, 700, SIZE).astype(np.float32), rng.random(SIZE) < 0.9
    baseline[~valid] = np.nan
    subtraction.set(baseline, valid)
    expected = subtract_reference(indices, counts, np.where(valid, baseline, np.float32(0)))
    assert (subtraction.apply(indices, counts) == expected).all()
    assert (expected[~valid[indices]] == counts[~valid[indices]]).all()


def test_frames_that_do_not_fit_are_left_for_the_reconstructor() -> None:
    subtraction = BaselineSubtraction(4)
    subtraction.set(np.full(4, 10, dtype=np.float32), np.ones(4, dtype=bool))
    indices = np.array([3, 4], dtype=np.uint16)
    assert subtraction.apply(indices, np.array([15, 15, 15], dtype=np.uint16)).tolist() == [5, 15, 15]
    # A taxel that is measured more often than there are taxels.
    assert subtraction.apply(np.zeros(5, dtype=np.uint16), np.full(5, 15, dtype=np.uint16)).tolist() == [5] * 5
    assert len(subtraction.apply(indices[:0], indices[:0])) == 0


def test_baselines_that_do_not_fit_are_refused() -> None:
    subtraction = BaselineSubtraction(4)
    with pytest.raises(ArrayError, match="needed are 4 values"):
        subtraction.set(np.zeros(5, dtype=np.float32), np.ones(4, dtype=bool))
    for wrong in (np.inf, np.nan, -0.1, -1e30, 1023.5, 1e30):
        with pytest.raises(ArrayError, match="not within 0 to 1023 counts"):
            subtraction.set(np.array([0, 0, wrong, 0], dtype=np.float32), np.ones(4, dtype=bool))
    for counts, valid, words in (
        ([0.0] * 4, np.ones(4, dtype=bool), "baseline is list: needed is an array of numpy, of float32"),
        (np.zeros(4, dtype=np.float32), [True] * 4, "valid is list: needed is an array of numpy, of bool"),
        (np.zeros(4, dtype=np.float32), np.ones(4), "valid is float64: needed is an array of numpy, of bool"),
    ):
        with pytest.raises(ArrayError, match=words):
            subtraction.set(counts, valid)  # type: ignore[arg-type]
    assert not subtraction.is_set


@pytest.fixture
def bench(dictionary: Dictionary, tmp_path: Path) -> Iterator[Bench]:
    save_dictionary(dictionary, tmp_path / "test.npz")
    bench = Bench(49, tmp_path / "test.npz", {})
    yield bench
    bench.close()


def baseline_message(rows: int, cols: int, counts: float) -> Baseline:
    message = Baseline(rows=rows, cols=cols, source=Baseline.SOURCE_CALIBRATION)
    message.baseline = array("f", [counts] * (rows * cols))
    message.noise = array("f", [1.0] * (rows * cols))
    message.valid = [True] * (rows * cols)
    return message


def test_the_node_subtracts_the_baseline_once_there_is_one(bench: Bench) -> None:
    indices, counts = np.arange(40), np.full(40, 70)
    bench.send(1, indices, counts)
    assert bench.contact(1).peak == 70
    publisher = bench.peer.create_publisher(Baseline, "baseline", qos.LATCHED)
    publisher.publish(baseline_message(16, 16, 500.0))
    bench.diagnostics(lambda status, values: values["rejected.bad_baseline"] == "1" and values["baseline"] == "none")
    publisher.publish(baseline_message(32, 32, 15.2))
    bench.until(lambda: bench.node._pipeline.subtracts)

    def has_rejected(number: int) -> bool:
        return bool(bench.node._rejected["bad_baseline"] == number)

    # What is refused changes nothing, not even half of it.
    for rejected, (counts_of_all, noise) in enumerate(((-2000.0, 1.0), (500.0, 1e30)), start=2):
        wrong = baseline_message(32, 32, counts_of_all)
        wrong.noise = array("f", [noise] * 1024)
        publisher.publish(wrong)
        bench.until(partial(has_rejected, rejected))
    bench.send(2, indices, counts)
    assert not bench.contact(2).in_contact
    bench.send(3, indices, counts + 100)
    assert bench.contact(3).peak == 155


def test_a_baseline_that_is_withdrawn_is_not_subtracted_any_more(bench: Bench) -> None:
    indices, counts = np.arange(40), np.full(40, 70)
    publisher = bench.peer.create_publisher(Baseline, "baseline", qos.LATCHED)
    publisher.publish(baseline_message(32, 32, 15.2))
    bench.until(lambda: bench.node._pipeline.subtracts)
    none = baseline_message(32, 32, 0.0)
    none.source, none.valid = Baseline.SOURCE_NONE, [False] * 1024
    publisher.publish(none)
    bench.diagnostics(lambda status, values: values["baseline"] == "none")
    bench.send(1, indices, counts)
    assert bench.contact(1).peak == 70
