# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Object libraries: full frames of known objects, with which an unknown one is compared."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from acts_core.array import COUNT_MAX, MAX_SIDE, TOUCH_COUNTS
from acts_core.errors import ObjectLibraryError
from acts_core.files import ModelFile

_FILE = ModelFile(
    kind="an object library",
    format="acts-objects-2",
    fields=("rows", "cols", "columns", "norms_counts", "classes", "names", "provenance", "sha256"),
    remedy="write one with acts library",
    error=ObjectLibraryError,
)

CLASSES_MAX = 0xFFFF
"""Most classes: what fits the class number of a message."""

_NORM_TOLERANCE = 1e-3
_NONE = np.empty(0, dtype=np.float32)


@dataclass(frozen=True)
class ObjectLibrary:
    """Full frames of known objects, each scaled to norm 1, and which object each shows.

    Attributes
    ----------
    rows, cols : int
        Size of the array.
    columns : np.ndarray [shape=(rows * cols, n_columns), dtype=float32]
        A frame a column, taxels row-major, no value negative; every column has norm 1.
    norms_counts : np.ndarray [shape=(n_columns,), dtype=float32]
        Norm that each column had before it was scaled [counts]: how hard was pressed.
    classes : np.ndarray [shape=(n_columns,), dtype=int64]
        Class number of every column: 0 to ``n_classes - 1``, each at least once.
    names : tuple of str
        Name of every class in UTF-8, none empty, none twice.
    provenance : str
        From what it was made, for a person.

    Raises
    ------
    ObjectLibraryError
        When any of this does not hold.
    """

    rows: int
    cols: int
    columns: NDArray[np.float32]
    norms_counts: NDArray[np.float32]
    classes: NDArray[np.int64]
    names: tuple[str, ...]
    provenance: str = ""

    def __post_init__(self) -> None:
        if not (1 <= self.rows <= MAX_SIDE and 1 <= self.cols <= MAX_SIDE):
            raise ObjectLibraryError(f"array of {self.rows} x {self.cols}: allowed are 1 to {MAX_SIDE} rows and cols")
        columns = np.asarray(self.columns)
        taxels = self.rows * self.cols
        if columns.dtype.kind != "f" or columns.ndim != 2 or columns.shape[0] != taxels or columns.shape[1] < 1:
            raise ObjectLibraryError(
                f"columns of shape {columns.shape}, {columns.dtype}: for {self.rows} x {self.cols} taxels needed is a "
                f"float matrix of {taxels} rows and at least one column"
            )
        if not np.isfinite(columns).all():
            raise ObjectLibraryError("the columns hold NaN or infinity; make the library anew from whole frames")
        if columns.min() < 0:
            raise ObjectLibraryError("the columns hold negative values; make the library of counts, 0 to 1023")
        norms = np.linalg.norm(columns.astype(np.float64), axis=0)
        if np.abs(norms - 1).max() > _NORM_TOLERANCE:
            worst = int(np.argmax(np.abs(norms - 1)))
            raise ObjectLibraryError(f"column {worst} has norm {norms[worst]:.4g}; scale every column to norm 1")
        names = tuple(str(name) for name in self.names)
        self._check_names(names)
        object.__setattr__(self, "columns", np.ascontiguousarray(columns, dtype=np.float32))
        object.__setattr__(self, "norms_counts", self._checked_norms(norms.size))
        object.__setattr__(self, "classes", self._checked_classes(columns.shape[1], len(names)))
        object.__setattr__(self, "names", names)

    def _checked_norms(self, n_columns: int) -> NDArray[np.float32]:
        given = np.asarray(self.norms_counts)
        with np.errstate(over="ignore"):  # what is too large for float32 is told below
            norms = np.ascontiguousarray(given, dtype=np.float32) if given.dtype.kind == "f" else _NONE
        if norms.shape != (n_columns,) or not np.all((norms > 0) & (norms < np.inf)):
            raise ObjectLibraryError(
                f"norms_counts of shape {given.shape}, {given.dtype}: needed is a positive, finite float for each "
                f"of the {n_columns} columns, in single precision"
            )
        return norms

    @staticmethod
    def _check_names(names: tuple[str, ...]) -> None:
        if not 1 <= len(names) <= CLASSES_MAX:
            raise ObjectLibraryError(f"{len(names)} names; allowed are 1 to {CLASSES_MAX} classes")
        if not all(names) or len(set(names)) < len(names):
            raise ObjectLibraryError(f"names {', '.join(map(repr, names))}: give every class a name of its own")
        for name in names:
            try:
                name.encode()
            except UnicodeEncodeError as error:
                # As of a file that is named in another encoding.
                raise ObjectLibraryError(
                    f"name {name!r}: needed is text in UTF-8, as messages have it; name it anew"
                ) from error

    def _checked_classes(self, n_columns: int, n_classes: int) -> NDArray[np.int64]:
        classes = np.asarray(self.classes)
        if classes.dtype.kind not in "iu" or classes.shape != (n_columns,):
            raise ObjectLibraryError(
                f"classes of shape {classes.shape}, {classes.dtype}: needed is a whole number for each of the "
                f"{n_columns} columns"
            )
        present = np.unique(classes).tolist()
        if present != list(range(n_classes)):
            raise ObjectLibraryError(
                f"class numbers {present}: needed are 0 to {n_classes - 1}, one for each name, each at least once"
            )
        return np.ascontiguousarray(classes, dtype=np.int64)

    @property
    def n_columns(self) -> int:
        """Number of columns."""
        return int(self.columns.shape[1])

    @property
    def n_classes(self) -> int:
        """Number of classes."""
        return len(self.names)

    @property
    def sha256(self) -> str:
        """Hash of everything but the provenance, as stored in the file."""
        digest = hashlib.sha256(f"{self.rows} {self.cols} {self.n_columns} {list(self.names)}".encode())
        digest.update(self.columns.astype("<f4").tobytes())
        digest.update(self.norms_counts.astype("<f4").tobytes())
        digest.update(self.classes.astype("<i8").tobytes())
        return digest.hexdigest()


def build_object_library(
    frames: ArrayLike, labels: Sequence[str], *, touch_counts: int = TOUCH_COUNTS, provenance: str = ""
) -> ObjectLibrary:
    """Make a library of full frames, one column a frame; the paper takes them from the middle of contacts.

    Parameters
    ----------
    frames : array_like [shape=(n, rows, cols), dtype=number]
        Full frames in counts, 0 to 1023.
    labels : sequence of str [n]
        Name of the object of every frame. Classes are numbered by name, in alphabetical order.
    touch_counts : int
        Counts at or below it are taken as 0.
    provenance : str
        See `ObjectLibrary`.

    Raises
    ------
    ObjectLibraryError
        When frames and labels do not fit together, or a frame holds impossible values or no touch.
    """
    full = np.asarray(frames)
    if full.ndim != 3 or full.dtype.kind not in "iuf" or len(full) == 0:
        raise ObjectLibraryError(
            f"frames of shape {full.shape}, {full.dtype}: needed are numbers (n, rows, cols), at least one frame"
        )
    if len(labels) != len(full):
        raise ObjectLibraryError(f"{len(full)} frames and {len(labels)} labels; needed is a label for each frame")
    flat = full.reshape(len(full), -1).astype(np.float64)
    # Written so that NaN is refused too.
    if not np.all((flat >= 0) & (flat <= COUNT_MAX)):
        raise ObjectLibraryError(f"frames with values outside of 0 to {COUNT_MAX} counts, which no board reads")
    flat[flat <= touch_counts] = 0
    norms = np.linalg.norm(flat, axis=1)
    if not norms.all():
        first = int(np.argmin(norms))
        raise ObjectLibraryError(
            f"frame {first} ({labels[first]!r}) is not above {touch_counts} counts anywhere; take frames from the "
            "middle of a contact"
        )
    names, classes = np.unique(np.asarray(labels, dtype=np.str_), return_inverse=True)
    return ObjectLibrary(
        rows=full.shape[1],
        cols=full.shape[2],
        columns=(flat / norms[:, None]).T.astype(np.float32),
        norms_counts=norms.astype(np.float32),
        classes=classes.astype(np.int64),
        names=tuple(names.tolist()),
        provenance=provenance,
    )


def save_object_library(library: ObjectLibrary, path: Path) -> None:
    """Write a library file (npz).

    Raises
    ------
    ObjectLibraryError
        When the file cannot be written.
    """
    _FILE.write(
        path,
        {
            "rows": library.rows,
            "cols": library.cols,
            "columns": library.columns,
            "norms_counts": library.norms_counts,
            "classes": library.classes,
            "names": np.array(library.names, dtype=np.str_),
            "provenance": library.provenance,
            "sha256": library.sha256,
        },
    )


def load_object_library(path: Path | str, *, shape: tuple[int, int] | None = None) -> ObjectLibrary:
    """Read a library file and check that it is whole.

    Parameters
    ----------
    path : Path or str
    shape : (int, int) or None
        Rows and columns of the array that it is for; None accepts any.

    Raises
    ------
    ObjectLibraryError
        When the file is missing, is no library, is damaged, or is for another array.
    """
    path = Path(path)
    content = _FILE.read(path)
    try:
        library = ObjectLibrary(
            rows=int(content["rows"]),
            cols=int(content["cols"]),
            columns=content["columns"],
            norms_counts=content["norms_counts"],
            classes=content["classes"],
            names=tuple(content["names"].tolist()),
            provenance=str(content["provenance"]),
        )
    except ObjectLibraryError as error:
        raise ObjectLibraryError(f"{path}: {error}") from None
    except (TypeError, ValueError, OverflowError) as error:
        raise ObjectLibraryError(f"{path}: a field has the wrong type ({error}); write the library anew") from error
    if library.sha256 != str(content["sha256"]):
        raise ObjectLibraryError(f"{path}: the content does not fit its hash, the file is damaged; copy it anew")
    if shape is not None and (library.rows, library.cols) != shape:
        raise ObjectLibraryError(
            f"{path}: made for an array of {library.rows} x {library.cols}; this one has {shape[0]} x {shape[1]}"
        )
    return library
