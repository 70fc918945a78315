# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The firmware's core on the host under random commands, built anew with a check of every access and every sum."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

FIRMWARE = Path(__file__).parents[2]
OPTIONS = ["-std=c++17", "-O1", "-g1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]


def test_no_command_makes_the_core_do_what_is_undefined(tmp_path: Path) -> None:
    sources = [
        FIRMWARE / "test" / "random_commands.cpp",
        *sorted(FIRMWARE.glob("src/**/*.cpp")),
        *(FIRMWARE / "virtual_board" / "board" / f"{name}.cpp" for name in ("wired_board", "wiring_faults")),
    ]
    folders = [f"-I{FIRMWARE / folder}" for folder in ("src", "virtual_board")]
    program = tmp_path / "random_commands"
    subprocess.run(["g++", *OPTIONS, *folders, *sources, "-o", program], check=True, timeout=300)
    result = subprocess.run([program], capture_output=True, text=True, timeout=300)
    assert result.returncode == 0, result.stderr
