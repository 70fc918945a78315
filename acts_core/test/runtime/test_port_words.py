# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Words for ports that cannot even be looked at."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from acts_core.runtime import holders, is_stale_link, not_opened, path_shown

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


def test_a_link_that_vanishes_while_it_is_looked_at_is_only_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    link = tmp_path / "hand"

    def vanish(path: str) -> str:
        link.unlink()
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), path)

    monkeypatch.setattr(os, "readlink", vanish)
    for look in (is_stale_link, path_shown, holders):
        link.symlink_to("/dev/pts/0")
        look(str(link))
        assert not link.is_symlink()


def test_a_port_is_held_by_a_program_whose_name_was_cut_off_within_a_letter(tmp_path: Path) -> None:
    port = tmp_path / "port"
    port.touch()
    hold = "Path('/proc/self/comm').write_bytes('fourteen_bytesü'.encode()[:15]); port = open(sys.argv[1])"
    code = f"import sys; from pathlib import Path; {hold}; print('held', flush=True); sys.stdin.read()"
    with subprocess.Popen(
        [sys.executable, "-c", code, str(port)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"held\n"
        told = not_opened(str(port), errno.EBUSY, "", what="board", present="")
        process.communicate()
    assert told == f"port {port} is held by fourteen_bytes\ufffd (process {process.pid}); stop that program first"


@pytest.mark.parametrize(
    ("port", "may_be_simulated"),
    [("/dev/ttyACM0", False), ("/dev/serial/by-id/usb-1", False), ("/dev/shm/acts-ann/hand", True), ("run/hand", True)],
)
def test_a_port_that_a_simulated_hand_may_make_yet_is_told_as_such(port: str, may_be_simulated: bool) -> None:
    told = not_opened(port, errno.ENOENT, "", what="hand", present="Ports present: none.")
    assert told.startswith(f"port {port} is not there; plug the hand in or name another port. Ports present: none.")
    assert told.endswith(
        " A simulated hand makes its port when it is ready, on its first start after up to a minute."
    ) == (may_be_simulated)
