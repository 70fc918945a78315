# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Check the types of all Python there is by mypy: packages, their tests, scripts and examples."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def mypy(*arguments: str, path: str = "") -> int:
    """Run mypy, with a further folder to import from; its exit code."""
    return subprocess.run(["mypy", *arguments], cwd=ROOT, env={**os.environ, "MYPYPATH": path}).returncode


def main() -> int:
    packages = sorted(f"{path.parent.name}/{path.parent.name}" for path in ROOT.glob("*/setup.py"))
    tests = sorted(str(path.relative_to(ROOT)) for path in (*ROOT.glob("*/test"), ROOT / "test"))
    codes = [mypy(*packages, *tests, "conftest.py", "scripts", "examples")]
    # mypy knows a module that is in no package by the name of its file, and takes no name twice. So `exclude` in
    # pyproject.toml leaves conftest.py of folders out above, and each has a run of its own, most of it from the cache.
    for folder in tests:
        for path in sorted((ROOT / folder).rglob("conftest.py")):
            codes.append(mypy("--no-error-summary", str(path.relative_to(ROOT)), path=f"{folder}:test"))
    return max(codes)


if __name__ == "__main__":
    sys.exit(main())
