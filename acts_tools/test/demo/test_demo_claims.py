# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What keeps a demonstration from running is told before anything is started.

That is a second one in the same folder or with the same robot, and a missing library.
"""

import importlib.util
import os
from pathlib import Path

import pytest

from acts_core.errors import LaunchError, SettingsError
from acts_tools.demo.ball.run import run
from acts_tools.demo.claims import claimed_folder, claimed_robot

ADDRESS = "127.0.6.12"


def test_a_folder_has_one_demonstration_at_a_time(tmp_path: Path) -> None:
    with claimed_folder(tmp_path):
        with pytest.raises(LaunchError, match=f"writes to the folder {tmp_path}"):
            run(10.0, tmp_path, ADDRESS)
        with claimed_folder(tmp_path.parent):
            pass
    with claimed_folder(tmp_path):
        pass


def test_a_robot_has_one_demonstration_at_a_time_also_before_it_is_there(tmp_path: Path) -> None:
    with claimed_robot(ADDRESS):
        named = f"another demonstration is running with its robot at {ADDRESS}: process {os.getpid()} "
        with pytest.raises(LaunchError, match=named):
            run(10.0, tmp_path, ADDRESS)
        with claimed_robot("127.0.6.13"):
            pass
    with claimed_robot(ADDRESS):
        pass


def test_without_the_library_of_the_arm_nothing_is_started(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("acts_tools.demo.ball.run.find_spec", lambda name: importlib.util.find_spec(f"no_{name}"))
    with pytest.raises(SettingsError, match=r"needs the library ur_rtde, which is not installed.*PYTHON=/path/to"):
        run(10.0, tmp_path, ADDRESS)
    assert list(tmp_path.iterdir()) == []


def test_what_goes_wrong_inside_is_not_taken_for_a_claim(tmp_path: Path) -> None:
    with pytest.raises(BlockingIOError), claimed_folder(tmp_path), claimed_robot(ADDRESS):
        raise BlockingIOError
