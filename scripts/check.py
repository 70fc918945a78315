# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Linters, type checks and the test suite; `make test`, `test-quick`, `lint` and `format` run it in the environment."""

from __future__ import annotations

import argparse
import fcntl
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import version
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# More side by side gain little: the longest files of tests are the whole system's, on processes of their own.
MAX_PROCESSES = 4
LINTERS = ("ruff", "mypy", "clang-format")
# What numpy says of its own types changes; for Python 3.10 there is no newer one than 2.2.
OLDEST_TYPED_NUMPY = (2, 4)
CXX_PATTERNS = ("*.cpp", "*.hpp", "*.h", "*.ino")
# Errors here and not in the build: a warning that only a newer compiler knows must not keep anybody from building.
CXX_WARNINGS = ["-std=c++17", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
# What each process of tests would else compile by itself: kernels, and files of tests, which pytest keeps compiled.
WARM_UP = {
    "kernels": [sys.executable, "scripts/compile_kernels.py"],
    "files of tests": [sys.executable, "-m", "pytest", "--collect-only", "-o", "addopts=", "-p", "no:terminal"],
}
# Assembler of the Teensy's processor; scripts/firmware.py compiles it, with the same warnings.
TARGET_ONLY = "acts_firmware/teensy/qemu/"


def tracked(*patterns: str) -> list[str]:
    """Files git knows that match; in a tree without git, all that match outside of the build folders."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", *patterns]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if listed.returncode == 0:
        return [name for name in listed.stdout.splitlines() if (ROOT / name).is_file()]
    found = (path.relative_to(ROOT) for pattern in patterns for path in ROOT.rglob(pattern))
    return sorted(str(path) for path in found if path.parts[0] not in (".acts", "build", "install"))


def run(title: str, command: list[str], env: dict[str, str] | None = None) -> list[str]:
    """Run a command; its title and exit code where it has failed."""
    print(f"[check] {title}", flush=True)
    return failed(title, subprocess.run(command, cwd=ROOT, env=env).returncode)


def failed(title: str, returncode: int) -> list[str]:
    return [] if returncode == 0 else [f"{title} (exit code {returncode})"]


def run_side_by_side(commands: dict[str, list[str]]) -> list[str]:
    """Run commands at the same time; what each says is printed in one piece, in their order."""
    with ThreadPoolExecutor() as pool:
        done = {
            title: pool.submit(
                subprocess.run, command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
            )
            for title, command in commands.items()
        }
        for title, future in done.items():
            print(f"[check] {title}", flush=True)
            print(future.result().stdout, end="", flush=True)
    return [one for title, future in done.items() for one in failed(title, future.result().returncode)]


def lint(beside: dict[str, list[str]]) -> list[str]:
    """Every linter, also after one has failed, so that one run shows all there is; and commands to run beside them."""
    firmware = [f"-I{ROOT}/acts_firmware/{folder}" for folder in ("src", "virtual_board", "teensy/arduino")]
    types = {"mypy": [sys.executable, "scripts/check_types.py"]}
    if tuple(map(int, version("numpy").split(".")[:2])) < OLDEST_TYPED_NUMPY:
        print(f"[check] mypy is left out: it needs the types of a newer numpy than {version('numpy')}", flush=True)
        types = {}
    on_host = [name for name in tracked("*.cpp") if not name.startswith(TARGET_ONLY)]
    return run_side_by_side(
        {
            "ruff: rules": ["ruff", "check", "."],
            "ruff: format": ["ruff", "format", "--check", "--quiet", "."],
            **types,
            "clang-format": ["clang-format", "--dry-run", "--Werror", *tracked(*CXX_PATTERNS)],
            "g++: warnings": ["g++", *CXX_WARNINGS, *firmware, *on_host],
            "package.xml: what is imported is declared": [sys.executable, "scripts/dependencies.py"],
            **beside,
        }
    )


def reformat() -> list[str]:
    return [
        *run("ruff: rules", ["ruff", "check", "--fix", "--quiet", "."]),
        *run("ruff: format", ["ruff", "format", "--quiet", "."]),
        *run("clang-format", ["clang-format", "-i", *tracked(*CXX_PATTERNS)]),
    ]


def test(arguments: list[str]) -> list[str]:
    # Without these checks a wrong message field is serialised as garbage instead of raising.
    env = {**os.environ, "ROS_PYTHON_CHECK_FIELDS": "1"}
    # Two suites at once, of this or of another checkout, would meet in the tests' ROS domains and loopback ports.
    path = Path(tempfile.gettempdir()) / f"acts_test_{os.getuid()}.lock"
    with path.open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print("[check] waiting for another run of the test suite on this machine to end", flush=True)
            fcntl.flock(lock, fcntl.LOCK_EX)
        return run("pytest", [sys.executable, "-m", "pytest", *side_by_side(), *arguments], env)


def side_by_side() -> list[str]:
    """Options of pytest-xdist, where that is installed; see conftest.py."""
    if importlib.util.find_spec("xdist") is None:
        return []
    # More than cores: tests of the whole system wait more than they compute.
    processes = min(len(os.sched_getaffinity(0)) + 2, MAX_PROCESSES)
    options = ["--numprocesses", str(processes), "--dist", "loadfile"]
    # In the order of conftest.py. Without a restart the run ends where a process has crashed; with one it hangs
    # (pytest-xdist 3.8).
    return [*options, "--no-loadscope-reorder", "--max-worker-restart", "0"]


def ended(failures: list[str]) -> int:
    """The exit code; what has failed is named last, for it may stand far above."""
    if failures:
        print(f"[check] failed: {', '.join(failures)}", flush=True)
    return 1 if failures else 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lint", action="store_true", help="linters only")
    parser.add_argument("--quick", action="store_true", help="ruff, and the tests that are not marked slow")
    parser.add_argument("--format", action="store_true", help="format the sources and stop")
    parser.add_argument("pytest", nargs="*", help="arguments for pytest, after --")
    arguments = parser.parse_args()
    needed = ("ruff",) if arguments.quick else ("ruff", "clang-format") if arguments.format else LINTERS
    missing = [tool for tool in needed if shutil.which(tool) is None]
    if missing:
        # A sourced ROS installation need not have them; the bare machine's set-up always does.
        print(f"[check] linters left out, not installed: {', '.join(missing)} (pip install {' '.join(missing)})")
        failures = ["linters: not installed"] if arguments.lint or arguments.format else []
    elif arguments.format:
        failures = reformat()
    elif arguments.quick:
        failures = run("ruff: rules", ["ruff", "check", "."])
    else:
        failures = lint({} if arguments.lint else WARM_UP)
    if not arguments.lint and not arguments.format:
        chosen = ["-m", "not slow"] if arguments.quick else []
        # Also when a linter complained, so that one run shows all there is.
        failures += test([*chosen, *arguments.pytest])
    return ended(failures)


if __name__ == "__main__":
    sys.exit(main())
