# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where a message was removed since the last build, as in another branch, Python still imports the others."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("colcon") is None, reason="needs colcon: pip install colcon-common-extensions"),
]

PACKAGE = Path(__file__).resolve().parents[2] / "acts_msgs"
DEADLINE_S = 200.0
ASKED = "from acts_msgs.msg import {name}; {name}.__class__.__import_type_support__(); print({name}.__name__)"


def run_in(workspace: Path, command: str) -> str:
    """What a command prints in the workspace."""
    words = ["bash", "-c", command]
    finished = subprocess.run(words, cwd=workspace, capture_output=True, text=True, timeout=DEADLINE_S)
    assert finished.returncode == 0, finished.stdout + finished.stderr
    return finished.stdout


def build(workspace: Path, *names: str) -> None:
    """Build the package with these messages only, over what was built before."""
    package = workspace / "src" / "acts_msgs"
    shutil.rmtree(package, ignore_errors=True)
    (package / "msg").mkdir(parents=True)
    shutil.copy(PACKAGE / "package.xml", package)
    for name in names:
        shutil.copy(PACKAGE / "msg" / f"{name}.msg", package / "msg")
    text = (PACKAGE / "CMakeLists.txt").read_text()
    kept = re.sub(r"^ +msg/(\w+)\.msg\n", lambda found: found[0] if found[1] in names else "", text, flags=re.MULTILINE)
    (package / "CMakeLists.txt").write_text(kept)
    run_in(workspace, "colcon build --symlink-install")


def test_the_others_are_imported_after_a_message_was_removed(tmp_path: Path) -> None:
    build(tmp_path, "BallState", "Impact")
    build(tmp_path, "Impact")
    said = run_in(tmp_path, f"source install/setup.bash && python3 -c '{ASKED.format(name='Impact')}'")
    assert said == "Impact\n"
