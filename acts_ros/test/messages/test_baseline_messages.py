# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Baselines out of messages, good and bad ones."""

from array import array
from typing import Any

import numpy as np
import pytest

from acts_core.errors import ArrayError
from acts_msgs.msg import Baseline
from acts_ros.messages import baseline_of


def message(**changed: Any) -> Baseline:
    """Of 2 x 3 taxels, the last one not valid."""
    fields: dict[str, Any] = {
        "rows": 2,
        "cols": 3,
        "baseline": array("f", [0, 10, 20.5, 30, 1023, 0]),
        "noise": array("f", [0, 1, 1.5, 2, 3, 0]),
        "valid": [True] * 5 + [False],
    }
    return Baseline(**{**fields, **changed})


def test_a_baseline_is_what_the_message_says() -> None:
    counts, noise_counts, valid = baseline_of(message(), 2, 3)
    assert counts.tolist() == [0, 10, 20.5, 30, 1023, 0]
    assert noise_counts.tolist() == [0, 1, 1.5, 2, 3, 0]
    assert valid.tolist() == [True] * 5 + [False]
    assert counts.dtype == noise_counts.dtype == np.float32


def test_what_is_not_valid_is_0_whatever_is_written_there() -> None:
    wild = array("f", [1] * 5 + [float("nan")])
    counts, noise_counts, _ = baseline_of(message(baseline=wild, noise=wild), 2, 3)
    assert counts.tolist() == noise_counts.tolist() == [1] * 5 + [0]


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"rows": 3, "cols": 2}, "a baseline of 3 x 2 taxels, the array has 2 x 3"),
        ({"rows": 1, "cols": 6}, "a baseline of 1 x 6 taxels"),
        ({"baseline": array("f", [1] * 5)}, r"baseline \(5,\) .* needed are 6 values"),
        ({"noise": array("f", [1] * 7)}, r"noise \(7,\) .* needed are 6 values"),
        ({"valid": []}, r"valid \(0,\): needed are 6 values"),
        ({"baseline": array("f", [1, -0.5, 1, 1, 1, 1])}, "the baseline has values that are not within 0 to 1023"),
        ({"baseline": array("f", [1, float("nan"), 1, 1, 1, 1])}, "the baseline has values"),
        ({"noise": array("f", [1, 1023.5, 1, 1, 1, 1])}, "the noise has values that are not within 0 to 1023"),
        ({"noise": array("f", [1, float("inf"), 1, 1, 1, 1])}, "the noise has values"),
    ],
)
def test_a_baseline_that_cannot_be_is_refused(changed: dict[str, Any], words: str) -> None:
    with pytest.raises(ArrayError, match=words):
        baseline_of(message(**changed), 2, 3)
