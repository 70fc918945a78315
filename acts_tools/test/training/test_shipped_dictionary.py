# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Quality of the shipped dictionary: limits lie 10 to 50 % above what was measured (docs/reconstruction.md)."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from acts_core.files import load_frames
from acts_core.sampling import SamplingConfig
from acts_recon.sparse import Dictionary, load_dictionary, shipped_dictionary_path
from acts_sim.pressing import OBJECTS
from acts_tools.evaluate.images.recovery import Recording, Task, evaluate
from acts_tools.training.frames import model_frames

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def shipped() -> Dictionary:
    return load_dictionary(shipped_dictionary_path(), patch_size=8)


def score(recordings: list[Recording], m: int, method: str, dictionary: Dictionary) -> dict[str, Any]:
    sampling = SamplingConfig(scheme="adaptive", m=m, threshold_counts=50)
    return evaluate(recordings, Task(sampling, method, touch_counts=60, onset_s=0.0), dictionary)


def test_it_says_where_it_is_from_and_is_small(shipped: Dictionary) -> None:
    assert shipped.atoms.shape == (64, 1000)
    np.testing.assert_allclose(np.linalg.norm(shipped.atoms, axis=0), 1, rtol=1e-5)
    assert shipped.settings["sparsity"] == 13
    assert "contact model" in shipped.provenance
    assert shipped_dictionary_path().stat().st_size <= 400_000


@pytest.mark.parametrize(("m", "relative_error", "cop_error"), [(56, 0.62, 2.2), (128, 0.18, 0.6), (256, 0.08, 0.2)])
def test_quality_on_the_contact_model(shipped: Dictionary, m: int, relative_error: float, cop_error: float) -> None:
    frames = model_frames(list(OBJECTS.values()), 120, seed=11)
    recordings = [Recording(frame[None], 1.0, np.ones((32, 32), dtype=bool)) for frame in frames]
    result = score(recordings, m, "paper", shipped)
    assert result["frames"] >= 110
    assert result["relative_error"] < relative_error
    assert result["touch_cop_error_taxels"]["mean"] < cop_error
    assert result["relative_error"] < 0.95 * score(recordings, m, "dct", shipped)["relative_error"]


@pytest.mark.parametrize(("m", "relative_error", "cop_error"), [(56, 0.58, 6.3), (128, 0.26, 3.1), (256, 0.11, 0.25)])
def test_quality_on_real_grasps(
    shipped: Dictionary, m: int, relative_error: float, cop_error: float, recording_path: Callable[[str], Path]
) -> None:
    recorded = load_frames(recording_path("sdh_weiss/grasps_canvas.npz"))
    recordings = [Recording(frame[None], 31.0, recorded.live) for frame in recorded.peak_frames()]
    result = score(recordings, m, "paper", shipped)
    assert result["frames"] == 425
    assert result["relative_error"] < relative_error
    assert result["touch_cop_error_taxels"]["mean"] < cop_error
