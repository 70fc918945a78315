# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The measurements of recovery and of learning: what they count and compare is right, how fast it is not asked."""

from __future__ import annotations

import importlib.util
import time
from pathlib import Path

import numpy as np
import pytest

from acts_recon.learning import KsvdConfig
from acts_recon.sparse import fast_omp, patch_layout
from acts_tools.bench.cases import recovery, train
from acts_tools.bench.references import multiply_adds
from acts_tools.bench.workbench import Workbench
from acts_tools.running.stopping import StopFlag


@pytest.fixture
def workbench(tmp_path: Path) -> Workbench:
    return Workbench(0.2, tmp_path, StopFlag())


@pytest.mark.parametrize("installed", [True, False])
def test_recovery_is_compared_with_what_is_installed(
    installed: bool, workbench: Workbench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recovery, "FRAMES", 2)
    monkeypatch.setattr(recovery, "CALLS", 2)
    if not installed:
        monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    result = recovery.measure(workbench)
    figures = {figure.key: figure for figure in result.figures}
    assert result.problems == []
    for kind in ("press", "skin"):
        us, limit_us = figures[f"{kind}.us"].value, figures[f"{kind}.limit_us"].value
        assert isinstance(us, float)
        assert isinstance(limit_us, float)
        # Which is less only a quiet machine tells.
        assert min(us, limit_us) > 0
        for name in ("sklearn", "spams"):
            there = f"{kind}.{name}_ratio" in figures
            if not there:
                assert str(figures[f"{kind}.{name}_us"].value).startswith("not installed: ./acts run pip install s")
            assert there <= installed


def test_multiply_adds_are_those_of_the_plain_version() -> None:
    A = np.ones((20, 1000), dtype=np.float32)
    # Two rounds: twice 20 x 1000 correlations; one projection and its subtraction; norm, projection, residual and
    # coefficient of each; one step of the back substitution; 64 pixels each.
    expected = 2 * 20 * 1000 + 2 * 20 + 2 * 4 * 20 + 1 + 2 * 64
    assert recovery.multiply_adds(recovery.Problem(A, A[:, 0], 2)) == expected


def test_problems_are_the_patches_that_were_touched() -> None:
    atoms = np.random.default_rng(0).standard_normal((64, 30)).astype(np.float32)
    indices = np.array([0, 1, 40, 1023], dtype=np.uint16)
    counts = np.array([500, 60, 700, 0], dtype=np.uint16)
    problems = recovery.patch_problems(patch_layout(32, 32), atoms, (indices, counts))
    # Taxels 0 and 1 lie in one patch of the corner, 40 (row 1, column 8) in two, the last one is not pressed.
    assert sorted(problem.y.tolist() for problem in problems) == [[500, 0], [700], [700]]
    chosen, _ = fast_omp(problems[0].A, problems[0].y, problems[0].atoms)
    assert chosen.size == 1


def test_order_recursive_pursuit_takes_what_lowers_the_residual_most() -> None:
    # The first column explains the first row, the third one all of the rest.
    A = np.array([[1.0, 0.8, 0.0], [0.0, 0.6, 0.0], [0.0, 0.0, 1.0]])
    assert recovery.order_recursive(A, np.array([4.0, 0.0, 1.0]), 1) == pytest.approx(1 / 17**0.5)
    assert recovery.order_recursive(A, np.array([4.0, 0.0, 1.0]), 2) == pytest.approx(0, abs=1e-12)
    # 0.6 of the second column is new: normalised again it explains all that is left.
    assert recovery.order_recursive(A, np.array([4.0, 1.0, 0.9]), 2) == pytest.approx(0.9 / (17 + 0.81) ** 0.5)


def test_the_peak_is_one_of_this_world() -> None:
    begin_s = time.monotonic()
    peak = multiply_adds.peak_per_s(trials=3, times=50)
    assert 1e6 < peak < 1e12
    assert time.monotonic() - begin_s < 60


def test_learning_is_compared_at_equal_quality(workbench: Workbench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(train, "PRESSES", 60)
    monkeypatch.setattr(train, "PATCHES", 300)
    monkeypatch.setattr(train, "OTHERS", 100)
    monkeypatch.setattr(train, "CONFIG", KsvdConfig(atoms=40, sparsity=4, iterations=2))
    figures = {figure.key: figure.value for figure in train.measure(workbench).figures}
    assert isinstance(figures["ours_error"], float)
    assert 0 < figures["ours_error"] < 100
    if "ratio" not in figures:
        assert figures["sklearn_s"] == "not installed: ./acts run pip install scikit-learn"


def test_what_is_left_unexplained(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(train, "CONFIG", KsvdConfig(atoms=2, sparsity=1, iterations=1))
    patches = np.array([[2.0, 0.0], [0.0, 1.0], [0.6, 0.8]], dtype=np.float32)
    # The third keeps 0.6 of its norm of 1, the norm of all three is the root of 6.
    assert train.unexplained(np.array([[3.0, 0.0], [0.0, 0.5]]), patches) == pytest.approx(0.6 / 6**0.5, rel=1e-5)
