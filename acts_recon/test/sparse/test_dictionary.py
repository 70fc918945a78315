# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from acts_core.errors import DictionaryError
from acts_recon.settings import ReconstructionSettings
from acts_recon.sparse import Dictionary, load_dictionary, save_dictionary, shipped_dictionary_path


def write(path: Path, **changes: object) -> Path:
    """A dictionary file with some fields changed; None leaves a field out."""
    good = Dictionary(np.ones((4, 3), dtype=np.float32), 2)
    content: dict[str, Any] = {
        "format": "acts-dictionary-1",
        "atoms": good.atoms,
        "patch_size": 2,
        "settings": "{}",
        "provenance": "",
        "sha256": good.sha256,
    }
    content.update(changes)
    np.savez(path, **{name: value for name, value in content.items() if value is not None})
    return path


def test_what_was_saved_is_loaded(dictionary: Dictionary, tmp_path: Path) -> None:
    path = tmp_path / "mine.dictionary"
    save_dictionary(dictionary, path)
    loaded = load_dictionary(path, patch_size=8)
    assert np.array_equal(loaded.atoms, dictionary.atoms)
    assert loaded.atoms.dtype == np.float32
    assert (loaded.patch_size, loaded.n_atoms) == (8, 150)
    assert loaded.settings == {"seed": 7}
    assert loaded.provenance == "made for tests"
    assert loaded.sha256 == dictionary.sha256


def test_a_file_is_loaded_as_it_should_be(tmp_path: Path) -> None:
    path = write(tmp_path / "d.npz")
    assert load_dictionary(path).n_atoms == load_dictionary(str(path)).n_atoms == 3


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"atoms": np.ones((5, 3), dtype=np.float32)}, "needed are 4 rows"),
        ({"atoms": np.ones(4, dtype=np.float32)}, "float matrix"),
        ({"atoms": np.ones((4, 3), dtype=np.int32)}, "float matrix"),
        ({"atoms": np.ones((4, 0), dtype=np.float32)}, "at least one column"),
        ({"atoms": np.full((4, 3), np.nan, dtype=np.float32)}, "NaN"),
        ({"atoms": np.full((4, 3), 1e300)}, "single precision"),
        ({"atoms": np.zeros((4, 3), dtype=np.float32)}, "all atoms are 0"),
        ({"atoms": np.full((4, 3), 1e-300)}, "all atoms are 0"),
        ({"atoms": np.full((4, 3), 2, dtype=np.float32)}, "hash"),
        ({"atoms": np.array([[object()]])}, r"atoms is an array of Python objects, .*such as atoms.astype\(str\)"),
        ({"patch_size": 3}, "needed are 9 rows"),
        ({"patch_size": "two"}, "wrong type"),
        ({"patch_size": np.inf}, "wrong type"),
        ({"settings": "{"}, "wrong type"),
        ({"format": "other"}, "format 'other'"),
        ({"sha256": None}, "lacks sha256"),
        ({"atoms": None, "settings": None}, "lacks atoms, settings"),
    ],
)
def test_a_wrong_file_is_told_apart(changes: dict[str, object], word: str, tmp_path: Path) -> None:
    path = write(tmp_path / "d.npz", **changes)
    with pytest.raises(DictionaryError, match=word) as caught:
        load_dictionary(path)
    assert str(path) in str(caught.value)


@pytest.mark.parametrize("content", [b"", b"hello", b"PK\x03\x04 cut short", b"\x80\x04\x95"])
def test_what_is_no_npz_is_refused(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "d.npz"
    path.write_bytes(content)
    with pytest.raises(DictionaryError, match="not an npz file, or a part of one"):
        load_dictionary(path)


def test_every_truncation_is_noticed(tmp_path: Path) -> None:
    whole = write(tmp_path / "d.npz").read_bytes()
    path = tmp_path / "cut.npz"
    for length in range(0, len(whole), 97):
        path.write_bytes(whole[:length])
        with pytest.raises(DictionaryError):
            load_dictionary(path)


def test_a_flipped_byte_is_noticed(tmp_path: Path) -> None:
    path = write(tmp_path / "d.npz")
    content = bytearray(path.read_bytes())
    content[content.index(np.float32(1).tobytes())] ^= 1
    path.write_bytes(content)
    with pytest.raises(DictionaryError, match="damaged"):
        load_dictionary(path)


def test_damage_anywhere_is_told_as_such(tmp_path: Path) -> None:
    whole = write(tmp_path / "d.npz").read_bytes()
    path = tmp_path / "hit.npz"
    rng = np.random.default_rng(5)
    refused = 0
    for _ in range(300):
        content = bytearray(whole)
        content[int(rng.integers(len(whole)))] ^= int(rng.integers(1, 256))
        path.write_bytes(content)
        try:
            dictionary = load_dictionary(path)
        except DictionaryError as error:
            assert str(path) in str(error)  # noqa: PT017
            refused += 1
        else:  # what was hit says nothing, as a time does
            assert np.isfinite(dictionary.atoms).all()
    assert refused > 200


def test_a_single_array_a_missing_file_and_a_folder_are_refused(tmp_path: Path) -> None:
    np.save(tmp_path / "one.npy", np.ones(3))
    with pytest.raises(DictionaryError, match="not an npz file"):
        load_dictionary(tmp_path / "one.npy")
    with pytest.raises(DictionaryError, match="No such file"):
        load_dictionary(tmp_path / "none.npz")
    with pytest.raises(DictionaryError, match="not a regular file"):
        load_dictionary(tmp_path)
    with pytest.raises(DictionaryError, match="cannot be written"):
        save_dictionary(Dictionary(np.ones((4, 3), dtype=np.float32), 2), tmp_path / "no" / "d.npz")


def test_the_patch_size_asked_for_is_needed(tmp_path: Path) -> None:
    with pytest.raises(DictionaryError, match="side 2; needed is 8"):
        load_dictionary(write(tmp_path / "d.npz"), patch_size=8)


def test_the_installed_dictionary_is_found() -> None:
    assert load_dictionary(shipped_dictionary_path(), patch_size=8).n_atoms == 1000


def test_a_dictionary_whose_atoms_are_too_long_is_refused(tmp_path: Path, dictionary: Dictionary) -> None:
    lengths = np.where(np.arange(dictionary.n_atoms) == 7, 1.5, 1.0).astype(np.float32)
    lengths[8] = 0.0
    for path, atoms in ((tmp_path / "good.npz", dictionary.atoms), (tmp_path / "long.npz", dictionary.atoms * lengths)):
        save_dictionary(Dictionary(atoms, 8), path)
    with pytest.raises(DictionaryError, match=r"long.npz: atom 7 has the norm 1.5: needed is 1, or 0"):
        ReconstructionSettings(method="per_frame", dictionary=str(tmp_path / "long.npz")).recovery()
    ReconstructionSettings(method="per_frame", dictionary=str(tmp_path / "good.npz")).recovery()
