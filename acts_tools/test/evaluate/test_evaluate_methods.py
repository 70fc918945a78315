# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The plain methods that the recovery is compared with."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import DictionaryError, SettingsError
from acts_recon.methods import METHODS, Method, SkinSetup
from acts_recon.sparse import Dictionary, load_dictionary, shipped_dictionary_path
from acts_tools.evaluate.estimators.dictionaries import cosine_dictionary, dictionary_named, haar_dictionary
from acts_tools.evaluate.estimators.methods import ALIASES, FACTORIES, method_named

pytestmark = pytest.mark.slow

SKIN = SkinSetup(ArrayGeometry(), touch_counts=50)


@pytest.fixture(scope="module")
def shipped() -> Dictionary:
    return load_dictionary(shipped_dictionary_path())


def step(method: Method, field: NDArray[np.uint16], indices: NDArray[np.uint16]) -> NDArray[np.float32]:
    return method.step(indices, field.ravel()[indices], 0.001, 0.001)


@pytest.mark.parametrize("name", FACTORIES)
def test_every_method_keeps_what_was_measured_and_shows_nothing_on_an_untouched_skin(
    name: str, shipped: Dictionary
) -> None:
    method = method_named(name)(SKIN, shipped, {})
    rng = np.random.default_rng(1)
    row, col = np.indices((32, 32))
    field = (600 * np.exp(-((row - 9) ** 2 + (col - 20) ** 2) / 8)).astype(np.uint16)
    indices = np.concatenate((np.flatnonzero(field > 60), rng.permutation(np.flatnonzero(field == 0))[:80])).astype(
        np.uint16
    )
    method.reset()
    image = step(method, field, indices)
    assert image.shape == (32, 32)
    np.testing.assert_allclose(image.ravel()[indices], field.ravel()[indices], atol=0.5)
    assert image.min() >= 0
    assert image.max() <= 1023
    method.reset()
    assert not step(method, np.zeros_like(field), indices).any()


def test_an_unknown_method_is_refused() -> None:
    with pytest.raises(SettingsError, match=r"'magic'.*paper.*fusion, per_frame"):
        method_named("magic")


def test_a_method_of_the_node_with_the_name_of_a_baseline_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(METHODS, "linear", METHODS["fusion"])
    with pytest.raises(SettingsError, match=r"'linear'.*methods/registry\.py.*none of paper, .*linear"):
        method_named("linear")


def test_the_names_of_the_node_mean_the_same_methods() -> None:
    assert {name: method_named(name) for name in METHODS if name in ALIASES} == {
        "fusion": FACTORIES["acts"],
        "per_frame": FACTORIES["paper"],
    }


def test_linear_continues_a_plane_beyond_what_was_measured(shipped: Dictionary) -> None:
    row, col = np.indices((32, 32))
    plane = (100 + 10 * row + 5 * col).astype(np.uint16)
    inner = (row >= 4) & (row <= 25) & (col >= 6) & (col <= 20)
    indices = np.random.default_rng(2).permutation(np.flatnonzero(inner))[:60].astype(np.uint16)
    image = step(FACTORIES["linear"](SKIN, shipped, {}), plane, indices)
    np.testing.assert_allclose(image, plane, atol=1e-3)


def test_linear_takes_the_nearest_where_there_is_no_triangle(shipped: Dictionary) -> None:
    field = np.zeros((32, 32), dtype=np.uint16)
    field[:, 16:] = 300
    image = step(FACTORIES["linear"](SKIN, shipped, {}), field, np.arange(32, dtype=np.uint16))
    np.testing.assert_array_equal(image, field)


def test_the_gaussian_process_is_exact_with_everything_near_measured(shipped: Dictionary) -> None:
    row, col = np.indices((32, 32))
    field = (600 * np.exp(-((row - 15) ** 2 + (col - 15) ** 2) / 30)).astype(np.uint16)
    indices = np.flatnonzero((row + col) % 2 == 0).astype(np.uint16)
    image = step(FACTORIES["gp"](SKIN, shipped, {}), field, indices)
    assert np.linalg.norm(image - field) < 0.03 * np.linalg.norm(field)


def test_last_value_remembers_and_zero_fill_does_not(shipped: Dictionary) -> None:
    field = np.full((32, 32), 77, dtype=np.uint16)
    first, second = np.array([1, 2], dtype=np.uint16), np.array([3], dtype=np.uint16)
    for name, seen in (("last", 3), ("zero", 1)):
        method = FACTORIES[name](SKIN, shipped, {})
        step(method, field, first)
        assert np.count_nonzero(step(method, field, second)) == seen
        method.reset()
        assert np.count_nonzero(step(method, field, second)) == 1


@pytest.mark.parametrize("make", [cosine_dictionary, haar_dictionary])
def test_dictionaries_that_are_not_learnt(make: type) -> None:
    atoms = make().atoms
    assert atoms.shape == (64, 1000)
    np.testing.assert_allclose(np.linalg.norm(atoms, axis=0), 1, rtol=1e-5)
    assert len(np.unique(atoms, axis=1).T) == 1000
    assert np.linalg.matrix_rank(atoms) == 64


def test_the_cosines_are_those_that_the_paper_compared_with(recording_path: Callable[[str], Path]) -> None:
    with np.load(recording_path("paper/dictionaries.npz")) as archive:
        np.testing.assert_allclose(cosine_dictionary().atoms, archive["dct_unit_exact"], atol=1e-6)


def test_dictionaries_by_name(tmp_path: Path) -> None:
    np.savez(tmp_path / "any.npz", mine=cosine_dictionary().atoms, text="words")
    assert dictionary_named(f"{tmp_path}/any.npz:mine").patch_size == 8
    for array, words in (("nothing", "there is none in"), ("text", r"shape \(\)")):
        with pytest.raises(DictionaryError, match=f"needed is an array '{array}'.*{words}"):
            dictionary_named(f"{tmp_path}/any.npz:{array}")
    with pytest.raises(DictionaryError, match="No such file"):
        dictionary_named(f"{tmp_path}/none.npz:mine")
    whole = (tmp_path / "any.npz").read_bytes()
    (tmp_path / "any.npz").write_bytes(whole[: len(whole) // 2] + b"x" + whole[len(whole) // 2 + 1 :])
    with pytest.raises(DictionaryError, match="damaged"):
        dictionary_named(f"{tmp_path}/any.npz:mine")


def test_patches_may_lie_closer(shipped: Dictionary) -> None:
    row, col = np.indices((32, 32))
    field = (600 * np.exp(-((row - 9) ** 2 + (col - 20) ** 2) / 8)).astype(np.uint16)
    indices = np.random.default_rng(1).permutation(1024)[:256].astype(np.uint16)
    errors = []
    for patch_step in (4, 1):
        method = FACTORIES["paper"](SKIN, shipped, {"patch_step": patch_step})
        errors.append(np.linalg.norm(step(method, field, indices) - field))
    # Each taxel then is the mean of up to 64 patches, not of 4.
    assert errors[1] < errors[0]
