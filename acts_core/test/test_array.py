# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError


def test_origin_is_the_centre_and_y_points_to_row_0() -> None:
    geometry = ArrayGeometry()
    assert geometry.x_m(15.5) == 0
    assert geometry.y_m(15.5) == 0
    assert geometry.y_m(0) > 0 > geometry.y_m(31)
    assert geometry.x_m(31) > 0 > geometry.x_m(0)


def test_default_is_the_papers_140_mm_array() -> None:
    geometry = ArrayGeometry()
    assert geometry.size == 1024
    width_m = geometry.x_m(31) - geometry.x_m(0) + geometry.pitch_m
    assert width_m == pytest.approx(0.140)


@given(
    rows=st.integers(1, 64),
    cols=st.integers(1, 64),
    row=st.floats(-5, 70),
    col=st.floats(-5, 70),
)
def test_positions_and_taxels_are_inverse(rows: int, cols: int, row: float, col: float) -> None:
    geometry = ArrayGeometry(rows, cols, 0.002)
    assert geometry.row_of(geometry.y_m(row)) == pytest.approx(row, abs=1e-9)
    assert geometry.col_of(geometry.x_m(col)) == pytest.approx(col, abs=1e-9)


@pytest.mark.parametrize(
    "wrong", [{"rows": 0}, {"cols": 65}, {"rows": 8.0}, {"cols": np.nan}, {"pitch_m": 0.0}, {"pitch_m": float("nan")}]
)
def test_impossible_geometry_is_refused_by_name(wrong: dict[str, float]) -> None:
    with pytest.raises(ArrayError, match=next(iter(wrong))):
        ArrayGeometry(**wrong)  # type: ignore[arg-type]


def test_accepts_arrays() -> None:
    geometry = ArrayGeometry(4, 6, 0.001)
    assert geometry.x_m(np.arange(6)).shape == (6,)
    assert geometry.x_m(np.arange(6)).sum() == pytest.approx(0)
