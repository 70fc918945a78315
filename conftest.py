# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""For every test: a loaded machine is slow, which is no failure; signals do what they do in a terminal; recordings.

`make test` runs files of tests side by side in one process more than there are cores (pytest-xdist). Tests that keep
others from the cores are marked `alone`: while one of them runs, the other processes wait between two tests.
A process whose test does not end is ended with a traceback of all its threads: a deadlock in a library must not hold
the run for ever.
"""

import faulthandler
import fcntl
import os
import signal
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile("acts", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("acts")

# In the background, or under nohup, these are ignored, and the processes that tests send them to would inherit that.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)

# A minute and a half is the longest that a test took on a machine that was far too busy.
_HANGS_AFTER_S = 600.0
_STDERR = pytest.StashKey[int]()

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


def pytest_configure(config: pytest.Config) -> None:
    """Keep the standard error output: pytest redirects it while a test runs."""
    config.stash[_STDERR] = os.dup(sys.__stderr__.fileno())


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Let a test marked `alone` run while no other does; end a process whose test does not end."""
    if "PYTEST_XDIST_WORKER" not in os.environ:
        return (yield)
    path = Path(tempfile.gettempdir()) / f"acts_test_{os.getuid()}"
    with path.with_suffix(".turn").open("w") as turn, path.with_suffix(".cores").open("w") as cores:
        fcntl.flock(turn, fcntl.LOCK_EX)  # whoever waits for the cores keeps others from taking them again and again
        fcntl.flock(cores, fcntl.LOCK_EX if item.get_closest_marker("alone") else fcntl.LOCK_SH)
        fcntl.flock(turn, fcntl.LOCK_UN)
        faulthandler.dump_traceback_later(_HANGS_AFTER_S, exit=True, file=item.config.stash[_STDERR])
        try:
            return (yield)
        finally:
            faulthandler.cancel_dump_traceback_later()
