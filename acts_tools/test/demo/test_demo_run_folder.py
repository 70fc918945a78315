# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where a run's files go when the folder in memory will not do."""

import os
from pathlib import Path
from types import SimpleNamespace

import pytest

from acts_tools.run_folder import shared_memory


def test_the_folder_in_memory_is_taken_where_it_will_do(tmp_path: Path) -> None:
    assert shared_memory(tmp_path) == tmp_path
    assert shared_memory(tmp_path / "nothing") is None


def test_not_where_it_cannot_be_written_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "access", lambda _path, _mode: False)
    assert shared_memory(tmp_path) is None


def test_nor_where_it_is_full(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "statvfs", lambda _path: SimpleNamespace(f_bavail=16, f_frsize=4096))
    assert shared_memory(tmp_path) is None
