# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""For every test: a loaded machine is slow, which is no failure; signals do what they do in a terminal; recordings.

`make test` runs files of tests side by side in more processes than there are cores (pytest-xdist). Tests that keep
others from the cores are marked `alone`: while they run, the other processes wait between two tests.
A process whose test does not end is ended with a traceback of all its threads: a deadlock in a library must not hold
the run for ever.
"""

import faulthandler
import fcntl
import gc
import importlib.util
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TextIO

import pytest
from hypothesis import HealthCheck, settings

# As for nodes: the matrices are small, and on busy cores a second thread makes a product of them take fifty times as
# long. Read where numpy is imported, which is later than here.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

settings.register_profile("search", deadline=None, suppress_health_check=[HealthCheck.too_slow])
# The same examples every time: what fails is then what was changed. See docs/development.md for how to look for others.
settings.register_profile("acts", settings.get_profile("search"), derandomize=True)
settings.load_profile("acts")

# In the background, or under nohup, these are ignored, and the processes that tests send them to would inherit that.
_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)


def _hear(number: signal.Signals) -> None:
    signal.signal(number, signal.default_int_handler if number is signal.SIGINT else signal.SIG_DFL)


for _number in _SIGNALS:
    _hear(_number)

# A minute and a half is the longest that a test took on a machine that was far too busy.
_HANGS_AFTER_S = 600.0
_STDERR = pytest.StashKey[int]()
_CORES = pytest.StashKey[TextIO | None]()
_LONG_ID = 120  # characters

_ROOT = Path(__file__).resolve().parent

RECORDINGS = Path(os.environ.get("ACTS_RECORDINGS") or Path(__file__).resolve().parents[1] / "shared" / "data")


@pytest.fixture(scope="session")
def recording_path() -> Callable[[str], Path]:
    """Where a published recording is; the test that asks for one is skipped where it is not."""

    def path_of(name: str) -> Path:
        path = RECORDINGS / name
        if not path.is_file():
            pytest.skip(f"{path} is absent: no recording is part of the project (docs/development.md, Recordings)")
        return path

    return path_of


@pytest.fixture(scope="session")
def realtime() -> None:
    """Real-time scheduling; the test that asks for it is skipped where that is not allowed."""
    tried = "import os; os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(21))"
    if subprocess.run([sys.executable, "-c", tried], capture_output=True).returncode != 0:
        pytest.skip("SCHED_FIFO is not allowed here (`acts doctor` tells what is missing)")


@pytest.fixture(scope="session")
def ur_rtde() -> None:
    """The library of the UR5e; the test that asks for it is skipped where the Python is too new for a wheel of it."""
    if sys.version_info >= (3, 13) and importlib.util.find_spec("rtde_receive") is None:
        pytest.skip("ur_rtde has no wheel for Python 3.13 and newer: make setup PYTHON=/path/to/python3.12")


@pytest.fixture(scope="module", autouse=True)
def _environment() -> Iterator[None]:
    """What a command sets for its nodes, as `acts diagnostics` how they are discovered, ends with the file of tests."""
    before = dict(os.environ)
    yield
    before["PYTEST_CURRENT_TEST"] = os.environ["PYTEST_CURRENT_TEST"]  # pytest's own
    for name in os.environ.keys() - before.keys():
        del os.environ[name]
    os.environ.update(before)


def pytest_configure(config: pytest.Config) -> None:
    """Keep the standard error output: pytest redirects it while a test runs."""
    assert sys.__stderr__ is not None
    config.stash[_STDERR] = os.dup(sys.__stderr__.fileno())


def pytest_make_parametrize_id(val: object) -> str | None:
    """Shorten what would make the name of a test a screen long; None leaves the name to pytest."""
    if isinstance(val, (str, bytes)) and len(val) > _LONG_ID:
        return f"{val[: _LONG_ID // 3]!a} and on to {len(val)}"
    if isinstance(val, int) and val.bit_length() > 4 * _LONG_ID:
        return f"number of {val.bit_length()} bits"
    return None


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Iterator[None]:
    """Search for garbage only among what comes to be while tests run: modules and tests stay, and are many."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Side by side, mix what computes with what waits, which is much the same within a package.

    The files of every package are spread over the whole run. Those with tests that run alone come first: later, all
    processes would wait for the longest test.
    """
    if "PYTEST_XDIST_WORKER" not in os.environ:
        return
    files: dict[str, list[Path]] = {}
    for path in dict.fromkeys(item.path for item in items):
        files.setdefault(path.relative_to(_ROOT).parts[0], []).append(path)
    places = {path: number / len(paths) for paths in files.values() for number, path in enumerate(paths)}
    places.update({item.path: -1.0 for item in items if _is_alone(item)})
    items.sort(key=lambda item: places[item.path])


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item, nextitem: pytest.Item | None) -> Iterator[None]:
    """Let a test marked `alone` run while no other does; end a process whose test does not end."""
    if "PYTEST_XDIST_WORKER" not in os.environ:
        return (yield)
    kept = item.config.stash
    cores = kept.get(_CORES, None) or _take_cores(item)
    kept[_CORES] = None
    faulthandler.dump_traceback_later(_HANGS_AFTER_S, exit=True, file=kept[_STDERR])
    try:
        return (yield)
    finally:
        faulthandler.cancel_dump_traceback_later()
        # Such tests that follow one another wait once for all others to end theirs, and the others once for them.
        if _is_alone(item) and nextitem is not None and _is_alone(nextitem):
            kept[_CORES] = cores
        else:
            cores.close()


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown() -> None:
    """Hear again what a launcher that a test ran in this process ignores once it has ended: processes inherit that."""
    for number in _SIGNALS:
        if signal.getsignal(number) is signal.SIG_IGN:
            _hear(number)


def _is_alone(item: pytest.Item) -> bool:
    return item.get_closest_marker("alone") is not None


def _take_cores(item: pytest.Item) -> TextIO:
    """Wait until a test may run; others may once the file is closed that is returned."""
    path = Path(tempfile.gettempdir()) / f"acts_test_{os.getuid()}"
    cores = path.with_suffix(".cores").open("w")
    with path.with_suffix(".turn").open("w") as turn:
        fcntl.flock(turn, fcntl.LOCK_EX)  # whoever waits for the cores keeps others from taking them again and again
        fcntl.flock(cores, fcntl.LOCK_EX if _is_alone(item) else fcntl.LOCK_SH)
    return cores
