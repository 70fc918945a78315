# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""In which domain the nodes of a run meet. No node is made, so no ROS_DOMAIN_ID is used."""

import os

import pytest

from acts_core.errors import SettingsError
from acts_tools.ros_domain import use_free_domain


@pytest.mark.parametrize("given", [None, ""])
def test_without_a_domain_or_with_an_empty_one_a_free_one_is_taken(
    given: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "")  # what there was before comes back in any case
    if given is None:
        del os.environ["ROS_DOMAIN_ID"]
    use_free_domain()
    assert 215 <= int(os.environ["ROS_DOMAIN_ID"]) <= 231


def test_one_that_is_given_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    use_free_domain()
    assert os.environ["ROS_DOMAIN_ID"] == "7"


def test_one_that_cannot_be_is_refused_before_any_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "lab")
    with pytest.raises(SettingsError, match="ROS_DOMAIN_ID=lab: allowed is 0 to 232"):
        use_free_domain()
