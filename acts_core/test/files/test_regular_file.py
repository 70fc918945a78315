# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Regular files only, and no larger than allowed."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from acts_core.errors import SettingsError
from acts_core.files import is_there, path_of, read_text
from acts_core.skin.force_file import read_force_points


@pytest.mark.parametrize("name", ["/dev/zero", "/dev", "pipe"])
def test_only_regular_files_are_opened(name: str, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(SettingsError, match=f"{name}: not a regular file; give another"):
        read_text(tmp_path / name, error=SettingsError, hint="give another")


def test_what_is_too_large_or_no_text_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "some.txt"
    path.write_bytes("zwölf".encode())
    assert read_text(path, error=SettingsError) == "zwölf"
    with pytest.raises(SettingsError, match=r"some.txt: 0\.0 MB; allowed are 0\.0 MB"):
        read_text(path, error=SettingsError, limit_bytes=5)
    path.write_bytes(b"\xff")
    with pytest.raises(SettingsError, match="not text in UTF-8"):
        read_text(path, error=SettingsError)
    with pytest.raises(SettingsError, match="nowhere: cannot be read"):
        read_text(tmp_path / "nowhere", error=SettingsError)


def test_a_force_response_is_a_regular_file(tmp_path: Path) -> None:
    (tmp_path / "endless.csv").symlink_to("/dev/zero")
    with pytest.raises(SettingsError, match=r"endless.csv: not a regular file"):
        read_force_points(tmp_path / "endless.csv")


def test_what_is_there_and_what_cannot_be_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    (tmp_path / "circle").symlink_to("circle")
    assert is_there(tmp_path / "file", error=SettingsError)
    for name in ("nothing", "file/below"):
        assert not is_there(tmp_path / name, error=SettingsError)
    for name, reason in (("a" * 300, "too long"), ("circle", "symbolic links"), ("a\0b", "null (byte|character)")):
        with pytest.raises(SettingsError, match=f"cannot be read .*{reason}"):
            is_there(tmp_path / name, error=SettingsError)


def test_a_path_may_begin_at_home_but_at_nobodys(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    assert path_of("~/a", error=SettingsError) == tmp_path / "a"
    with pytest.raises(SettingsError, match="~nobody-of-this-name/a: "):
        path_of("~nobody-of-this-name/a", error=SettingsError)
