"""A checkout where set-up cannot work is told so before anything is downloaded."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

BOOTSTRAP = Path(__file__).resolve().parent.parent / "scripts" / "bootstrap.py"


def tried(checkout: Path) -> subprocess.CompletedProcess[str]:
    """Run a copy of the set-up in a checkout of which there is nothing else."""
    (checkout / "scripts").mkdir(parents=True)
    script = shutil.copy(BOOTSTRAP, checkout / "scripts")
    return subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=30)


@pytest.mark.parametrize("name", ["my robots", "Prüfstand", "触覚", "it's", "a:b", "a;b", "$HOME", 'a"b', "new\nline"])
def test_a_path_that_the_build_cannot_carry_is_refused_first(tmp_path: Path, name: str) -> None:
    done = tried(tmp_path / name)
    assert done.returncode == 1
    assert done.stderr.startswith("[setup] the path of this checkout holds ")
    assert "Move the checkout" in done.stderr
    assert not (tmp_path / name / ".acts").exists()


def test_a_plain_path_is_not(tmp_path: Path) -> None:
    # It goes on, to find no list of wheels.
    assert "the path of this checkout" not in tried(tmp_path / "ros_ws-2/src/acts.git+1@x~").stderr
