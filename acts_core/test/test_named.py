# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Things by their names."""

import pytest

from acts_core.errors import SettingsError
from acts_core.registry import named


def test_a_thing_is_found_by_its_name_or_those_that_exist_are_named() -> None:
    known = {"golf": 1, "tennis": 2}
    assert named("tennis", known, "ball") == 2
    with pytest.raises(SettingsError, match=r"^ball 'cannon' does not exist; known are golf, tennis$"):
        named("cannon", known, "ball")
