# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.errors import SettingsError
from acts_core.settings import describe, from_mapping, from_text, is_given, rounded_up, setting, validate


@dataclass(frozen=True)
class Example:
    rate_hz: float = setting(250.0, "how often", minimum=1.0, maximum=1000.0)
    depth: int = setting(4, "how many", minimum=0)
    enabled: bool = setting(True, "whether")
    protocol: str = setting("binary", "which", choices=("binary", "raster_ascii"))
    home_rad: tuple[float, ...] = setting((0.0, 1.0), "where", minimum=-6.3, maximum=6.3, length=2)

    def __post_init__(self) -> None:
        validate(self)


def test_missing_keys_keep_their_defaults() -> None:
    assert from_mapping(Example, {"depth": 7}) == Example(depth=7)


def test_whole_numbers_serve_as_numbers_and_lists_as_tuples() -> None:
    settings = from_mapping(Example, {"rate_hz": 100, "home_rad": [1, 2]})
    assert settings.rate_hz == 100.0
    assert isinstance(settings.rate_hz, float)
    assert settings.home_rad == (1.0, 2.0)


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("rate_hz", 0.5, "1 to 1000"),
        ("rate_hz", float("nan"), "finite"),
        ("rate_hz", "fast", "number"),
        ("rate_hz", True, "number"),
        ("depth", -1, "0 or more"),
        ("depth", 1.5, "whole number"),
        ("depth", float("inf"), "whole number"),
        ("depth", -(10**400), "0 or more"),
        ("rate_hz", 10**400, "number"),
        ("home_rad", [1.0, 10**400], "list of numbers"),
        ("enabled", 1, "true/false"),
        ("protocol", "morse", "binary, raster_ascii"),
        ("protocol", False, "text (in YAML, on, off, yes, no, true, false and numbers are text in quotes only"),
        ("protocol", 5, "text in quotes only, as in 'on')"),
        ("protocol", None, "a value of type text, one of"),
        ("home_rad", [1.0], "2 values"),
        ("home_rad", [1.0, 9.0], "-6.3 to 6.3"),
        ("home_rad", "12", "list of numbers"),
        ("home_rad", [1.0, "x"], "list of numbers"),
    ],
)
def test_a_wrong_value_is_refused_with_what_is_allowed(key: str, value: Any, words: str) -> None:
    with pytest.raises(SettingsError) as error:
        from_mapping(Example, {key: value})
    assert key in str(error.value)
    assert repr(value) in str(error.value)
    assert words in str(error.value)


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        ("rate_hz", "1e2", 100.0),
        ("rate_hz", "7", 7.0),
        ("depth", "9007199254740993", 9007199254740993),
        ("enabled", "false", False),
        ("protocol", "binary", "binary"),
        ("home_rad", "[1, -2.5]", (1.0, -2.5)),
        ("home_rad", "1, -2.5", (1.0, -2.5)),
        ("home_rad", "1 -2.5e-1", (1.0, -0.25)),
    ],
)
def test_settings_are_read_as_people_write_them(name: str, text: str, value: Any) -> None:
    assert from_text(Example, name, text) == value


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("rate_hz", "fast"),
        ("rate_hz", "[1"),
        ("rate_hz", "inf"),
        ("depth", "1e-3"),
        ("enabled", "1"),
        ("home_rad", "1"),
        ("depth", "2024-13-45"),
        ("depth", 5000 * "9"),
        ("rate_hz", "0x" + 5000 * "f"),
        ("rate_hz", 5000 * "["),
        ("enabled", "!!bool x"),
        ("depth", '!!int ""'),
        ("rate_hz", "!!timestamp x"),
    ],
)
def test_a_wrong_text_is_refused_by_the_name_of_its_setting(name: str, text: str) -> None:
    with pytest.raises(SettingsError, match=f"^{name} = "):
        from_text(Example, name, text)


def test_an_unknown_key_names_its_neighbour() -> None:
    with pytest.raises(SettingsError, match=r"rate_h'.*did you mean 'rate_hz'"):
        from_mapping(Example, {"rate_h": 1.0})


def test_direct_construction_is_checked_too() -> None:
    with pytest.raises(SettingsError, match="depth"):
        Example(depth=-3)


def test_every_setting_is_described() -> None:
    assert list(describe(Example)) == ["rate_hz", "depth", "enabled", "protocol", "home_rad"]
    assert all(info.description for info in describe(Example).values())


KEYS = ("rate_hz", "depth", "enabled", "protocol", "home_rad")


@given(st.dictionaries(st.text(max_size=8), st.one_of(st.integers(), st.floats(), st.text(), st.booleans(), st.none())))
def test_any_mapping_gives_settings_or_a_settings_error(values: dict[str, Any]) -> None:
    # Keys of the settings themselves have to occur.
    values = {KEYS[len(key) % len(KEYS)] if len(key) < 5 else key: value for key, value in values.items()}
    with suppress(SettingsError):
        validate(from_mapping(Example, values))


@given(st.floats(1e-6, 1e6))
def test_a_limit_for_a_person_is_rounded_to_what_is_allowed(limit: float) -> None:
    told = float(rounded_up(limit))
    assert limit <= told <= 1.001 * limit


@pytest.mark.parametrize(
    ("limit", "told"), [(0.2, "0.2"), (2.0 / 60.0, "0.03334"), (13.0 + 1e-9, "13.01"), (0.01, "0.01")]
)
def test_a_limit_for_a_person_has_four_digits_at_most(limit: float, told: str) -> None:
    assert rounded_up(limit) == told


@pytest.mark.parametrize(("text", "expected"), [("", False), ("none", False), ("None", True), ("plate.npz", True)])
def test_an_empty_text_and_none_name_nothing(text: str, expected: bool) -> None:
    assert is_given(text) is expected
