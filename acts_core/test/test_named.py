# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Things by their names."""

from collections.abc import Callable

import pytest

from acts_core.errors import SettingsError
from acts_core.registry import named, registering


def test_a_thing_is_found_by_its_name_or_those_that_exist_are_named() -> None:
    known = {"golf": 1, "tennis": 2}
    assert named("tennis", known, "ball") == 2
    with pytest.raises(SettingsError, match=r"^ball 'cannon' does not exist; known are golf, tennis$"):
        named("cannon", known, "ball")


def test_a_decorated_function_is_entered_once() -> None:
    known: dict[str, int] = {}

    def ball(mass_g: Callable[[], int]) -> int:
        return mass_g()

    @registering("golf", known, "ball", ball)
    def golf() -> int:
        return 46

    assert golf() == 46
    assert known == {"golf": 46}
    with pytest.raises(SettingsError, match=r"^ball 'golf' is registered twice; choose another name$"):
        registering("golf", known, "ball", ball)(golf)
