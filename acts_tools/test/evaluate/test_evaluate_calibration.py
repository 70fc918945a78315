# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Whether errors on simulated slides are as large as the fusion says they are."""

import numpy as np
import pytest

from acts_core.sampling import SamplingConfig
from acts_recon.sparse import load_dictionary, shipped_dictionary_path
from acts_sim.pressing import EVENT_RATE_HZ, event_recordings
from acts_tools.evaluate.images.recovery import Recording, Task, evaluate
from acts_tools.evaluate.scene_frames import FOLLOW_COUNTS

pytestmark = pytest.mark.slow


# Measured: ratios of touched taxels 0.97 to 1.06; of the centre 0.7 to 0.37, of force, area and spread 0.8 to 0.25.
@pytest.mark.parametrize(
    ("event", "noise_counts"),
    [("slide_0.1_m_s", 3.0), ("slide_0.1_m_s", 8.0), ("slide_1_m_s", 3.0), ("slide_2_m_s", 3.0)],
)
def test_errors_are_as_large_as_the_fusion_says(event: str, noise_counts: float) -> None:
    recordings = [
        Recording(frames, EVENT_RATE_HZ, np.ones((32, 32), dtype=bool)) for frames in event_recordings(event, 3, seed=1)
    ]
    task = Task(SamplingConfig("tracking", m=55, threshold_counts=FOLLOW_COUNTS), "acts", noise_counts=noise_counts)
    known = evaluate(recordings, task, load_dictionary(shipped_dictionary_path()))["sigma"]
    for name, least, most in (
        ("touched", 0.85, 1.2),
        ("x", 0.3, 1.2),
        ("y", 0.3, 1.2),
        ("force", 0.2, 1.2),
        ("area", 0.2, 1.2),
        ("spread", 0.2, 1.2),
    ):
        assert least < known[name]["ratio"] < most, name
        assert known[name]["within_2"] > 0.9, name
    assert known["touched"]["within_1"] > 0.6
    assert known["untouched"]["within_2"] > 0.99
