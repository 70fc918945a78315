# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Substitutions in launch files: the grammar of the real launch, its words for what is wrong, and its evaluation."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.errors import LaunchError
from acts_tools.launch.substitutions import Scope, Text, describe, parse, perform, plain

pytestmark = pytest.mark.slow

SCOPE = Scope({"x": "1", "name": "x", "spaced": "a b"}, {"HOME": "/home/me"}, Path("/files/demo.launch.xml"))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("", ""),
        ("plain text", "plain text"),
        ("$(var x)", "1"),
        ("a/$(var x)/b", "a/1/b"),
        ("$(var spaced)", "a b"),
        ("$(var $(var name))", "1"),
        ("$(var is_$(var name) no)", "no"),
        ("$(var nothing fallback)", "fallback"),
        ("$(var nothing '')", ""),
        ("$(var nothing 'two words')", "two words"),
        ('$(var nothing "it\'s $(var x)")', "it's 1"),
        ("$(var x $(var nothing))", "1"),  # a default that is not needed is not looked at
        ("$(env HOME)", "/home/me"),
        ("$(env NOTHING none)", "none"),
        ("$(dirname)/params.yaml", "/files/params.yaml"),
        ("costs $5", "costs $5"),
        ("(round)", "(round)"),
        (r"\$(var x)", "$(var x)"),
        (r"\\$(var x)", r"\$(var x)"),
        (r"a\\b", r"a\b"),
    ],
)
def test_values_are_those_of_the_real_launch(text: str, value: str) -> None:
    assert perform(parse(text), SCOPE) == value


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("$(bogus 1)", "Unknown substitution: bogus"),
        ("$(command ls)", "Unknown substitution: command"),
        ("$(eval '1 + 2')", "Unknown substitution: eval"),
        ("$(var x", "not closed"),
        ("$()", "expected the name"),
        ("$(var  x)", "separated by one space"),
        ("$(var x )", "separated by one space"),
        ("$(var 'x)", "quote is not closed"),
        ("$(var)", "var substitution expects 1 or 2 arguments"),
        ("$(var a b c)", "var substitution expects 1 or 2 arguments"),
        ("$(env)", "env substitution expects 1 or 2 arguments"),
        ("$(dirname x)", "dirname substitution doesn't expect arguments"),
        ("$(find-pkg-share)", "find package substitutions expect 1 argument"),
    ],
)
def test_what_is_not_well_formed_is_refused_with_a_caret_under_the_place(text: str, message: str) -> None:
    with pytest.raises(LaunchError, match=message.replace("(", r"\(")) as caught:
        parse(text)
    lines = str(caught.value).splitlines()
    assert lines[1] == f"  {text}"
    assert lines[2].strip() == "^"
    assert len(lines[2]) <= len(lines[1]) + 1


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("$(var nothing)", "launch configuration 'nothing' does not exist"),
        ("$(env NOTHING)", "environment variable 'NOTHING' does not exist"),
        ("$(find-pkg-share no_such_package)", "package 'no_such_package' not found"),
        ("$(find-pkg-share a/b)", "'a/b' is not a valid package name"),
    ],
)
def test_what_has_no_value_is_an_error_in_the_real_words(text: str, message: str) -> None:
    with pytest.raises(LaunchError, match=message):
        perform(parse(text), SCOPE)


def test_defaults_are_described_as_the_real_launch_does() -> None:
    assert describe(parse("$(find-pkg-share acts_config)/params/$(var x).yaml")) == (
        "FindPackageShare(pkg='acts_config') + '/params/' + LaunchConfig('x') + '.yaml'"
    )
    assert describe(parse("$(env A)$(dirname)")) == "EnvVar('A') + ThisLaunchFileDir()"


@given(st.text() | st.text(alphabet="$()\\'\" var-x", max_size=20) | st.text(alphabet="() $x").map("$(var {}".format))
def test_any_text_parses_or_is_refused_and_text_without_dollar_or_backslash_stays_as_it_is(text: str) -> None:
    try:
        template = parse(text)
    except LaunchError:
        assert "$(" in text
        return
    if "$(" not in text and "\\" not in text:
        assert plain(template) == text


names = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,8}", fullmatch=True)
safe_text = st.text(st.characters(blacklist_characters="\\$", blacklist_categories=["Cs"]), max_size=10)


@given(st.lists(st.tuples(safe_text, names), max_size=5), safe_text)
def test_pieces_are_joined_in_order(pieces: list[tuple[str, str]], last: str) -> None:
    text = "".join(f"{before}$(var {name})" for before, name in pieces) + last
    variables = {name: f"<{name}>" for _, name in pieces}
    expected = "".join(f"{before}<{name}>" for before, name in pieces) + last
    assert perform(parse(text), Scope(variables, {}, Path("f"))) == expected


@given(st.text(max_size=20))
def test_quoted_arguments_pass_any_text_through(value: str) -> None:
    escaped = "".join(f"\\{character}" if character in "\\'$" else character for character in value)
    assert perform(parse(f"$(var nothing '{escaped}')"), SCOPE) == value


@given(st.text(max_size=20))
def test_escaped_text_is_itself(value: str) -> None:
    escaped = value.replace("\\", "\\\\").replace("$", "\\$")
    assert parse(escaped) == (Text(value),)
