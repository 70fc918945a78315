# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest

from acts_core.wire import confidence_of


@pytest.mark.parametrize(
    ("residuals", "confidence"),
    [([0.2, 0.8, 1.0], 0.75), ([0.5, 0.5], 0.0), ([0.0, 1.0], 1.0), ([0.0, 0.0], 0), ([0.3], 0)],
)
def test_confidence_is_how_far_the_second_is_behind(residuals: list[float], confidence: float) -> None:
    assert confidence_of(np.array(residuals)) == pytest.approx(confidence)
