# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Full shared memory is told in words."""

from __future__ import annotations

import os
from pathlib import Path
from types import SimpleNamespace

import pytest

from acts_core.errors import ActsError
from acts_ros.executables.shared_memory import check_shared_memory


def leave(monkeypatch: pytest.MonkeyPatch, free_bytes: int) -> None:
    monkeypatch.setattr(os, "statvfs", lambda path: SimpleNamespace(f_bavail=free_bytes // 4096, f_frsize=4096))


def test_full_memory_is_told_with_what_to_do(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    leave(monkeypatch, free_bytes=4096)
    with pytest.raises(ActsError, match=r"shared memory is full .* remove what is not needed"):
        check_shared_memory(tmp_path)


def test_what_can_work_may_start(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    check_shared_memory(tmp_path / "missing")
    leave(monkeypatch, free_bytes=1 << 20)
    check_shared_memory(tmp_path)
    # Another program has met the library before.
    leave(monkeypatch, free_bytes=0)
    (tmp_path / "lttng-ust-wait-6").touch()
    check_shared_memory(tmp_path)
