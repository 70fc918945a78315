# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from acts_core.errors import ObjectLibraryError
from acts_recon.objects import ObjectLibrary, build_object_library, load_object_library, save_object_library


def frames() -> np.ndarray:
    return np.array([[[100, 60], [0, 0]], [[0, 300], [400, 0]], [[0, 0], [0, 1023]]], dtype=np.uint16)


LABELS = ["cup", "ball", "cup"]


@pytest.fixture
def library() -> ObjectLibrary:
    return build_object_library(frames(), LABELS, provenance="made for tests")


def write(path: Path, **changes: object) -> Path:
    """A library file with some fields changed; None leaves a field out."""
    good = build_object_library(frames(), LABELS)
    content: dict[str, Any] = {
        "format": "acts-objects-2",
        "rows": 2,
        "cols": 2,
        "columns": good.columns,
        "norms_counts": good.norms_counts,
        "classes": good.classes,
        "names": np.array(good.names),
        "provenance": "",
        "sha256": good.sha256,
    }
    content.update(changes)
    np.savez(path, **{name: value for name, value in content.items() if value is not None})
    return path


def test_columns_are_frames_of_norm_1_above_the_touch_threshold(library: ObjectLibrary) -> None:
    assert library.names == ("ball", "cup")
    assert library.classes.tolist() == [1, 0, 1]
    expected = np.array([[1, 0, 0, 0], [0, 0.6, 0.8, 0], [0, 0, 0, 1]], dtype=np.float32).T
    np.testing.assert_allclose(library.columns, expected, rtol=1e-6)
    assert library.columns.dtype == np.float32
    assert (library.rows, library.cols, library.n_columns, library.n_classes) == (2, 2, 3, 2)


@pytest.mark.parametrize(
    ("content", "labels", "word"),
    [
        (frames()[0], LABELS, "needed are numbers"),
        (frames()[:0], [], "at least one frame"),
        (frames(), LABELS[:2], "3 frames and 2 labels"),
        (frames() // 20, LABELS, "frame 0 .'cup'. is not above 60"),
        (frames() * 2, LABELS, "outside of 0 to 1023"),
        (np.full((3, 2, 2), np.nan), LABELS, "outside of 0 to 1023"),
        (frames(), ["", "ball", "cup"], "a name of its own"),
        (frames(), ["ball", "ball", "c\udcfcp"], r"name 'c.udcfcp': needed is text in UTF-8"),
    ],
)
def test_frames_that_make_no_library_are_refused(content: np.ndarray, labels: list[str], word: str) -> None:
    with pytest.raises(ObjectLibraryError, match=word):
        build_object_library(content, labels)


def test_what_was_saved_is_loaded(library: ObjectLibrary, tmp_path: Path) -> None:
    path = tmp_path / "mine.objects"
    save_object_library(library, path)
    loaded = load_object_library(path, shape=(2, 2))
    assert np.array_equal(loaded.columns, library.columns)
    assert np.array_equal(loaded.classes, library.classes)
    assert loaded.names == library.names
    assert loaded.provenance == "made for tests"
    assert loaded.sha256 == library.sha256


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"rows": 3}, "6 rows"),
        ({"rows": 65}, "1 to 64"),
        ({"rows": "two"}, "wrong type"),
        ({"cols": np.inf}, "wrong type"),
        ({"columns": np.ones((4, 3), dtype=np.float32)}, "column 0 has norm 2"),
        ({"columns": np.full((4, 3), np.inf, dtype=np.float32)}, "NaN or infinity"),
        ({"columns": np.full((4, 3), -0.5, dtype=np.float32)}, "negative values"),
        ({"columns": np.ones((4, 3), dtype=np.int32)}, "float matrix"),
        ({"columns": np.ones((4, 0), dtype=np.float32)}, "at least one column"),
        ({"norms_counts": np.full(3, 1e300)}, "positive, finite float"),
        ({"norms_counts": np.full(3, 1e-300)}, "positive, finite float"),
        ({"classes": np.array([0, 1])}, "each of the 3 columns"),
        ({"classes": np.array([0.0, 1.0, 0.0])}, "whole number"),
        ({"classes": np.array([0, 0, 0])}, "0 to 1, one for each name"),
        ({"classes": np.array([0, 1, 2])}, "0 to 1, one for each name"),
        ({"classes": np.array([1, 1, 0])}, "hash"),
        ({"names": np.array(["a", "a"])}, "a name of its own"),
        ({"names": np.array([], dtype="U1")}, "0 names"),
        ({"names": np.array(["a", "b"])}, "hash"),
        ({"format": "acts-dictionary-1"}, "readable is 'acts-objects-2'"),
        ({"sha256": None}, "lacks sha256, so it is not an object library"),
    ],
)
def test_a_wrong_file_is_told_apart(changes: dict[str, object], word: str, tmp_path: Path) -> None:
    path = write(tmp_path / "o.npz", **changes)
    with pytest.raises(ObjectLibraryError, match=word) as caught:
        load_object_library(path)
    assert str(path) in str(caught.value)


def test_a_damaged_file_and_another_array_are_refused(tmp_path: Path) -> None:
    path = write(tmp_path / "o.npz")
    with pytest.raises(ObjectLibraryError, match="made for an array of 2 x 2; this one has 32 x 32"):
        load_object_library(path, shape=(32, 32))
    path.write_bytes(path.read_bytes()[:-30])
    with pytest.raises(ObjectLibraryError, match="not an npz file, or a part of one"):
        load_object_library(path)
    with pytest.raises(ObjectLibraryError, match="cannot be read"):
        load_object_library(tmp_path / "none.npz")
