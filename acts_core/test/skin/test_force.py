# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.errors import SettingsError
from acts_core.skin import ForceResponse, MeasuredForceResponse, force_table

GRAVITY = 9.81
ASSUMED_FOOT_TAXELS = 16


def test_follows_the_published_response() -> None:
    # Paper, Fig. S9: weight [g] and counts per taxel.
    grams = np.array([0, 10, 30, 50, 70, 100, 200, 300, 400, 500, 600, 700, 800])
    counts = np.array([0, 0, 63, 96, 138, 208, 278, 334, 443, 485, 535, 591, 647])
    force_n = grams / 1000 * GRAVITY / ASSUMED_FOOT_TAXELS
    assert np.abs(ForceResponse().counts(force_n) - counts).max() < 50


@given(st.floats(0.01, 5.0))
def test_inverse_returns_the_force(force_n: float) -> None:
    response = ForceResponse()
    assert response.force_n(response.counts(force_n)) == pytest.approx(force_n, rel=1e-6)


def test_nothing_below_the_dead_band_and_no_force_without_counts() -> None:
    response = ForceResponse(dead_n=0.01)
    assert response.counts(0.009) == 0
    assert response.force_n(0) == 0


def test_saturated_counts_give_a_finite_force() -> None:
    assert np.isfinite(ForceResponse().force_n(np.array([1023.0, 5000.0]))).all()


@pytest.mark.parametrize(
    "wrong",
    [
        *({"full_scale_counts": wrong} for wrong in (0.0, 1024.0, np.nan)),
        *({"dead_n": wrong} for wrong in (-1.0, np.inf, np.nan)),
        *({"half_n": wrong} for wrong in (0.0, np.inf, np.nan)),
    ],
)
def test_impossible_response_is_refused_by_name(wrong: dict[str, float]) -> None:
    with pytest.raises(SettingsError, match=next(iter(wrong))):
        ForceResponse(**wrong)


def test_default_has_the_shape_of_the_published_measurement(recording_path: Callable[[str], Path]) -> None:
    with np.load(recording_path("paper/force_response.npz")) as archive:
        grams, counts = archive["weight_g"].astype(float), archive["output_per_taxel_AU"]
    force_n = grams / 1000 * GRAVITY / ASSUMED_FOOT_TAXELS
    assert np.abs(ForceResponse().counts(force_n) - counts).max() < 50
    measured = MeasuredForceResponse(force_n, counts)
    loaded = counts > 60
    assert np.allclose(measured.force_n(counts[loaded]), force_n[loaded])
    # Within the range that was measured, the fit errs by less than what the foot's area is known by.
    assert np.abs(ForceResponse().force_n(counts[loaded]) / force_n[loaded] - 1).max() < 0.6


@pytest.mark.parametrize("suffix", ["csv", "npz"])
def test_a_measured_response_is_read_and_interpolated(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"response.{suffix}"
    newtons, counts = [0.0, 0.01, 0.02, 0.1, 0.5], [0.0, 0.0, 10.0, 200.0, 600.0]
    if suffix == "npz":
        np.savez(path, newtons=newtons, counts=counts)
    else:
        points = "".join(f"{n}, {c}, x\n" for n, c in zip(newtons, counts, strict=True))
        path.write_text("# measured on a Monday\nnewtons, counts, note\n" + points)
    response = MeasuredForceResponse.from_file(path)
    assert response.counts([0.0, 0.01, 0.015, 0.06, 0.5, 0.7]) == pytest.approx([0, 0, 5, 105, 600, 800])
    assert response.force_n([0, 5, 105, 600, 800]) == pytest.approx([0, 0.015, 0.06, 0.5, 0.7])
    # Beyond the ADC's full scale there is nothing to read.
    assert response.counts(100.0) == 1023
    assert response.force_n(5000.0) == pytest.approx(0.5 + 0.001 * 423)
    table = force_table(response)
    assert table[1:-1] == pytest.approx(response.force_n(np.arange(1, 1024)))
    assert (table[0], table[-1]) == (pytest.approx(0.01), table[-2])


def test_a_table_that_a_spreadsheet_has_saved_is_read(tmp_path: Path) -> None:
    path = tmp_path / "response.csv"
    path.write_bytes(b"\xef\xbb\xbfnewtons,counts\r\n0.1,0\r\n1,300\r\n")
    assert MeasuredForceResponse.from_file(path).force_n(300.0) == pytest.approx(1.0)


@pytest.mark.parametrize(("newtons", "counts"), [([0.1, 0.5, 0.9], [50.0, 400.0, 1023.0]), ([2.0, 5.0], [0.5, 900.0])])
def test_below_the_first_point_of_a_measured_response_forces_are_interpolated_from_0(
    newtons: list[float], counts: list[float]
) -> None:
    response = MeasuredForceResponse(np.array(newtons), np.array(counts))
    assert response.force_n([0.0, 0.5 * counts[0], *counts]) == pytest.approx([0.0, 0.5 * newtons[0], *newtons])
    assert response.counts([0.0, 0.5 * newtons[0], *newtons]) == pytest.approx([0.0, 0.5 * counts[0], *counts])
    # Where a contact lies is weighted by it.
    assert 0.0 < force_table(response)[0] < 1e-6


def test_no_force_of_the_table_is_0_where_a_measured_response_begins_with_counts() -> None:
    response = MeasuredForceResponse(np.array([0.0, 1.0, 5.0]), np.array([100.0, 300.0, 900.0]))
    assert response.force_n(80.0) == 0.0
    table = force_table(response)
    assert table.min() > 0.0
    assert table[101:-1] == pytest.approx(response.force_n(np.arange(101, 1024)))


def test_the_table_of_the_default_is_the_default() -> None:
    counts = np.arange(1, 1000, 0.5)
    table = force_table(ForceResponse())
    assert np.interp(counts, np.arange(1025), table) == pytest.approx(ForceResponse().force_n(counts), rel=1e-3)


@pytest.mark.parametrize(
    ("newtons", "counts", "words"),
    [
        ([0.0, 1.0], [0.0], "as many"),
        ([0.0], [0.0], "two or more"),
        ([0.0, np.nan], [0.0, 5.0], "not finite"),
        ([-1.0, 1.0], [0.0, 5.0], "newtons must begin"),
        ([0.0, 1.0, 1.0], [0.0, 5.0, 6.0], "point 3, 1 N: newtons must"),
        ([0.0, 1.0], [0.0, 1024.0], "allowed are 0 to 1023"),
        ([0.0, 1.0, 2.0], [0.0, 5.0, 4.0], r"fall or stay at 4 \(2 N\)"),
        ([0.0, 1.0, 2.0], [0.0, 5.0, 5.0], "fall or stay"),
        ([0.0, 1.0], [0.0, 0.0], "all counts are 0"),
        ([0.0, 1.0], [0.0, 5.0 + 1.0j], "counts of complex128: needed are numbers"),
    ],
)
def test_points_that_are_no_response_are_refused(
    tmp_path: Path, newtons: list[float], counts: list[complex], words: str
) -> None:
    np.savez(tmp_path / "bad.npz", newtons=newtons, counts=counts)
    with pytest.raises(SettingsError, match=words):
        MeasuredForceResponse.from_file(tmp_path / "bad.npz")


def test_files_that_are_no_response_are_refused(tmp_path: Path) -> None:
    def refusal(name: str, content: bytes | None) -> str:
        if content is not None:
            (tmp_path / name).write_bytes(content)
        with pytest.raises(SettingsError) as caught:
            MeasuredForceResponse.from_file(tmp_path / name)
        assert name in str(caught.value)
        return str(caught.value)

    assert "cannot be read" in refusal("none.csv", None)
    assert "needed is a first line `newtons,counts`" in refusal("nameless.csv", b"0,0\n1,5\n")
    assert "point 2, counts: 'much'" in refusal("word.csv", b"newtons,counts\n0,0\n1,much\n")
    assert "point 1, counts: None" in refusal("short.csv", b"newtons,counts\n0\n")
    assert "not text in UTF-8" in refusal("binary.csv", b"newtons,counts\n\xff\xfe")
    assert "not an npz file" in refusal("text.npz", b"newtons,counts\n0,0\n")
    assert ".csv or .npz" in refusal("response.txt", b"newtons,counts\n0,0\n")
    np.savez(tmp_path / "other.npz", grams=[1.0])
    assert "no array 'newtons'" in refusal("other.npz", None)
