# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Words for ports that cannot even be looked at."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from acts_core.runtime import is_stale_link, not_opened, path_shown

NOBODY = 65534


@contextmanager
def private(folder: Path) -> Iterator[None]:
    """Meanwhile, this process may not look into a folder; root becomes somebody else for that."""
    is_root = os.geteuid() == 0
    folder.chmod(0)
    if is_root:
        os.seteuid(NOBODY)
    try:
        yield
    finally:
        if is_root:
            os.seteuid(0)
        folder.chmod(0o700)


def test_a_port_in_somebody_elses_folder_is_told_as_such(tmp_path: Path) -> None:
    (tmp_path / "hand").symlink_to("/dev/pts/0")
    port = str(tmp_path / "hand")
    with private(tmp_path):
        assert not is_stale_link(port)
        assert path_shown(port) == port
        told = not_opened(port, errno.EACCES, "", what="hand", present="")
    assert told == (
        f"port {port}: permission denied; a folder on the way to it is somebody else's: start this program as that "
        "user, or name another port"
    )


@pytest.mark.parametrize("name", ["x" * 300, "x/" * 3000], ids=["of a file", "of all folders"])
def test_a_name_that_is_too_long_is_only_told(name: str) -> None:
    path = f"/tmp/{name}"
    assert not is_stale_link(path)
    assert path_shown(path) == path
