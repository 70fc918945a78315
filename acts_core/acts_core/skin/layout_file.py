# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Layout files: which wires of the matrix run under which patch of the skin. `docs/layouts.md` has them key by key."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.array import MAX_SIDE, ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.files import Section, is_number, read_yaml, shown
from acts_core.names import is_short_name
from acts_core.skin.skin_patch import SkinPatch
from acts_core.transforms import Transform

NO_PATCH = 255
"""In place of the index of a patch, where there is no skin."""

MAX_PATCHES = 16
"""A board is told four bits for each taxel (`SkinMap`); where some are no skin, one value is theirs."""

_FILE_KEYS = ("matrix", "picture", "pitch_m", "row_pitch_m", "stood_on", "patches")
_PATCH_KEYS = ("at", "wires", "link", "pose", "pitch_m", "row_pitch_m", "radius_m", "row_radius_m")
_WIRES_KEYS = ("down", "across")
_POSE_KEYS = ("position_m", "rpy_rad", "quaternion_xyzw")

_LINK = re.compile(r"[A-Za-z_][A-Za-z0-9_/]{0,127}")
_WIRES = re.compile(r"(rows|cols)(.*)")
_RANGE = re.compile(r"([0-9]{1,2})(?: +to +([0-9]{1,2})(?: +by +([0-9]{1,2}))?)?")
_MAX_M = 10.0


@dataclass(frozen=True)
class LayoutFile:
    """What a layout file says; as of `acts_core.skin.layouts.Layout`.

    `matrix` is the number of rows and of columns of the matrix.
    """

    matrix: tuple[int, int]
    taxels: NDArray[np.uint16]
    pitch_m: float
    row_pitch_m: float
    patches: tuple[SkinPatch, ...]
    patch_of: NDArray[np.uint8]
    stood_on: bool | None


@dataclass(frozen=True)
class _Wired:
    """A patch with the matrix' taxels under it, shape (rows, cols)."""

    patch: SkinPatch
    taxels: NDArray[np.intp]
    section: Section


def read_layout(path: Path, rows: int | None, cols: int | None) -> LayoutFile:
    """Read a layout file for a matrix of `rows` x `cols`, or None for what the file says.

    Raises
    ------
    ArrayError
        When it is made for another matrix.
    SettingsError
        For anything wrong in it, with file, line, patch and key, and what is allowed.
    """
    top = read_yaml(path)
    top.check_keys(_FILE_KEYS)
    rows, cols = _matrix(top, rows, cols)
    pitch_m = _length(top, "pitch_m", ArrayGeometry().pitch_m)
    row_pitch_m = _length(top, "row_pitch_m", pitch_m)
    patches = top.section("patches", "")
    if not 1 <= len(patches.values) <= MAX_PATCHES:
        raise top.error(f"patches: {len(patches.values)} of them; allowed are 1 to {MAX_PATCHES}", "patches")
    names = patches.names(is_short_name, "patch")
    wired = [
        _patch(name, patches.section(name, f"patch {name}"), (rows, cols), (pitch_m, row_pitch_m)) for name in names
    ]
    picture_rows, picture_cols = _picture(top, wired, rows, cols)
    taxels, patch_of = _arranged(wired, (picture_rows, picture_cols), cols)
    if len(wired) == MAX_PATCHES and (taxels < 0).any():
        raise top.error(
            f"patches: {len(wired)}, and places without skin; allowed are {MAX_PATCHES - 1} then", "patches"
        )
    # Where there is no skin, the rest of the matrix in any order: every taxel has a place.
    taxels[taxels < 0] = np.setdiff1d(np.arange(rows * cols), taxels)
    geometry = ArrayGeometry(picture_rows, picture_cols, pitch_m, row_pitch_m)
    return LayoutFile(
        (rows, cols),
        taxels.astype(np.uint16),
        pitch_m,
        row_pitch_m,
        tuple(one.patch if "pose" in one.section.values else in_picture(one.patch, geometry) for one in wired),
        patch_of,
        top.flag("stood_on"),
    )


def _matrix(top: Section, rows: int | None, cols: int | None) -> tuple[int, int]:
    """The size that is asked for, or that of the file, or else 32 x 32; refused where the file is for another."""
    made_for = _size(top, "matrix") if "matrix" in top.values else None
    default_rows, default_cols = made_for or (32, 32)
    rows, cols = default_rows if rows is None else rows, default_cols if cols is None else cols
    ArrayGeometry(rows, cols)  # refuses sizes that are none
    if made_for not in (None, (rows, cols)):
        raise ArrayError(
            f"layout {top.path.stem} of a matrix of {rows} x {cols}: it is made of {made_for[0]} x {made_for[1]}; "
            f"set rows to {made_for[0]} and cols to {made_for[1]} if that is your board, or use another layout"
        )
    return rows, cols


def _size(section: Section, key: str) -> tuple[int, int]:
    given = section.values[key]
    if not _are_whole(given) or not all(1 <= number <= MAX_SIDE for number in given):
        raise section.error(f"{key} = {shown(given)}: allowed is [rows, columns], each 1 to {MAX_SIDE}", key)
    return given[0], given[1]


def _are_whole(given: object) -> bool:
    return isinstance(given, list) and len(given) == 2 and all(type(number) is int for number in given)


def _length(section: Section, key: str, default: float) -> float:
    return section.number(key, default, highest=1, unit=" [m]")


def _patch(name: str, section: Section, matrix: tuple[int, int], pitches_m: tuple[float, float]) -> _Wired:
    section.check_keys(_PATCH_KEYS)
    at = section.values.get("at", [0, 0])
    if not _are_whole(at) or not all(0 <= number < MAX_SIDE for number in at):
        raise section.error(
            f"at = {shown(at)}: allowed is [row, column] of the picture, each 0 to {MAX_SIDE - 1}", "at"
        )
    taxels = _taxels(section, matrix)
    rows, cols = taxels.shape
    if at[0] + rows > MAX_SIDE or at[1] + cols > MAX_SIDE:
        raise section.error(f"{rows} x {cols} taxels at {at}: a picture has up to {MAX_SIDE} rows and columns", "wires")
    link = _link(section)
    pitch_m = _length(section, "pitch_m", pitches_m[0])
    default_m = pitch_m if "pitch_m" in section.values else pitches_m[1]
    patch = SkinPatch(
        name,
        at[0],
        at[0] + rows,
        at[1],
        at[1] + cols,
        link,
        pitch_m,
        _length(section, "row_pitch_m", default_m),
        _pose(section),
    )
    return _Wired(
        replace(
            patch,
            radius_m=_radius(section, "radius_m", cols * patch.pitch_m),
            row_radius_m=_radius(section, "row_radius_m", rows * patch.row_pitch_m),
        ),
        taxels,
        section,
    )


def _taxels(section: Section, matrix: tuple[int, int]) -> NDArray[np.intp]:
    """The matrix' taxels under a patch, block by block downwards; shape (rows, cols) of the patch."""
    if "wires" not in section.values:
        raise section.error("wires is missing: which wires of the matrix run down and across the patch")
    blocks = [_block(block, matrix) for block in section.sections("wires", f"{section.what}: wires")]
    if not blocks:
        raise section.error("wires: there has to be at least one block", "wires")
    if len({block.shape[1] for block in blocks}) > 1:
        counts = ", ".join(str(block.shape[1]) for block in blocks)
        raise section.error(f"wires: {counts} wires across; needed are as many in each block", "wires")
    return np.concatenate(blocks)


def _link(section: Section) -> str:
    """The link that a patch lies on, which needs a pose then; empty for none."""
    link = section.text("link", "") or ""
    if link and _LINK.fullmatch(link) is None:
        raise section.error(f"link = {shown(link)}: a name consists of letters, digits, _ and /", "link")
    if link and "pose" not in section.values:
        raise section.error(f"pose is missing: where the patch lies on the link {link}", "link")
    return link


def _pose(section: Section) -> Transform:
    if "pose" not in section.values:
        return Transform()
    pose = section.section("pose", f"{section.what}: pose")
    pose.check_keys(_POSE_KEYS)
    transform = pose.transform()
    if max(map(abs, transform.position_m)) > _MAX_M:
        raise pose.error(
            f"position_m = {list(transform.position_m)}: allowed are -{_MAX_M:g} to {_MAX_M:g} [m]", "position_m"
        )
    return transform


def _radius(section: Section, key: str, length_m: float) -> float:
    value = section.values.get(key, 0.0)
    if not is_number(value) or abs(value) > _MAX_M:
        raise section.error(f"{key} = {shown(value)}: allowed is a number from -{_MAX_M:g} to {_MAX_M:g} [m]", key)
    if value and length_m > np.pi * abs(value):
        raise section.error(
            f"{key} = {value}: the patch is {length_m:.4g} m long there, more than half way around; allowed are "
            f"{length_m / np.pi:.2g} and more, or 0 for flat",
            key,
        )
    return float(value)


def _block(section: Section, matrix: tuple[int, int]) -> NDArray[np.intp]:
    """Taxels where the wires down cross the wires across; shape (wires down, wires across)."""
    for key, value in section.values.items():
        if key not in _WIRES_KEYS and value is None:  # YAML takes what follows a comma for a key of its own
            raise section.error(
                f"{key} stands alone behind a comma: put wires with commas in quotes, such as across: 'rows 0, 2 to 3'",
                key,
            )
    section.check_keys(_WIRES_KEYS)
    down_kind, down = _wires(section, "down", matrix)
    across_kind, across = _wires(section, "across", matrix)
    if down_kind == across_kind:
        raise section.error(f"down and across are both {down_kind}: rows of the matrix cross its cols", "across")
    if down_kind == "rows":
        return np.add.outer(np.array(down) * matrix[1], np.array(across))
    return np.add.outer(np.array(down), np.array(across) * matrix[1])


def _wires(section: Section, key: str, matrix: tuple[int, int]) -> tuple[str, list[int]]:
    text = section.text(key)
    found = None if text is None else _WIRES.fullmatch(text)
    if found is None:
        raise _wires_error(section, key)
    kind, ranges = found[1], found[2].strip()
    limit = matrix[0] if kind == "rows" else matrix[1]
    wires: list[int] = []
    for one in ranges.split(",") if ranges else [f"0 to {limit - 1}"]:
        matched = _RANGE.fullmatch(one.strip())
        if matched is None or matched[3] == "0":
            raise _wires_error(section, key)
        first, last = int(matched[1]), int(matched[2] or matched[1])
        step = int(matched[3] or 1) * (1 if last >= first else -1)
        if step == 0:
            raise _wires_error(section, key)
        wires += range(first, last + (1 if step > 0 else -1), step)
    if max(wires) >= limit:
        raise section.error(f"{key} = {text!r}: the {kind} of the matrix are 0 to {limit - 1}", key)
    if len(set(wires)) < len(wires):
        raise section.error(f"{key} = {shown(text)}: a wire is named twice", key)
    return kind, wires


def _wires_error(section: Section, key: str) -> Exception:
    return section.error(
        f"{key} = {shown(section.values.get(key))}: allowed is 'rows' or 'cols' of the matrix and which of them, such "
        "as 'rows 0 to 7', 'cols 31 to 1 by 2' or 'rows 3, 5, 8 to 10'; without numbers all of them",
        key,
    )


def _picture(top: Section, wired: list[_Wired], rows: int, cols: int) -> tuple[int, int]:
    """Size of the picture: as given, or as large as the patches need."""
    needed = (max(one.patch.end_row for one in wired), max(one.patch.end_col for one in wired))
    size = _size(top, "picture") if "picture" in top.values else needed
    for one in wired:
        if one.patch.end_row > size[0] or one.patch.end_col > size[1]:
            raise one.section.error(f"at: the patch reaches beyond the picture of {size[0]} x {size[1]}", "at")
    if size[0] * size[1] != rows * cols:
        raise top.error(
            f"a picture of {size[0]} x {size[1]}: it has a place for each of the {rows * cols} taxels of the matrix of "
            f"{rows} x {cols}, also for those without skin; give picture: [rows, columns] with that product, or, where "
            "yours is another, matrix: [rows, columns]",
            "picture",
        )
    return size


def _arranged(
    wired: list[_Wired], picture: tuple[int, int], matrix_cols: int
) -> tuple[NDArray[np.intp], NDArray[np.uint8]]:
    """All patches in the picture: the taxel and the patch at each of its places, -1 and `NO_PATCH` without skin."""
    taxels = np.full(picture, -1, dtype=np.intp)
    patch_of = np.full(picture, NO_PATCH, dtype=np.uint8)
    owner: dict[int, str] = {}
    for index, one in enumerate(wired):
        _place(one, index, taxels, patch_of, [other.patch.name for other in wired])
        for taxel in one.taxels.ravel().tolist():
            if taxel in owner:
                row, col = divmod(taxel, matrix_cols)
                raise one.section.error(
                    f"wires: the taxel at row {row}, column {col} of the matrix is under patch {owner[taxel]} already",
                    "wires",
                )
            owner[taxel] = one.patch.name
    return taxels, patch_of


def _place(one: _Wired, index: int, taxels: NDArray[np.intp], patch_of: NDArray[np.uint8], names: list[str]) -> None:
    there = one.patch.of(patch_of)
    if (there != NO_PATCH).any():
        raise one.section.error(
            f"at: the patch lies over patch {names[int(there[there != NO_PATCH][0])]} in the picture", "at"
        )
    there[...] = index
    one.patch.of(taxels)[...] = one.taxels


def in_picture(patch: SkinPatch, geometry: ArrayGeometry) -> SkinPatch:
    """A patch where it lies in a picture of this geometry, as those without a pose do."""
    x_m = geometry.x_m((patch.first_col + patch.end_col - 1) / 2)
    y_m = geometry.y_m((patch.first_row + patch.end_row - 1) / 2)
    return replace(patch, pose=Transform((float(x_m), float(y_m), 0.0)))
