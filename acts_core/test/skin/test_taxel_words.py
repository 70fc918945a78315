# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Taxels in words: what a text names, and the text of taxels."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from acts_core.errors import SettingsError
from acts_core.skin import taxels_in_words, taxels_named


def test_rows_columns_and_single_taxels_are_named() -> None:
    named = taxels_named(" row=1  col=0 3,2\n", 4, 3)
    expected = np.zeros((4, 3), dtype=bool)
    expected[1, :] = expected[:, 0] = expected[3, 2] = True
    np.testing.assert_array_equal(named, expected)
    assert not taxels_named("", 4, 3).any()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("row=4", "outside of an array of 4 x 3: it has rows 0 to 3 and columns 0 to 2"),
        ("col=3", "outside of an array of 4 x 3"),
        ("0,3", "outside of an array of 4 x 3"),
        ("4,0", "outside of an array of 4 x 3"),
        ("99999999999999999999,0", "names no taxels"),
        ("row=-1", "'row=-1' names no taxels: allowed are row=R for a whole row, col=C for a whole column, R,C for"),
        ("row=1,2", "names no taxels"),
        ("1, 2", "'1,' names no taxels"),
        ("row", "names no taxels"),
        ("column=1", "names no taxels"),
        ("1;2", "names no taxels"),
        ("\u0661,0", "names no taxels"),
    ],
)
def test_what_names_none_is_refused_with_what_is_allowed(words: str, told: str) -> None:
    with pytest.raises(SettingsError) as refused:
        taxels_named(f"0,0 {words}", 4, 3)
    assert told in str(refused.value)


WORDS = st.from_regex(r"row=[0-5]|col=[0-7]|[0-5],[0-7]", fullmatch=True)


@given(st.text(alphabet="rowcl=0123456789, \n-", max_size=30) | st.lists(WORDS, max_size=4).map(" ".join))
def test_any_text_names_taxels_or_is_refused(words: str) -> None:
    try:
        named = taxels_named(words, 5, 7)
    except SettingsError:
        return
    assert named.any() == bool(words.strip())


@given(arrays(np.bool_, array_shapes(min_dims=2, max_dims=2, max_side=6)))
def test_the_words_of_taxels_name_them(taxels: np.ndarray) -> None:
    words = taxels_in_words(taxels)
    np.testing.assert_array_equal(taxels_named(words, *taxels.shape), taxels)


def test_lines_are_named_as_lines() -> None:
    assert taxels_in_words(taxels_named("3,2 col=0 row=1", 4, 5)) == "row=1 col=0 3,2"
    assert taxels_in_words(np.zeros((4, 5), dtype=bool)) == ""
    assert taxels_in_words(np.ones((2, 5), dtype=bool)) == "row=0 row=1"
