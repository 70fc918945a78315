# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Files of dictionaries and libraries: written as a whole or not at all."""

from __future__ import annotations

import errno
from pathlib import Path
from typing import Any

import pytest

from acts_core.errors import ActsError
from acts_core.files.model_file import ModelFile

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
