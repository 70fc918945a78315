# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where a message was removed since the last build, as in another branch, Python still imports the others.

rosidl goes on registering the removed one, and each import then ends with ``undefined symbol``, unless what it made for
Python is removed. To build the messages twice would take half a minute, so the tests look at what is removed.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(shutil.which("cmake") is None, reason="needs cmake: apt install cmake")

PACKAGE = Path(__file__).resolve().parents[2] / "acts_msgs"
DEADLINE_S = 100.0


def configure(workspace: Path, *names: str) -> None:
    """Prepare a build of the package with these messages only, over what was built before."""
    package = workspace / "acts_msgs"
    shutil.rmtree(package, ignore_errors=True)
    (package / "msg").mkdir(parents=True)
    shutil.copy(PACKAGE / "package.xml", package)
    for name in names:
        shutil.copy(PACKAGE / "msg" / f"{name}.msg", package / "msg")
    text = (PACKAGE / "CMakeLists.txt").read_text()
    kept = re.sub(r"^ +msg/(\w+)\.msg\n", lambda found: found[0] if found[1] in names else "", text, flags=re.MULTILINE)
    (package / "CMakeLists.txt").write_text(kept)
    words = ["cmake", "-S", str(package), "-B", str(workspace / "build")]
    finished = subprocess.run(words, capture_output=True, text=True, timeout=DEADLINE_S)
    assert finished.returncode == 0, finished.stdout + finished.stderr


def test_what_was_made_for_python_is_made_anew_where_a_message_was_removed(tmp_path: Path) -> None:
    configure(tmp_path, "BallState", "Impact")
    made = tmp_path / "build" / "rosidl_generator_py" / "acts_msgs" / "msg" / "_ball_state_s.c"
    made.parent.mkdir(parents=True, exist_ok=True)
    made.write_text("// Of the build.\n")
    configure(tmp_path, "BallState", "Impact")
    assert made.exists(), "nothing has changed: what was built is used again"
    configure(tmp_path, "Impact")
    assert not made.exists()
