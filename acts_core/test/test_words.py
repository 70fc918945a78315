# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Numbers before what is counted."""

from acts_core.words import counted


def test_one_is_singular_and_all_else_plural() -> None:
    assert [counted(number, "frame") for number in (0, 1, 2)] == ["0 frames", "1 frame", "2 frames"]
    assert [counted(number, "box", "boxes") for number in (1, 3)] == ["1 box", "3 boxes"]
