# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The folder of simulated processes: one user's alone, and each thing in it one process's alone."""

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest

from acts_core.errors import ActsError, SettingsError
from acts_sim.shared import FileClaim, default_run_dir

HOLDER = """
import sys
from pathlib import Path
from acts_sim.shared.run_folder import FileClaim
claim = FileClaim(Path(sys.argv[1]))
print("claimed", flush=True)
sys.stdin.read()
"""


def test_each_user_has_a_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("USER", "ann")
    anns = default_run_dir()
    monkeypatch.setenv("USER", "bob")
    assert default_run_dir() != anns


@pytest.mark.parametrize("path", [Path(), Path("/")])
def test_a_path_that_names_no_file_is_refused(path: Path) -> None:
    with pytest.raises(SettingsError, match=r"names no file; needed is"):
        FileClaim(path)


def test_what_is_claimed_is_refused_to_others_by_the_holders_name_until_it_is_given_up(tmp_path: Path) -> None:
    ring = tmp_path / "field.ring"
    claim = FileClaim(ring)
    told = rf"{ring} is in use by process {os.getpid()} \(.*\); end that program.*another path"
    with pytest.raises(SettingsError, match=told):
        FileClaim(ring)
    FileClaim(tmp_path / "joints.ring").close()
    claim.close()
    claim.close()
    FileClaim(ring).close()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("content", [b"mine\n", b"12 of mine\n", b"1" * 25])
def test_a_file_that_is_no_lock_is_refused_and_stays_as_it_is(tmp_path: Path, content: bytes) -> None:
    other = tmp_path / "poetry.lock"
    other.write_bytes(content)
    with pytest.raises(SettingsError, match=rf"{other} is no lock of a file, and would be lost"):
        FileClaim(tmp_path / "poetry")
    assert other.read_bytes() == content


def test_a_killed_process_has_no_claim_any_more(tmp_path: Path) -> None:
    ring = tmp_path / "field.ring"
    command = [sys.executable, "-c", HOLDER, str(ring)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == b"claimed\n"
        with pytest.raises(ActsError, match=f"process {holder.pid} "):
            FileClaim(ring)
        holder.kill()
        holder.wait()
        FileClaim(ring).close()


def test_a_program_that_is_just_ending_is_waited_for(tmp_path: Path) -> None:
    ring = tmp_path / "field.ring"
    command = [sys.executable, "-c", HOLDER, str(ring)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as holder:
        assert holder.stdin is not None
        assert holder.stdout is not None
        assert holder.stdout.readline() == b"claimed\n"
        holder.stdin.close()
        FileClaim(ring).close()


def test_a_link_in_place_of_the_lock_is_not_followed(tmp_path: Path) -> None:
    victim = tmp_path / "victim"
    victim.write_text("kept")
    (tmp_path / "field.ring.lock").symlink_to(victim)
    with pytest.raises(ActsError, match="cannot be locked"):
        FileClaim(tmp_path / "field.ring")
    assert victim.read_text() == "kept"


def test_a_folder_that_is_read_only_is_a_wrong_setting(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir(mode=0o500)
    # Root may write to any folder but those of the kernel.
    path = folder / "field.ring" if os.geteuid() != 0 else Path("/proc/field.ring")
    with pytest.raises(SettingsError, match="cannot be locked"):
        FileClaim(path)


def test_a_full_folder_is_told_and_nothing_of_the_lock_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patched:
        patched.setattr(os, "pwrite", full)
        with pytest.raises(
            ActsError, match=r"field.ring.lock cannot be written \(No space left on device\); .*run_dir:="
        ):
            FileClaim(tmp_path / "field.ring")
    assert list(tmp_path.iterdir()) == []
    FileClaim(tmp_path / "field.ring").close()


def test_a_lock_that_another_has_taken_after_the_folder_was_cleared_stays(tmp_path: Path) -> None:
    path, lock = tmp_path / "field.ring", tmp_path / "field.ring.lock"
    first = FileClaim(path)
    lock.unlink()
    second = FileClaim(path)
    first.close()
    assert lock.exists()
    with pytest.raises(SettingsError, match="is in use by process"):
        FileClaim(path)
    second.close()
    assert not lock.exists()
