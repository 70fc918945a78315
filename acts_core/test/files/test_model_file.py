# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Files of dictionaries and libraries: written as a whole or not at all."""

from __future__ import annotations

import errno
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from acts_core.errors import ActsError
from acts_core.files.model_file import ModelFile, settings_field

FILE = ModelFile("a thing", "thing-1", ("size",), "make one", ActsError)


def test_what_was_there_stays_where_the_disk_is_full(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "thing.npz"
    FILE.write(path, {"size": 1})

    def fill_the_disk(file: Any, **_fields: Any) -> None:
        file.write(b"begun")
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("numpy.savez_compressed", fill_the_disk)
    for name in ("thing.npz", "another.npz"):
        with pytest.raises(ActsError, match=rf"{name}: cannot be written \(No space left on device\)"):
            FILE.write(tmp_path / name, {"size": 2})
    assert [one.name for one in tmp_path.iterdir()] == ["thing.npz"]
    assert FILE.read(path)["size"] == 1


def test_a_link_stays_one_and_a_device_is_refused(tmp_path: Path) -> None:
    (tmp_path / "link.npz").symlink_to("thing.npz")
    for size in (1, 2):
        FILE.write(tmp_path / "link.npz", {"size": size})
    assert FILE.read(tmp_path / "thing.npz")["size"] == 2
    assert (tmp_path / "link.npz").is_symlink()
    with pytest.raises(ActsError, match="/dev/null: not a regular file"):
        FILE.write(Path("/dev/null"), {"size": 1})


def test_settings_come_back_as_they_were(tmp_path: Path) -> None:
    path = tmp_path / "thing.npz"
    settings = {"sparsity": 3, "objects": ["a", "b"], "tolerance": 0.5, "name": None}
    file = replace(FILE, fields=("size", "settings"))
    file.write(path, {"size": 1, "settings": settings_field(settings)})
    assert file.settings(path, file.read(path)) == settings


@pytest.mark.parametrize("text", ["", "{", "[1, 2]", "[[[1], 2]]", "[[1, 2]]", "3", "null", "[" * 20_000])
def test_settings_that_are_none_are_refused(text: str) -> None:
    """Some ended with a traceback, as what is nested too deeply; pairs in a list were taken for settings."""
    with pytest.raises(ActsError, match=r"thing.npz: a field has the wrong type \(settings: .{1,200}\); make one"):
        FILE.settings(Path("thing.npz"), {"settings": np.array(text)})
