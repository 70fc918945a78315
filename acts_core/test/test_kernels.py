# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The cache of compiled kernels: it serves a second process, and notices every change of what a kernel is made of."""

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from acts_core.kernels import as_compiled

pytestmark = pytest.mark.slow

FILES = {
    "constants.py": "STEP = 1\n",
    "inner.py": """
from acts_core.kernels import kernel
from acts_kerneltest.constants import (
    STEP,
)

@kernel
def stepped(value):
    return value + STEP
""",
    "outer.py": """
from acts_core.kernels import kernel
from acts_kerneltest import inner

stepped = inner.stepped

@kernel(fastmath={"nsz"})
def twice(value):
    return stepped(stepped(value))
""",
    "inner_other.py": "",
    "counting.py": """
from acts_core.kernels import kernel

@kernel
def more(value):
    return value + 1

@kernel
def count(n):
    i = 0
    while i < n:
        i = more(i)
    return i + more(10)
""",
    "elsewhere.py": "",
}

CALL = "from acts_kerneltest.outer import twice; result = twice(0)"

# Runs code in processes that share nothing but files. They are forks of one that has imported numba and compiled
# something: that takes a second.
SERVER = """
import json, os, sys, traceback
import numba
from acts_core import kernels
from numba.core import event

def run(code, folder, variables):
    os.environ.update(variables)
    sys.path.insert(0, folder)
    names = {}
    with event.install_recorder("numba:compile") as recorder:
        exec(code, names)
    return [names["result"], len(recorder.buffer) > 0]

numba.njit(lambda: 1)()
for line in sys.stdin:
    child = os.fork()
    if not child:
        try:
            told = run(*json.loads(line))
        except BaseException:
            told = traceback.format_exc()
        print(json.dumps(told), flush=True)
        os._exit(0)
    os.waitpid(child, 0)
"""

Run = Callable[..., tuple[Any, bool]]


@pytest.fixture
def package(tmp_path: Path) -> Path:
    folder = tmp_path / "acts_kerneltest"
    folder.mkdir()
    for name, text in {"__init__.py": "", **FILES}.items():
        (folder / name).write_text(text)
    return folder


@pytest.fixture(scope="module")
def server() -> Iterator[subprocess.Popen[str]]:
    places = {"NUMBA_CACHE_DIR", "XDG_CACHE_HOME"}
    environment = {name: value for name, value in os.environ.items() if name not in places}
    # Files are changed within the same second, which Python's own cache does not notice.
    environment["PYTHONDONTWRITEBYTECODE"] = "1"
    with subprocess.Popen(
        [sys.executable, "-c", SERVER], env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        yield process
        assert process.stdin is not None
        process.stdin.close()


@pytest.fixture
def run(server: subprocess.Popen[str], package: Path) -> Run:
    """Run code in a new process with some environment variables: its `result`, and whether anything was compiled."""

    def finished(code: str = CALL, **variables: str) -> tuple[Any, bool]:
        assert server.stdin is not None
        assert server.stdout is not None
        server.stdin.write(json.dumps([code, str(package.parent), variables]) + "\n")
        server.stdin.flush()
        told = json.loads(server.stdout.readline())
        assert isinstance(told, list), told
        return told[0], told[1]

    return finished


def folders(root: Path) -> list[str]:
    return sorted({str(path.parent) for path in root.rglob("*.nbi")})


def test_a_second_process_compiles_nothing(run: Run) -> None:
    assert run() == (2, True)
    assert run() == (2, False)


def test_a_change_of_anything_it_is_made_of_is_noticed(run: Run, package: Path) -> None:
    run()
    count = len(folders(package))
    for file, old, new, result in (
        ("constants.py", "STEP = 1", "STEP = 5", 10),
        ("inner.py", "value + STEP", "value - STEP", -10),
        ("outer.py", "stepped(stepped(value))", "stepped(value)", -5),
    ):
        (package / file).write_text(FILES[file].replace(old, new))
        assert run() == (result, True)
        # What was compiled of the former content is gone.
        assert len(folders(package)) == count
    assert run() == (-5, False)


def test_a_change_elsewhere_compiles_nothing(run: Run, package: Path) -> None:
    run()
    (package / "elsewhere.py").write_text("STEP = 7\n")
    # No module of the same beginning of a name is taken for a former one.
    (package / "inner_other.py").write_text(FILES["inner.py"])
    assert run() == (2, False)


def test_the_users_folder_is_used_where_it_is_asked_for(run: Run, package: Path, tmp_path: Path) -> None:
    mine = str(tmp_path / "mine")
    assert run(NUMBA_CACHE_DIR=mine) == (2, True)
    assert run(NUMBA_CACHE_DIR=mine) == (2, False)
    assert folders(package) == []
    assert folders(tmp_path / "mine")


def test_a_package_that_cannot_be_written_is_cached_with_the_user(run: Run, package: Path, tmp_path: Path) -> None:
    # A file in its place keeps even root from making the folder.
    (package / "__pycache__").write_text("")
    cache = str(tmp_path / "cache")
    assert run(XDG_CACHE_HOME=cache) == (2, True)
    assert run(XDG_CACHE_HOME=cache) == (2, False)
    assert folders(tmp_path / "cache")


WARNED = """
import warnings
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    {limit}
    from acts_kerneltest.outer import twice
    result = [twice(0), *(str(one.message) for one in told)]
"""


def test_on_a_full_disk_a_kernel_runs_and_it_is_said_once(run: Run, package: Path) -> None:
    # Files cannot grow: as on a full disk, but for the number of the error.
    full = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))"
    (value, *told), is_compiled = run(WARNED.format(limit=full))
    assert (value, is_compiled, len(told)) == (2, True, 1)
    assert "cannot be kept in " in told[0]
    assert "File too large" in told[0]
    assert run() == (2, True)
    assert run() == (2, False)


def test_where_no_folder_can_be_written_a_kernel_runs(run: Run, package: Path) -> None:
    (package / "__pycache__").write_text("")
    nowhere = dict.fromkeys(("NUMBA_CACHE_DIR", "XDG_CACHE_HOME", "HOME"), "/dev/null/x")
    (value, *told), is_compiled = run(WARNED.format(limit="pass"), **nowhere)
    assert (value, is_compiled, len(told)) == (2, True, 1)
    assert "set NUMBA_CACHE_DIR" in told[0]


def test_a_kernel_is_compiled_for_types_and_not_for_each_constant(run: Run, package: Path) -> None:
    # The variable begins as a constant as well.
    assert run("from acts_kerneltest.counting import count; result = count(3)") == (3 + 11, True)
    assert len(list(package.rglob("counting.more-*.nbc"))) == 1


def test_where_numba_is_told_to_compile_nothing_a_kernel_is_its_function(package: Path) -> None:
    code = "from acts_kerneltest.outer import twice; print(twice(0), type(twice).__name__)"
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    # Its folder is the first of sys.path.
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=package.parent, env=environment, capture_output=True, text=True
    )
    assert done.stderr == ""
    assert done.stdout == "2 function\n"
    assert folders(package) == []


def test_an_array_is_copied_only_where_a_kernel_would_be_compiled_anew() -> None:
    plain = np.arange(12.0).reshape(3, 4)
    assert as_compiled(plain) is plain
    fixed = plain.copy()
    fixed.flags.writeable = False
    for other in (plain[:, ::2], plain[::-1], plain.T, np.asfortranarray(plain), fixed):
        made = as_compiled(other)
        np.testing.assert_array_equal(made, other)
        assert made.flags.c_contiguous
        assert made.flags.writeable
