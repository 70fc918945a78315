# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Layout files of one's own: what they may hold, and words about what they may not."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from acts_core.errors import ActsError, ArrayError, SettingsError
from acts_core.skin import LAYOUTS, NO_PATCH, Layout, layout, layout_path

pytestmark = pytest.mark.slow

HAND = """\
matrix: [4, 6]
pitch_m: 0.002
row_pitch_m: 0.003
patches:
  tip:
    link: finger_2
    pose: {position_m: [0, 0.01, 0], rpy_rad: [0, 1.5, 0]}
    wires: {down: cols 5 to 4, across: 'rows 0, 2 to 3'}
    radius_m: 0.01
  palm:
    at: [0, 3]
    pitch_m: 0.005
    wires:
      - {down: rows 0 to 1, across: cols 0 to 2}
      - {down: rows 3 to 2, across: cols 2 to 0}
"""


def read(folder: Path, text: str, rows: int = 4, cols: int = 6) -> Layout:
    path = folder / "hand.yaml"
    path.write_text(text)
    return layout(str(path), rows, cols)


@pytest.mark.parametrize(("line", "told"), [("", None), ("stood_on: true\n", True), ("stood_on: false\n", False)])
def test_a_file_says_whether_somebody_stands_on_the_skin(tmp_path: Path, line: str, told: bool | None) -> None:
    assert read(tmp_path, HAND + "picture: [4, 6]\n" + line).stood_on is told
    with pytest.raises(SettingsError, match=r"hand.yaml.*stood_on = .*maybe.*allowed is true or false"):
        read(tmp_path, HAND + "picture: [4, 6]\nstood_on: maybe\n")


def test_a_hand_of_ones_own(tmp_path: Path) -> None:
    hand = read(tmp_path, HAND + "picture: [4, 6]\n")
    assert hand.name == str(tmp_path / "hand.yaml")
    tip, palm = hand.patches
    assert tip.of(hand.taxels).tolist() == [[5, 17, 23], [4, 16, 22]]
    assert palm.of(hand.taxels).tolist() == [[0, 1, 2], [6, 7, 8], [20, 19, 18], [14, 13, 12]]
    assert (tip.link, tip.radius_m, tip.pitch_m, tip.row_pitch_m) == ("finger_2", 0.01, 0.002, 0.003)
    assert (palm.link, palm.pitch_m, palm.row_pitch_m) == ("", 0.005, 0.005)
    # Where there is no skin, the rest of the matrix.
    assert (hand.patch_of[2:, :3] == NO_PATCH).all()
    assert sorted(hand.taxels[2:, :3].ravel().tolist()) == [3, 9, 10, 11, 15, 21]
    assert hand.patch_of_taxel[0].tolist() == [1, 1, 1, NO_PATCH, 0, 0]
    assert hand.patch(3, 5) is palm
    with pytest.raises(ArrayError, match=r"place \(3, 0\)"):
        hand.patch(3, 0)


def test_the_file_of_the_documents_is_one(tmp_path: Path) -> None:
    page = Path(__file__).resolve().parents[3] / "docs" / "layouts.md"
    gripper = read(tmp_path, page.read_text().partition("```yaml\n")[2].partition("```")[0], 16, 16)
    assert [patch.name for patch in gripper.patches] == ["left_tip", "right_tip", "palm"]
    assert gripper.taxels[0, 7:10].tolist() == [7, 15, 14]
    assert (gripper.patch_of == NO_PATCH).sum() == 64
    assert gripper.patches[0].normals()[0, 0] == pytest.approx([1, 0, 0], abs=1e-6)


def test_without_a_size_it_is_that_of_the_file(tmp_path: Path) -> None:
    read(tmp_path, HAND)
    hand = layout(str(tmp_path / "hand.yaml"))
    assert hand.picture(np.arange(24).reshape(4, 6)).shape == (hand.rows, hand.cols)
    (tmp_path / "hand.yaml").write_text(HAND.replace("matrix: [4, 6]\n", ""))
    with pytest.raises(SettingsError, match=r"1024 taxels of the matrix of 32 x 32.*yours is another, matrix: \[rows"):
        layout(str(tmp_path / "hand.yaml"))
    (tmp_path / "hand.yaml").write_text(HAND.replace("matrix: [4, 6]\n", "picture: [32, 32]\n"))
    assert layout(str(tmp_path / "hand.yaml")).taxels.size == 32 * 32


def test_it_is_for_one_matrix(tmp_path: Path) -> None:
    with pytest.raises(ArrayError, match=r"hand of a matrix of 6 x 4: it is made of 4 x 6"):
        read(tmp_path, HAND, 6, 4)


@pytest.mark.parametrize("name", LAYOUTS)
def test_shipped_files_have_nothing_that_a_copy_could_not(tmp_path: Path, name: str) -> None:
    copy = read(tmp_path, layout_path(name).read_text(), 32, 32)
    assert np.array_equal(copy.taxels, layout(name).taxels)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("radius_m", "radios_m", ["hand.yaml:9: patch tip:", "did you mean 'radius_m'?"]),
        ("radius_m: 0.01", "radius_m: 0.0001", ["hand.yaml:9: patch tip: radius_m", "half way around"]),
        ("matrix: [4, 6]", "matrix: [4, 65]", ["hand.yaml:1:", "1 to 64"]),
        ("pitch_m: 0.002", "pitch_m: .nan", ["hand.yaml:2: pitch_m = nan"]),
        ("cols 5 to 4", "cols 6 to 4", ["hand.yaml:8: patch tip: wires: down = 'cols 6 to 4'", "0 to 5"]),
        ("cols 5 to 4", "columns 5", ["hand.yaml:8:", "'columns 5'", "such as 'rows 0 to 7'"]),
        ("cols 5 to 4", "rows 1", ["hand.yaml:8:", "both rows"]),
        ("'rows 0, 2 to 3'", "rows 0, 2 to 3", ["hand.yaml:8:", "2 to 3 stands alone behind a comma", "in quotes"]),
        ("'rows 0, 2 to 3'", "rows 0, 2", ["hand.yaml:8:", "2 stands alone behind a comma", "in quotes"]),
        ("rows 0, 2 to 3", "rows 0, 2 to 0", ["hand.yaml:8:", "a wire is named twice"]),
        ("cols 5 to 4", "cols 5 to 4 by 0", ["hand.yaml:8:", "by 0"]),
        ("rows 3 to 2", "rows 2 to 1", ["hand.yaml:13: patch palm: wires:", "row 1, column 2", "patch palm already"]),
        ("rows 3 to 2", "rows 3 to 1", ["hand.yaml:11: patch palm: at:", "beyond the picture of 4 x 6"]),
        ("cols 2 to 0", "cols 1 to 0", ["hand.yaml:13: patch palm: wires: 3, 2 wires across"]),
        ("cols 2 to 0", "cols 4 to 2", ["hand.yaml:13: patch palm:", "column 4", "patch tip already"]),
        ("at: [0, 3]", "at: [0, 2]", ["hand.yaml:11: patch palm: at:", "over patch tip"]),
        ("at: [0, 3]", "at: [1, 3]", ["hand.yaml:11: patch palm: at:", "beyond the picture of 4 x 6"]),
        ("at: [0, 3]", "at: [0, -1]", ["hand.yaml:11: patch palm: at = [0, -1]"]),
        ("picture: [4, 6]", "picture: [5, 6]", ["hand.yaml:16: a picture of 5 x 6", "24 taxels"]),
        ("picture: [4, 6]", "", ["a picture of 4 x 6"]),
        ("  palm:", "  2palm:", ["hand.yaml:10:", "does not begin with a digit"]),
        ("  palm:", "  tip:", ["hand.yaml:10: the key 'tip' is given twice"]),
        ("link: finger_2", "link: [a]", ["hand.yaml:6: patch tip: link = ['a']"]),
        ("link: finger_2", "link: a b", ["hand.yaml:6: patch tip: link = 'a b'"]),
        ("rpy_rad: [0, 1.5, 0]", "rpy_rad: [0, 1.5]", ["hand.yaml:7: patch tip: pose: rpy_rad"]),
        ("[0, 0.01, 0]", "[0, 11, 0]", ["hand.yaml:7: patch tip: pose: position_m", "-10 to 10"]),
        ("    pose:", "    # pose:", ["hand.yaml:6: patch tip: pose is missing", "link finger_2"]),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_with_its_line(tmp_path: Path, old: str, new: str, words: list[str]) -> None:
    text = HAND + "picture: [4, 6]\n"
    assert old in text
    if words == ["a picture of 4 x 6"]:
        assert read(tmp_path, text.replace(old, new)).rows == 4
        return
    with pytest.raises(SettingsError) as caught:
        read(tmp_path, text.replace(old, new))
    assert all(word in str(caught.value) for word in words), caught.value


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("patches: {}", "0 of them; allowed are 1 to 16"),
        ("pitch_m: 1", "0 of them"),
        ("patches: {a: {}}", "wires is missing"),
        ("patches: {a: {wires: []}}", "at least one block"),
        ("patches: {a: {wires: 3}}", "wires = 3: needed is a mapping"),
        ("patches: {a: {wires: [3]}}", "wires has 3: needed is a mapping"),
        ("patches: {a: {wires: {down: rows}}}", "across = None"),
        ("patches: {a: {at: [60, 0], wires: {down: cols, across: rows}}}", "up to 64 rows and columns"),
        ("x: &a [*a, *a]", "not valid YAML"),
        pytest.param(5000 * "[", "not valid YAML", id="deep"),
    ],
)
def test_a_wrong_file_is_refused(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(SettingsError, match=r"hand\.yaml") as caught:
        read(tmp_path, text)
    assert words in str(caught.value) or "unknown key 'x'" in str(caught.value), caught.value


def test_aliases_in_aliases_without_end_take_no_time(tmp_path: Path) -> None:
    lists = ["&a0 [1]", *(f"&a{i} [{', '.join(20 * [f'*a{i - 1}'])}]" for i in range(1, 40))]
    value = f"[{', '.join(lists)}]"
    for key in ("matrix", "picture", "pitch_m", "patches"):
        # Not pytest.raises with match: where it fails, pytest shows the value, which has no end.
        assert "hand.yaml:2: " in refusal(
            tmp_path, f"patches: {{a: {{wires: {{down: rows, across: cols}}}}}}\n{key}: {value}"
        )
    for key in ("at", "link", "pose", "radius_m"):
        assert "hand.yaml:2: patch a: " in refusal(
            tmp_path, f"patches: {{a: {{wires: {{down: rows, across: cols}},\n {key}: {value}}}}}"
        )


def refusal(folder: Path, text: str) -> str:
    try:
        read(folder, text)
    except SettingsError as error:
        return str(error)
    return ""


def test_only_regular_files_are_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.yaml")
    for path, words in ((tmp_path / "pipe.yaml", "not a regular file"), (tmp_path, "not a regular file")):
        with pytest.raises(SettingsError, match=words):
            layout(str(path))
    with pytest.raises(SettingsError, match="/dev/zero: not a regular file"):
        layout("/dev/zero")
    with pytest.raises(SettingsError, match=r"none\.yaml: cannot be read"):
        layout(str(tmp_path / "none.yaml"))
    with pytest.raises(ActsError, match="nobody_of_that_name"):
        layout("~nobody_of_that_name/x.yaml")
    with pytest.raises(ActsError):
        layout("\0.yaml")


SCALARS = st.none() | st.booleans() | st.integers(-3, 70) | st.integers() | st.floats() | st.text(max_size=8)
WIRES = st.from_regex(r"(rows|cols)( [0-9]( to [0-9]( by [0-9])?)?(, [0-9])?)?", fullmatch=True)
KEYS = st.sampled_from(
    ["matrix", "picture", "pitch_m", "row_pitch_m", "patches", "at", "wires", "link", "pose", "radius_m",
     "row_radius_m", "down", "across", "position_m", "rpy_rad", "quaternion_xyzw"]
)  # fmt: skip
TREES = st.recursive(
    SCALARS | WIRES,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(KEYS | st.text(max_size=4), inner, max_size=5),
)
BLOCKS = st.fixed_dictionaries({"down": WIRES, "across": WIRES})
PATCHES = st.fixed_dictionaries(
    {"wires": BLOCKS | st.lists(BLOCKS, max_size=2)},
    optional={
        "at": st.lists(st.integers(0, 9), min_size=2, max_size=2),
        "radius_m": st.floats(),
        "link": st.text(max_size=3),
        "pose": st.dictionaries(KEYS, TREES, max_size=3),
        "pitch_m": SCALARS,
    },
)
FILES = st.fixed_dictionaries(
    {"patches": st.dictionaries(st.sampled_from(["a", "b", "c", "2"]), PATCHES | TREES, max_size=3)},
    optional={"picture": st.just([8, 8]) | TREES, "pitch_m": SCALARS},
)
BEND_M = st.floats(0.02, 1.0) | st.floats(-1.0, -0.02)


def places(tree: Any) -> Iterator[tuple[Any, Any]]:
    """Every value of a tree: what it is in, and its key there."""
    for key, value in list(tree.items() if isinstance(tree, dict) else enumerate(tree)):
        yield tree, key
        if isinstance(value, dict | list):
            yield from places(value)


@st.composite
def near_layouts(draw: st.DrawFn) -> dict[str, Any]:
    """Two patches side by side; in half of the files, one value is another."""
    cut = draw(st.integers(1, 7))
    coordinates = st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3)
    left = {"wires": {"down": "rows", "across": f"cols 0 to {cut - 1}"}, "radius_m": draw(BEND_M)}
    right = {
        "at": [0, cut],
        "wires": [
            {"down": "rows 7 to 4", "across": f"cols {cut} to 7"},
            {"down": "rows 0 to 3", "across": f"cols 7 to {cut}"},
        ],
        "pitch_m": draw(st.floats(0.001, 0.004)),
        "row_radius_m": draw(BEND_M),
        "link": "tip",
        "pose": {"position_m": draw(coordinates), "rpy_rad": draw(coordinates)},
    }
    tree = {"matrix": [8, 8], "picture": [8, 8], "pitch_m": 0.004, "patches": {"left": left, "right": right}}
    if draw(st.booleans()):
        within, key = draw(st.sampled_from(list(places(tree))))
        within[key] = draw(TREES)
    return tree


@given(st.dictionaries(KEYS, TREES, max_size=6) | FILES | near_layouts() | near_layouts())
def test_any_yaml_is_a_layout_or_is_refused_in_words(tmp_path_factory: pytest.TempPathFactory, tree: Any) -> None:
    path = tmp_path_factory.getbasetemp() / "any.yaml"
    path.write_text(yaml.safe_dump(tree))
    try:
        made = layout(str(path), 8, 8)
    except ActsError as error:
        refused = str(error)
    else:
        refused = ""
    if refused:
        assert "any" in refused
        return
    assert sorted(made.taxels.ravel().tolist()) == list(range(64))
    assert np.array_equal(made.picture(made.matrix(made.taxels)), made.taxels)
    for index, patch in enumerate(made.patches):
        assert (patch.of(made.patch_of) == index).all()
        assert np.isfinite(patch.points_m()).all()
        assert np.linalg.norm(patch.normals(), axis=-1) == pytest.approx(np.ones((patch.rows, patch.cols)))


@given(st.binary(max_size=60))
def test_any_bytes_are_refused_in_words(tmp_path_factory: pytest.TempPathFactory, content: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "bytes.yaml"
    path.write_bytes(content)
    with pytest.raises(ActsError, match=r"bytes\.yaml"):
        layout(str(path))
