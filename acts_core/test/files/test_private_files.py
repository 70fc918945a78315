# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A folder for one user alone; that a file in it is one process's alone is tested with acts_sim's run folder."""

import os
from pathlib import Path

import pytest

from acts_core.errors import ActsError
from acts_core.files import make_private

HINT = "give another folder: run_dir:=NAME"


def mode(folder: Path) -> int:
    return folder.stat().st_mode & 0o7777


def test_a_missing_folder_is_made_for_its_user_alone_with_those_above_it(tmp_path: Path) -> None:
    folder = tmp_path / "run" / "left"
    make_private(folder, HINT)
    make_private(folder, HINT)
    assert (mode(folder), mode(folder.parent)) == (0o700, 0o700)


def test_the_mode_of_a_folder_that_exists_is_left_alone(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    folder.mkdir(mode=0o755)
    make_private(folder, HINT)
    assert mode(folder) == 0o755


def test_a_link_in_place_of_the_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    link = tmp_path / "run"
    link.symlink_to(tmp_path / "elsewhere")
    with pytest.raises(ActsError, match=f"{link} is a symbolic link.*run_dir:="):
        make_private(link, HINT)


def test_no_folder_is_made_that_is_named_as_the_home_is_by_a_shell(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As of `run_dir:=~/run`; `rm -r ~` would remove more than that."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ActsError, match=r"the folder ~/run begins with ~.* write \$HOME, or give another folder"):
        make_private(Path("~/run"), HINT)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_anybody_may_write_to_is_refused_but_not_one_like_tmp(tmp_path: Path) -> None:
    tmp_path.chmod(0o777)
    with pytest.raises(ActsError, match="anybody may write to the folder"):
        make_private(tmp_path, HINT)
    tmp_path.chmod(0o1777)
    make_private(tmp_path, HINT)


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give a folder to somebody else")
def test_somebody_elses_folder_is_refused_by_name(tmp_path: Path) -> None:
    os.chown(tmp_path, 1, 1)
    with pytest.raises(ActsError, match=r"belongs to (daemon|bin|user 1);.*run_dir:="):
        make_private(tmp_path, HINT)


def test_a_file_in_place_of_the_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "run").write_text("mine")
    with pytest.raises(ActsError, match="is no folder"):
        make_private(tmp_path / "run", HINT)
