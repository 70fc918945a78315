# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Commands that read a large file say so first."""

from pathlib import Path

import numpy as np
import pytest

from acts_tools import large_files
from acts_tools.cli import main

COMMANDS = (
    *(["evaluate", what, "--frames"] for what in ("recovery", "classification", "slip", "gait")),
    ["library", "--output", "new.npz", "--frames"],
    ["train", "--output", "new.npz", "--frames"],
)


@pytest.mark.parametrize("command", COMMANDS, ids=lambda words: " ".join(words[:2]))
def test_how_much_is_unpacked_is_told_before_it_is_read(
    command: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "x.npz"
    np.savez(path, other=np.zeros(2_000_000, dtype=np.uint8))
    assert main([*command, str(path)]) != 0
    assert "reading" not in capsys.readouterr().err
    monkeypatch.setattr(large_files, "UNPACKED_BYTES_MAX", 1_000_000)
    assert main([*command, str(path)]) != 0
    assert capsys.readouterr().err.startswith(f"reading {path}: 2 MB unpacked\nerror: {path}")
