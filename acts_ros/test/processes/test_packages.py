# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Launch files are found in the ament index by their names."""

from __future__ import annotations

from pathlib import Path

import pytest

from acts_core.errors import LaunchError
from acts_ros.processes import packages


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    """A prefix with a package `fake` of two launch files, one of them there twice."""
    for name in ("launch/one.launch.xml", "launch/two.launch.xml", "more/two.launch.xml"):
        path = tmp_path / "share/fake" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    index = tmp_path / "share/ament_index/resource_index/packages/fake"
    index.parent.mkdir(parents=True)
    index.touch()
    return {"AMENT_PREFIX_PATH": str(tmp_path)}


@pytest.mark.parametrize("name", ["one.launch.xml", "launch/one.launch.xml"])
def test_a_launch_file_is_found_by_its_name_and_by_the_end_of_its_path(
    environment: dict[str, str], tmp_path: Path, name: str
) -> None:
    found = packages.launch_file("fake", name, environment)
    assert found == tmp_path / "share/fake/launch/one.launch.xml"


@pytest.mark.parametrize("name", ["/one.launch.xml", "one*", "*.launch.xml", "**", "", "ne.launch.xml", "launch"])
def test_what_is_no_name_of_one_is_not_found(environment: dict[str, str], name: str) -> None:
    with pytest.raises(LaunchError, match=r"was not found .*\(launch files there: one\.launch\.xml, two\.launch"):
        packages.launch_file("fake", name, environment)


def test_a_name_that_is_there_twice_is_refused(environment: dict[str, str]) -> None:
    with pytest.raises(LaunchError, match=r"'two\.launch\.xml' was found more than once"):
        packages.launch_file("fake", "two.launch.xml", environment)
