# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.errors import ArrayError, SettingsError
from acts_recon.learning import (
    KsvdConfig,
    KsvdProgress,
    KsvdState,
    code_patches,
    learn_dictionary,
    prune_coherent,
    random_patches,
    training_patches,
)

pytestmark = pytest.mark.slow


def planted(rng: np.random.Generator, n: int = 1500) -> tuple[NDArray, NDArray]:
    """Patches that are sums of 3 of 40 atoms, and the atoms."""
    atoms = rng.standard_normal((20, 40))
    atoms /= np.linalg.norm(atoms, axis=0)
    codes = np.zeros((40, n))
    for column in codes.T:
        column[rng.permutation(40)[:3]] = rng.standard_normal(3)
    return (atoms @ codes).T, atoms


def test_planted_atoms_are_found_again() -> None:
    rng = np.random.default_rng(0)
    patches, atoms = planted(rng)
    log: list[KsvdProgress] = []
    learnt = learn_dictionary(patches, KsvdConfig(atoms=40, sparsity=3, iterations=40), rng=rng, progress=log.append)
    found = (np.abs(atoms.T @ learnt).max(axis=1) > 0.98).mean()
    assert found >= 0.85
    assert [entry.iteration for entry in log] == list(range(1, 41))
    assert log[-1].relative_error < 0.35 * log[0].relative_error


def test_atoms_are_unit_norm_with_a_positive_peak_and_seeded() -> None:
    patches, _ = planted(np.random.default_rng(1), 300)
    config = KsvdConfig(atoms=30, sparsity=3, iterations=2)
    first = learn_dictionary(patches, config, rng=np.random.default_rng(5))
    assert first.shape == (20, 30)
    assert first.dtype == np.float32
    np.testing.assert_allclose(np.linalg.norm(first, axis=0), 1, rtol=1e-5)
    assert (np.take_along_axis(first, np.abs(first).argmax(axis=0)[None], axis=0) > 0).all()
    assert np.array_equal(first, learn_dictionary(patches, config, rng=np.random.default_rng(5)))


def test_learning_goes_on_where_it_stopped() -> None:
    patches, _ = planted(np.random.default_rng(1), 300)
    config = KsvdConfig(atoms=30, sparsity=3, iterations=5)
    states: list[KsvdState] = []
    whole = learn_dictionary(
        patches,
        config,
        rng=np.random.default_rng(5),
        save=lambda state: states.append(KsvdState(state.iteration, state.atoms.copy())),
    )
    assert [state.iteration for state in states] == [1, 2, 3, 4]
    for state in states:
        again = learn_dictionary(patches, config, rng=np.random.default_rng(5), resume=state)
        assert np.array_equal(again, whole)
    with pytest.raises(ArrayError, match="state after iteration 4"):
        learn_dictionary(patches, KsvdConfig(atoms=30, iterations=4), rng=np.random.default_rng(5), resume=states[3])


def test_repeated_atoms_are_replaced() -> None:
    rng = np.random.default_rng(2)
    patches, _ = planted(rng, 100)
    # Most of the patches are the same one, so the atoms begin as copies of each other.
    patches[20:] = patches[0]
    log: list[KsvdProgress] = []
    learnt = learn_dictionary(patches, KsvdConfig(atoms=20, sparsity=2, iterations=4), rng=rng, progress=log.append)
    assert log[0].replaced > 0
    assert np.isfinite(learnt).all()


def test_coding_is_orthogonal_matching_pursuit() -> None:
    rng = np.random.default_rng(3)
    atoms = rng.standard_normal((30, 50)).astype(np.float32)
    atoms /= np.linalg.norm(atoms, axis=1, keepdims=True)
    patches = rng.standard_normal((20, 50)).astype(np.float32)
    chosen = np.zeros((20, 4), dtype=np.int32)
    coefficients = np.zeros((20, 4), dtype=np.float32)
    code_patches(patches @ atoms.T, atoms @ atoms.T, chosen, coefficients)
    for patch, picks, values in zip(patches, chosen, coefficients, strict=True):
        left = patch
        for i in range(4):
            assert picks[i] == np.argmax(np.abs(atoms @ left))
            fit = np.linalg.lstsq(atoms[picks[: i + 1]].T, patch, rcond=None)[0]
            left = patch - fit @ atoms[picks[: i + 1]]
        np.testing.assert_allclose(values, fit, rtol=1e-3, atol=1e-4)


def test_a_patch_that_is_an_atom_needs_one() -> None:
    atoms = np.eye(6, dtype=np.float32)
    chosen = np.full((1, 3), 5, dtype=np.int32)
    coefficients = np.ones((1, 3), dtype=np.float32)
    code_patches(2 * atoms[2:3] @ atoms.T, atoms @ atoms.T, chosen, coefficients)
    assert chosen.tolist() == [[2, 2, 2]]
    assert coefficients.tolist() == [[2, 0, 0]]


@pytest.mark.parametrize(
    ("patches", "word"),
    [
        (np.ones((5, 4)), "5 patches for 10 atoms"),
        (np.ones(50), r"shape \(50,\)"),
        (np.zeros((20, 4)), "all 0"),
        (np.full((20, 4), np.nan), "NaN"),
    ],
)
def test_unusable_patches_are_refused(patches: NDArray, word: str) -> None:
    with pytest.raises(ArrayError, match=word):
        learn_dictionary(patches, KsvdConfig(atoms=10), rng=np.random.default_rng(0))


def test_patches_in_any_order_in_memory_give_the_same_atoms() -> None:
    patches = np.random.default_rng(2).random((60, 16)).astype(np.float32)
    config = KsvdConfig(atoms=20, sparsity=3, iterations=2)
    atoms = learn_dictionary(patches, config, rng=np.random.default_rng(0))
    for same in (np.asfortranarray(patches), np.repeat(patches, 2, axis=1)[:, ::2]):
        np.testing.assert_array_equal(learn_dictionary(same, config, rng=np.random.default_rng(0)), atoms)


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_a_state_that_is_not_finite_is_refused(wrong: float) -> None:
    patches = np.random.default_rng(2).random((60, 16)).astype(np.float32)
    atoms = patches[:20].copy()
    atoms[3, 4] = wrong
    with pytest.raises(ArrayError, match="the atoms of the state hold NaN or infinity"):
        learn_dictionary(
            patches, KsvdConfig(atoms=20), rng=np.random.default_rng(0), resume=KsvdState(iteration=1, atoms=atoms)
        )


def test_settings_are_checked() -> None:
    with pytest.raises(SettingsError, match="sparsity = 0"):
        KsvdConfig(sparsity=0)


def test_patches_are_cut_column_first_and_pressed_enough() -> None:
    frames = np.zeros((1, 8, 8), dtype=np.uint16)
    frames[0, 3, 1] = 500
    frames[0, 2, 1] = 60
    rng = np.random.default_rng(0)
    patches = random_patches(frames, 3, min_active=1, rng=rng)
    assert patches.shape == (3, 64)
    assert np.flatnonzero(patches[0]).tolist() == [8 + 3]
    assert random_patches(frames, 3, min_active=2, rng=rng).shape == (0, 64)
    with pytest.raises(ArrayError, match="do not fit"):
        random_patches(frames[:, :5], 3, rng=rng)
    with pytest.raises(ArrayError, match="frames of shape"):
        random_patches(frames[0], 3, rng=rng)


def test_patches_are_the_same_in_pieces_of_any_size(monkeypatch: pytest.MonkeyPatch) -> None:
    frames = np.random.default_rng(0).integers(0, 1024, (5, 12, 10)).astype(np.uint16)
    frames[frames < 700] = 0
    whole = random_patches(frames, 50, min_active=20, rng=np.random.default_rng(1))
    assert 0 < len(whole) < 50
    monkeypatch.setattr(training_patches, "_PLACES", 7)
    np.testing.assert_array_equal(random_patches(frames, 50, min_active=20, rng=np.random.default_rng(1)), whole)


def test_no_two_kept_patches_look_alike() -> None:
    rng = np.random.default_rng(0)
    base = rng.random((40, 16)).astype(np.float32)
    patches = np.concatenate([base, 3 * base, base + 1e-3])
    keep = prune_coherent(patches, 0.995)
    unit = patches[keep] / np.linalg.norm(patches[keep], axis=1, keepdims=True)
    assert np.tril(np.abs(unit @ unit.T), -1).max() <= 0.995
    assert keep[0]
    assert not keep[40:].any()


@pytest.mark.parametrize(
    ("value", "limit", "words"),
    [
        (np.nan, 0.9, "NaN or infinity"),
        (np.inf, 0.9, "NaN or infinity"),
        (0.0, 0.9, "all 0"),
        (1.0, np.nan, "limit = nan"),
    ],
)
def test_patches_that_cannot_be_compared_are_refused(value: float, limit: float, words: str) -> None:
    patches = np.random.default_rng(0).random((6, 16)).astype(np.float32)
    patches[3] *= 0.0
    patches[3] += value
    with pytest.raises(ArrayError, match=words):
        prune_coherent(patches, limit)
    with pytest.raises(ArrayError, match="needed are"):
        prune_coherent(patches[0], 0.9)
