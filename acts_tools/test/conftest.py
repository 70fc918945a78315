# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Fixtures of the tests of the acts command."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from fake_prefix import Prefix


@pytest.fixture
def prefix(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Prefix:
    folder = tmp_path / "prefix"
    folder.mkdir()
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.pathsep.join([str(folder), os.environ.get("AMENT_PREFIX_PATH", "")]))
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "log"))
    monkeypatch.delenv("OVERRIDE_LAUNCH_PROCESS_OUTPUT", raising=False)
    return Prefix(folder)
