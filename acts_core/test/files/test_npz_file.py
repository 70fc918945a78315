# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Arrays out of sound, damaged and other files."""

from __future__ import annotations

import contextlib
import io
import os
import tempfile
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.errors import ActsError, SettingsError
from acts_core.files import npz_names, read_npz, unpacked_bytes
from acts_core.runtime import begin


def archive() -> bytes:
    file = io.BytesIO()
    np.savez_compressed(file, a=np.arange(300), b=np.eye(7), text="words")
    return file.getvalue()


WHOLE = archive()


def test_arrays_are_read_by_name(tmp_path: Path) -> None:
    (tmp_path / "x.npz").write_bytes(WHOLE)
    assert set(read_npz(tmp_path / "x.npz", error=ActsError)) == {"a", "b", "text"}
    found = read_npz(tmp_path / "x.npz", ("a", "c"), error=ActsError)
    assert found.keys() == {"a"}
    np.testing.assert_array_equal(found["a"], np.arange(300))


def test_an_array_of_python_objects_is_refused_by_its_name_and_not_as_damaged(tmp_path: Path) -> None:
    np.savez(tmp_path / "x.npz", a=np.arange(3), names=np.array(["one", "two"], dtype=object))
    with pytest.raises(ActsError, match=r"x\.npz: names is an array of Python objects, .*names\.astype\(str\)$"):
        read_npz(tmp_path / "x.npz", error=ActsError)
    assert read_npz(tmp_path / "x.npz", ("a",), error=ActsError).keys() == {"a"}


@pytest.mark.parametrize("path", ["/dev/zero", "/dev", "pipe"])
def test_only_regular_files_are_read(path: str, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(ActsError, match="not a regular file; make it anew"):
        # A path from the root stays itself.
        read_npz(tmp_path / path, error=ActsError, hint="make it anew")


def test_what_unpacks_to_more_than_is_allowed_is_not_unpacked(tmp_path: Path) -> None:
    path = tmp_path / "x.npz"
    np.savez_compressed(path, large=np.zeros(10**6, dtype=np.uint8), small=np.zeros(10))
    assert path.stat().st_size < 10_000
    with pytest.raises(ActsError, match="unpacks to 1 MB; allowed are 0 MB"):
        read_npz(path, error=ActsError, limit_bytes=400_000)
    # Only what is asked for counts.
    assert read_npz(path, ("small",), error=ActsError, limit_bytes=1000).keys() == {"small"}


@pytest.mark.parametrize("member", ["large.npy", "large"])
def test_what_is_no_array_is_refused_and_its_size_counts(member: str, tmp_path: Path) -> None:
    path = tmp_path / "x.npz"
    np.savez(path, small=np.zeros(10))
    with zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED) as file:
        file.writestr(member, bytes(10**6))
    with pytest.raises(SettingsError, match=r"x\.npz: large is no array; make it anew$"):
        read_npz(path, ("large",), error=SettingsError, hint="make it anew")
    with pytest.raises(SettingsError, match="unpacks to 1 MB; allowed are 0 MB"):
        read_npz(path, ("large",), error=SettingsError, limit_bytes=400_000)
    assert read_npz(path, ("small",), error=SettingsError, limit_bytes=1000).keys() == {"small"}


def test_how_much_a_file_unpacks_to_is_known_without_unpacking_it(tmp_path: Path) -> None:
    path = tmp_path / "x.npz"
    np.savez_compressed(path, a=np.zeros(10**6, dtype=np.uint8))
    assert 10**6 < unpacked_bytes(path) < 10**6 + 1000
    os.mkfifo(tmp_path / "pipe")
    assert unpacked_bytes(tmp_path / "pipe") == unpacked_bytes(tmp_path / "none") == 0


def test_the_names_of_the_arrays_are_known_and_those_in_a_pipe_not_waited_for(tmp_path: Path) -> None:
    (tmp_path / "x.npz").write_bytes(WHOLE)
    os.mkfifo(tmp_path / "pipe.npz")
    assert npz_names(tmp_path / "x.npz") == {"a", "b", "text"}
    # On another thread: a test that fails is to end.
    assert begin(lambda: npz_names(tmp_path / "pipe.npz")).result(timeout=30.0) == frozenset()


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (None, "No such file"),
        (b"", "not an npz file"),
        (b"words", "not an npz file"),
        (WHOLE[: len(WHOLE) // 2], "not an npz file, or a part of one"),
    ],
)
def test_what_is_wrong_and_what_to_do_is_said(content: bytes | None, words: str, tmp_path: Path) -> None:
    path = tmp_path / "x.npz"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(SettingsError, match=words) as caught:
        read_npz(path, error=SettingsError, hint="make it anew")
    assert str(caught.value).startswith(str(path))
    assert str(caught.value).endswith("; make it anew")
    assert "pickle" not in str(caught.value)


def test_pickled_arrays_and_folders_are_refused(tmp_path: Path) -> None:
    np.savez(tmp_path / "x.npz", a=np.array([{}]))
    for path in (tmp_path / "x.npz", tmp_path):
        with pytest.raises(SettingsError):
            read_npz(path, error=SettingsError)


@pytest.mark.parametrize("compression", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_a_damaged_array_is_refused_however_it_is_compressed(compression: int, tmp_path: Path) -> None:
    array = io.BytesIO()
    np.save(array, np.arange(20_000))
    path = tmp_path / "x.npz"
    with zipfile.ZipFile(path, "w", compression) as file:
        file.writestr("a.npy", array.getvalue())
    content = bytearray(path.read_bytes())
    content[80:300] = bytes(220)
    path.write_bytes(content)
    with pytest.raises(SettingsError, match=r"damaged npz file|cannot be read"):
        read_npz(path, error=SettingsError)


@given(st.lists(st.tuples(st.integers(0, len(WHOLE) - 1), st.integers(1, 255)), min_size=1, max_size=4))
@settings(max_examples=300, deadline=None)
def test_no_damage_raises_anything_else(damage: list[tuple[int, int]]) -> None:
    content = bytearray(WHOLE)
    for at, turned in damage:
        content[at] ^= turned
    with tempfile.NamedTemporaryFile(suffix=".npz") as file:
        file.write(content)
        file.flush()
        with contextlib.suppress(SettingsError):
            read_npz(Path(file.name), error=SettingsError)
