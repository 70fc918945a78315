# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Files that are written as a whole or not at all."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from acts_core.errors import ActsError
from acts_core.files import write_array, write_whole


def test_what_is_interrupted_leaves_what_was_there_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "made" / "text"
    with write_whole(path, error=ActsError, makes_folder=True) as file:
        file.write(b"first")

    def interrupted() -> None:
        with write_whole(path, error=ActsError) as file:
            file.write(b"half of the sec")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert [one.name for one in path.parent.iterdir()] == ["text"]
    assert path.read_bytes() == b"first"


@pytest.mark.parametrize("mode", [0o600, 0o664, 0o444])
def test_a_file_that_was_there_keeps_its_permissions(mode: int, tmp_path: Path) -> None:
    path, link = tmp_path / "text", tmp_path / "link"
    path.write_bytes(b"first")
    path.chmod(mode)
    link.symlink_to(path)
    with write_whole(link, error=ActsError) as file:
        file.write(b"second")
    assert path.read_bytes() == b"second"
    assert path.stat().st_mode & 0o777 == mode


def test_what_a_killed_process_has_left_is_removed_a_day_later(tmp_path: Path) -> None:
    left, fresh = tmp_path / ".text.12.34.new", tmp_path / ".text.56.78.new"
    others = [tmp_path / name for name in (".text2.12.34.new", ".text.12.new", "text.12.34.new", ".other.1.2.new")]
    for path in (left, fresh, *others):
        path.touch()
        if path != fresh:
            os.utime(path, (time.time() - 90_000, time.time() - 90_000))
    with write_whole(tmp_path / "text", error=ActsError) as file:
        file.write(b"whole")
    assert sorted(tmp_path.iterdir()) == sorted([tmp_path / "text", fresh, *others])


def test_two_threads_that_write_a_file_at_once_leave_a_whole_one(tmp_path: Path) -> None:
    path = tmp_path / "text"
    has_begun, may_end = threading.Event(), threading.Event()
    failures: list[ActsError] = []

    def write_slowly() -> None:
        try:
            with write_whole(path, error=ActsError) as file:
                file.write(b"slow and ")
                file.flush()
                has_begun.set()
                may_end.wait(20.0)
                file.write(b"late")
        except ActsError as error:
            failures.append(error)

    slow = threading.Thread(target=write_slowly)
    slow.start()
    assert has_begun.wait(20.0)
    with write_whole(path, error=ActsError) as file:
        file.write(b"quick")
    assert path.read_bytes() == b"quick"
    may_end.set()
    slow.join(20.0)
    assert not failures
    assert path.read_bytes() == b"slow and late"
    assert [one.name for one in tmp_path.iterdir()] == ["text"]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("none/text", r"none/text: cannot be written \(No such file or directory\); name another$"),
        ("x" * 300, r"cannot be written \(File name too long\)"),
        ("", "not a regular file, so nothing is written to it"),
    ],
)
def test_what_cannot_be_written_is_refused(name: str, message: str, tmp_path: Path) -> None:
    with (
        pytest.raises(ActsError, match=message),
        write_whole(tmp_path / name, error=ActsError, hint="name another"),
    ):
        pass
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "array",
    [
        np.arange(24, dtype=np.uint16).reshape(2, 3, 4),
        np.asfortranarray(np.arange(6.0).reshape(2, 3)),
        np.arange(24, dtype=np.int32).reshape(4, 6)[::2, 1::2],
        np.zeros((0, 4, 4), dtype=np.uint16),
    ],
)
def test_an_array_is_read_as_it_was_written(array: np.ndarray, tmp_path: Path) -> None:
    path = tmp_path / "array.npy"
    with write_whole(path, error=ActsError) as file:
        write_array(file, array)
    read = np.load(path)
    assert (read.dtype, read.shape) == (array.dtype, array.shape)
    assert np.array_equal(read, array)


def test_of_an_array_that_fills_the_disk_the_reason_is_told(tmp_path: Path) -> None:
    code = (
        "import resource\nfrom pathlib import Path\nimport numpy as np\nfrom acts_core.errors import ActsError\n"
        "from acts_core.files import write_array, write_whole\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))\n"
        "with write_whole(Path('array.npy'), error=ActsError) as file:\n"
        "    write_array(file, np.zeros((100, 32, 32), dtype=np.uint16))\n"
    )
    ended = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert "ActsError: array.npy: cannot be written (File too large)" in ended.stderr
    assert not list(tmp_path.iterdir())
