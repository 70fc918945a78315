# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Dictionary files: the atoms of tactile patches, and where they came from."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import DictionaryError
from acts_core.files import ModelFile, settings_field

_FILE = ModelFile(
    kind="a dictionary file",
    format="acts-dictionary-1",
    fields=("atoms", "patch_size", "settings", "provenance", "sha256"),
    remedy="make one with `acts train`",
    error=DictionaryError,
)

_NORM_ERROR = 1e-3


@dataclass(frozen=True)
class Dictionary:
    """Atoms of square patches.

    Attributes
    ----------
    atoms : np.ndarray [shape=(patch_size**2, n_atoms), dtype=float32]
        A column an atom; pixels are numbered column first (see `acts_recon.sparse.patches`).
    patch_size : int
        Side of a patch, in taxels.
    settings : mapping
        How it was learnt: names to plain numbers and words.
    provenance : str
        From what it was learnt, for a person.
    """

    atoms: NDArray[np.float32]
    patch_size: int
    settings: Mapping[str, Any] = field(default_factory=dict)
    provenance: str = ""

    def __post_init__(self) -> None:
        atoms = np.asarray(self.atoms)
        if atoms.ndim != 2 or not np.issubdtype(atoms.dtype, np.floating):
            raise DictionaryError(f"atoms of shape {atoms.shape}, {atoms.dtype}: needed is a float matrix")
        if self.patch_size < 1 or atoms.shape[0] != self.patch_size**2 or atoms.shape[1] < 1:
            raise DictionaryError(
                f"atoms of shape {atoms.shape}: for patches of {self.patch_size} x {self.patch_size} taxels needed are "
                f"{self.patch_size**2} rows and at least one column"
            )
        with np.errstate(over="ignore"):  # what is too large for float32 is told below
            atoms = np.ascontiguousarray(atoms, dtype=np.float32)
        if not np.isfinite(atoms).all():
            raise DictionaryError(
                "the atoms hold NaN or infinity, in single precision; learn the dictionary anew with `acts train`"
            )
        if not np.any(atoms):
            raise DictionaryError("all atoms are 0; learn the dictionary anew with `acts train`")
        object.__setattr__(self, "atoms", atoms)

    @property
    def n_atoms(self) -> int:
        """Number of atoms."""
        return int(self.atoms.shape[1])

    def require_unit_atoms(self) -> None:
        """Check that each atom has the norm 1, or is all 0: the recovery takes them for that, and else goes wrong.

        Raises
        ------
        DictionaryError
            When the norm of one is off by more than a thousandth.
        """
        norms = np.linalg.norm(self.atoms.astype(np.float64), axis=0)
        is_wrong = (norms > 0.0) & (np.abs(norms - 1.0) > _NORM_ERROR)
        if is_wrong.any():
            atom = int(is_wrong.argmax())
            raise DictionaryError(
                f"atom {atom} has the norm {norms[atom]:.4g}: needed is 1, or 0 for one that is not used; divide each "
                "atom by its norm"
            )

    @property
    def sha256(self) -> str:
        """Hash of patch size and atoms, as stored in the file."""
        digest = hashlib.sha256(f"{self.patch_size} {self.atoms.shape}".encode())
        digest.update(self.atoms.astype("<f4").tobytes())
        return digest.hexdigest()


def save_dictionary(dictionary: Dictionary, path: Path) -> None:
    """Write a dictionary file (npz).

    Raises
    ------
    DictionaryError
        When the file cannot be written.
    """
    _FILE.write(
        path,
        {
            "atoms": dictionary.atoms,
            "patch_size": dictionary.patch_size,
            "settings": settings_field(dictionary.settings),
            "provenance": dictionary.provenance,
            "sha256": dictionary.sha256,
        },
    )


def load_dictionary(path: Path | str, *, patch_size: int | None = None) -> Dictionary:
    """Read a dictionary file and check that it is whole.

    Parameters
    ----------
    path : Path or str
    patch_size : int or None
        The side of the patches that the caller works with; None accepts any.

    Raises
    ------
    DictionaryError
        When the file is missing, is no dictionary file, is damaged, or is for other patches.
    """
    path = Path(path)
    content = _FILE.read(path)
    try:
        dictionary = Dictionary(
            content["atoms"],
            int(content["patch_size"]),
            _FILE.settings(path, content),
            str(content["provenance"]),
        )
    except DictionaryError as error:
        raise DictionaryError(f"{path}: {str(error).removeprefix(f'{path}: ')}") from None
    except (TypeError, ValueError, OverflowError) as error:
        raise DictionaryError(f"{path}: a field has the wrong type ({error}); make one with `acts train`") from error
    if dictionary.sha256 != str(content["sha256"]):
        raise DictionaryError(f"{path}: the atoms do not fit their hash, the file is damaged; copy or train it anew")
    if patch_size is not None and dictionary.patch_size != patch_size:
        raise DictionaryError(f"{path}: made for patches of side {dictionary.patch_size}; needed is {patch_size}")
    return dictionary
