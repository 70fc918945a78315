# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Names of topics, namespaces and nodes as people write them."""

from __future__ import annotations

import pytest

from acts_core.errors import SettingsError
from acts_core.names import check_remaps, full_name, is_frame_name, is_short_name, own_words


@pytest.mark.parametrize("given", ["plate/contact", "/plate/contact", "/plate/contact/"])
def test_a_name_gets_one_slash_before_it(given: str) -> None:
    assert full_name(given) == "/plate/contact"


@pytest.mark.parametrize("name", ["palm", "_1", "a" * 64])
def test_names_of_skins_and_patches_are_also_those_of_frames(name: str) -> None:
    assert is_short_name(name)
    assert is_frame_name(name)
    assert is_frame_name(f"{name}/{name}")
    assert not is_short_name(f"{name}/{name}")


@pytest.mark.parametrize("name", ["", "9a", "a-b", "a//b", "/a", "a/", "a\n", "é", True, None, 5])
def test_what_is_no_name_of_a_skin_is_none_of_a_frame(name: object) -> None:
    assert not is_short_name(name)
    assert not is_frame_name(name)


def test_only_the_names_of_skins_and_patches_have_a_largest_length() -> None:
    assert not is_short_name("a" * 65)
    assert is_frame_name("a" * 65)


@pytest.mark.parametrize("given", ["", "/", "9a", "a-b", "a//b", "a b", "plate/9a", "Prüfung"])
def test_what_ros_has_no_name_for_is_refused(given: str) -> None:
    with pytest.raises(SettingsError, match=r"is no namespace: allowed are letters, digits \(not first\) and _, parts"):
        full_name(given, "namespace")


@pytest.mark.parametrize(
    ("what", "has_names_below", "longest"),
    [
        ("topic", False, 247),
        ("name of a service", False, 247),
        ("name of a node", True, 183),
        ("namespace", True, 183),
    ],
)
def test_a_name_is_as_long_as_ros_takes_it_with_what_a_node_puts_behind(
    what: str, has_names_below: bool, longest: int
) -> None:
    taken = full_name("a" * (longest - 1), what, has_names_below=has_names_below)
    assert taken == "/" + "a" * (longest - 1)
    said = rf"'/a{{63}}\.\.\.' is no {what}: it has {longest + 1} .* at most {longest}"
    with pytest.raises(SettingsError, match=said):
        full_name("a" * longest, what, has_names_below=has_names_below)


@pytest.mark.parametrize(
    ("word", "message"),
    [
        ("__ns:=/9a", "__ns:=/9a: '/9a' is no namespace: allowed are letters"),
        ("__ns:=plate", "'plate' is no namespace: .* each part with a / before it"),
        ("__ns:=/a//b", "'/a//b' is no namespace"),
        ("driver:__node:=9a", "'9a' is no name of a node: allowed are letters"),
        ("__name:=a/b", "'a/b' is no name of a node"),
    ],
)
def test_a_namespace_that_cannot_be_is_refused_in_words_of_ours(word: str, message: str) -> None:
    for option in ("-r", "--remap"):
        with pytest.raises(SettingsError, match=message):
            check_remaps(["program", "--ros-args", option, word])


def test_other_words_are_left_to_ros() -> None:
    check_remaps(["program", "-r", "__ns:=/9a"])
    check_remaps(
        ["program", "--ros-args", "-r", "__ns:=/", "-r", "__ns:=/a/b_1", "-r", "contact:=9a", "-p", "__ns:=9a"]
    )


def test_words_of_ros_are_left_out() -> None:
    assert own_words(["--a", "1", "--ros-args", "-r", "__node:=x", "--", "--b"]) == ["--a", "1"]
    assert own_words(["--a"]) == ["--a"]
