# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Single values of YAML files: what is allowed, and the messages with the place."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from acts_core.errors import SettingsError
from acts_core.files import Section, read_yaml

TEXT = "a: 2\nb: 0.5\nc: true\nd: left\n"


@pytest.fixture
def section(tmp_path: Path) -> Section:
    (tmp_path / "x.yaml").write_text(TEXT)
    return read_yaml(tmp_path / "x.yaml")


def test_values_are_read_and_absent_ones_have_defaults(section: Section) -> None:
    assert (section.whole("a"), section.whole("z", 7)) == (2, 7)
    assert (section.number("a"), section.number("b", highest=1), section.number("z", 0.0)) == (2.0, 0.5, 0.0)
    assert (section.flag("c"), section.flag("z")) == (True, None)
    assert section.one_of("d", ["left", "right"]) == "left"


@pytest.mark.parametrize(
    ("read", "message"),
    [
        (lambda one: one.whole("b"), "x.yaml:2: b = 0.5: needed is a whole number"),
        (lambda one: one.whole("c"), "x.yaml:3: c = True: needed is a whole number"),
        (lambda one: one.number("d"), "x.yaml:4: d = 'left': needed is a finite number"),
        (lambda one: one.number("z"), "z = None: needed is a finite number"),
        (lambda one: one.number("a", highest=1, unit=" [m]"), r"x.yaml:1: a = 2: allowed .* above 0 to 1 \[m\]"),
        (lambda one: one.flag("a"), "x.yaml:1: a = 2: allowed is true or false"),
        (lambda one: one.one_of("d", ["up", "down"]), "x.yaml:4: d = 'left': allowed is one of down, up"),
        (lambda one: one.one_of("z", ["up"]), "z is missing"),
    ],
)
def test_what_is_not_allowed_is_refused_with_its_line(
    section: Section, read: Callable[[Section], object], message: str
) -> None:
    with pytest.raises(SettingsError, match=message):
        read(section)


@pytest.mark.parametrize("text", ["a: 0x" + 5000 * "f", "a: " + 5000 * "9", "a: 2024-13-45"])
def test_numbers_that_no_message_could_show_and_dates_that_are_none_are_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / "x.yaml").write_text(text)
    with pytest.raises(SettingsError, match="not valid YAML"):
        read_yaml(tmp_path / "x.yaml")


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ("!!bool x", "'x' cannot be read as bool"),
        ('!!int ""', "'' cannot be read as int"),
        ("!!float _", "'_' cannot be read as float"),
        ("!!timestamp x", "'x' cannot be read as timestamp"),
        ("{b: [1, !!bool x]}", "'x' cannot be read as bool"),
    ],
)
def test_a_value_that_is_not_what_its_tag_says_is_refused_with_its_line(value: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "x.yaml").write_text(f"c: 1\na: {value}\n")
    with pytest.raises(SettingsError, match=f"not valid YAML: {words}") as caught:
        read_yaml(tmp_path / "x.yaml")
    assert "line 2" in str(caught.value)


@pytest.mark.parametrize("second", ["b: *first", "b: {<<: *first}"])
def test_what_an_alias_brings_goes_by_the_line_of_what_it_is_in(second: str, tmp_path: Path) -> None:
    (tmp_path / "x.yaml").write_text(f"all:\n  a: &first\n    inner: {{n: x}}\n  {second}\n")
    top = read_yaml(tmp_path / "x.yaml")
    for name, line in (("a", 3), ("b", 4)):
        inner = top.section("all", "").section(name, "").section("inner", "")
        with pytest.raises(SettingsError, match=f"x.yaml:{line}: n = 'x': needed is a whole number"):
            inner.whole("n")
