# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Messages to the page, read back by what the format says; what of a layout the page is told."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray
from view_messages import decode

from acts_core.errors import ArrayError
from acts_core.skin import LAYOUTS, layout
from acts_view.skin.arrangement import arrangement
from acts_view.skin.snapshot import Frame, SkinShape, describe_skin, encode_frame
from acts_view.web.codec import DTYPES, encode

ANY_JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=8,
)
ANY_ARRAY = st.sampled_from(DTYPES).flatmap(
    lambda kind: arrays.arrays(kind, arrays.array_shapes(min_dims=1, max_dims=2, min_side=0, max_side=7))
)


@given(
    st.dictionaries(st.text().filter(lambda key: key != "arrays"), ANY_JSON, max_size=4),
    st.dictionaries(st.text(max_size=5), ANY_ARRAY, max_size=4),
)
def test_what_is_encoded_is_read_as_it_was(header: dict[str, Any], given_arrays: dict[str, NDArray[Any]]) -> None:
    read_header, read_arrays = decode(encode(header, given_arrays))
    assert read_header == header
    assert list(read_arrays) == list(given_arrays)
    for name, array in given_arrays.items():
        np.testing.assert_array_equal(read_arrays[name], array)


def test_what_a_browser_cannot_read_is_refused() -> None:
    with pytest.raises(ArrayError, match="float64"):
        encode({}, {"far": np.zeros(2)})
    with pytest.raises(ArrayError, match="nan"):
        encode({"force_n": math.nan})


def test_times_of_a_frame_keep_their_milliseconds() -> None:
    begin_s = 1_800_000_000.0
    history = np.zeros((3, 7))
    history[:, 0] = begin_s + np.array([0.0, 0.008, 59.992])
    header, read = decode(encode_frame("/plate", Frame(stamp_s=begin_s), history, life=2))
    np.testing.assert_allclose(
        header["base_s"] + read["history"][:, 0].astype(float), history[:, 0], rtol=0.0, atol=1e-5
    )
    assert (header["skin"], header["life"], header["touch"]) == ("/plate", 2, None)
    assert "image" not in read


@pytest.mark.parametrize("jump_s", [4 * 3600.0, 400 * 86400.0])
def test_a_clock_that_was_set_forward_leaves_the_times_after_it_their_milliseconds(jump_s: float) -> None:
    times_s = 1_700_000_000.0 + 0.008 * np.arange(7500)
    times_s[3000:] += jump_s
    history = np.zeros((len(times_s), 7))
    history[:, 0] = times_s
    header, read = decode(encode_frame("/plate", Frame(), history, life=0))
    told_s = header["base_s"] + read["history"][:, 0].astype(float)
    np.testing.assert_allclose(told_s[3000:], times_s[3000:], rtol=0.0, atol=1e-5)
    # What is before it is out of every plot, and stays in its order.
    assert (np.diff(told_s) >= 0).all()
    np.testing.assert_allclose(told_s[:3000], times_s[:3000], rtol=0.0, atol=1e-6 * jump_s)


@pytest.mark.parametrize("name", LAYOUTS)
def test_patches_are_drawn_in_their_size_and_beside_one_another(name: str) -> None:
    shown = layout(name)
    boxes = arrangement(shown)
    for patch, box in zip(shown.patches, boxes, strict=True):
        pitch_m, row_pitch_m = (patch.pitch_m, patch.row_pitch_m) if patch.link else (shown.pitch_m, shown.row_pitch_m)
        assert (box.width_m, box.height_m) == pytest.approx((patch.cols * pitch_m, patch.rows * row_pitch_m))
        assert min(box.x_m, box.y_m) >= 0
    for index, one in enumerate(boxes):
        for other in boxes[:index]:
            across_m = min(one.x_m + one.width_m, other.x_m + other.width_m) - max(one.x_m, other.x_m)
            down_m = min(one.y_m + one.height_m, other.y_m + other.height_m) - max(one.y_m, other.y_m)
            assert min(across_m, down_m) < 1e-9


def test_a_hand_is_drawn_as_a_right_hand_seen_from_its_palm() -> None:
    hand = layout("leap_right")
    boxes = {patch.name: box for patch, box in zip(hand.patches, arrangement(hand), strict=True)}
    assert len(boxes) == 13
    assert boxes["ring_distal"].x_m < boxes["middle_distal"].x_m < boxes["index_distal"].x_m < boxes["thumb_distal"].x_m
    for finger in ("index", "middle", "ring", "thumb"):
        heights = [boxes[f"{finger}_{segment}"].y_m for segment in ("distal", "medial", "proximal")]
        assert heights == sorted(heights)
    assert boxes["middle_proximal"].y_m < boxes["palm"].y_m


@pytest.mark.parametrize("thumb_rows", [0, 2, 8])
def test_a_palm_without_fingers_is_drawn_whole(tmp_path: Path, thumb_rows: int) -> None:
    """It began above the upper edge of the picture, which had no place for as much of it."""
    file = tmp_path / "palm.yaml"
    pose = "link: palm, pose: {position_m: [0, 0, 0]}"
    patches = [f"palm: {{wires: {{down: rows 0 to 7, across: cols}}, {pose}}}"]
    if thumb_rows:
        wires = f"wires: {{down: rows 8 to {7 + thumb_rows}, across: cols}}"
        patches.append(f"thumb_distal: {{at: [8, 0], {wires}, {pose}}}")
    file.write_text("\n  ".join([f"matrix: [{8 + thumb_rows}, 8]\npatches:", *patches]) + "\n")
    boxes = arrangement(layout(str(file)))
    assert min(box.x_m for box in boxes) == 0.0
    assert min(box.y_m for box in boxes) == pytest.approx(0.0)


@pytest.mark.parametrize("name", ["secret.txt", "secret.yaml"])
def test_of_a_file_that_is_no_layout_nothing_is_told(tmp_path: Path, name: str) -> None:
    file = tmp_path / name
    file.write_text("password: swordfish\n")
    told = describe_skin("/sole", SkinShape(str(file), 16, 24))
    assert len(told["patches"]) == 1
    assert name in told["note"]
    assert not any(word in json.dumps(told) for word in ("password", "swordfish"))


def test_a_layout_file_of_another_machine_is_shown_as_the_plain_picture() -> None:
    told = describe_skin("/sole", SkinShape("/elsewhere/sole.yaml", 16, 24))
    assert (told["rows"], told["cols"], len(told["patches"])) == (16, 24, 1)
    assert "/elsewhere/sole.yaml" in told["note"]
    json.dumps(told, allow_nan=False)
