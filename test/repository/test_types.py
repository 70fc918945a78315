# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`make lint` checks the types of tests, too: in a checkout of one package. What pages have one copy passes as well."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("mypy") is None, reason="needs mypy: pip install mypy"),
]

ROOT = Path(__file__).resolve().parents[2]
RIG = "def pressed(counts: int) -> int:\n    return counts\n"
USE = "from rig import pressed\n\npressed()\n"
FILES = {
    "acts_some/setup.py": "",
    "acts_some/acts_some/__init__.py": "",
    "acts_some/test/rig.py": RIG,
    "acts_some/test/conftest.py": USE,
    "acts_some/test/room/conftest.py": f"{USE}pressed()\n",
    "acts_some/test/room/test_press.py": USE,
    "test/room/test_whole.py": "from acts_some import nothing\n",
    "conftest.py": "pressed: int = ''\n",
    "examples/press.py": "pressed: int = ''\n",
}


def test_a_mistake_is_told_wherever_python_is(tmp_path: Path) -> None:
    for name in ("pyproject.toml", "scripts/check_types.py"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    command = [sys.executable, str(tmp_path / "scripts/check_types.py")]
    told = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert told.returncode == 1, told
    errors = {line.split(":")[0] for line in told.stdout.splitlines() if ": error: " in line}
    assert errors == {name for name, text in FILES.items() if text not in ("", RIG)}, told


def test_modules_to_be_copied_from_pages_have_the_right_types(tmp_path: Path) -> None:
    paths: list[Path] = []
    for page in ("extending.md", "hand.md", "reflexes.md"):
        for code in re.findall(r"```python\n(.*?)```", (ROOT / "docs" / page).read_text(), re.DOTALL):
            paths.append(tmp_path / f"{page.removesuffix('.md')}_{len(paths)}.py")
            paths[-1].write_text(code)
    assert len(paths) >= 7
    # What they import is checked by `make lint`, where numpy is new enough for that.
    command = ["mypy", "--follow-imports=silent", *map(str, paths)]
    told = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=300)
    assert told.returncode == 0, told.stdout + told.stderr
