# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Launch tests for two back-ends: the real `launch_pytest` where it is installed, `acts launch` elsewhere.

    @launch_fixture
    def tactile() -> LaunchFile:
        return LaunchFile("acts_bringup", "tactile.launch.xml", domain_id=61, arguments={"sim": "true"})

    @launch_test(tactile)
    def test_contact_is_published(tactile: Launched) -> None:
        tactile.wait_for_message("/plate/contact", Contact)
        assert tactile.stop() == 0

`launched` is the same without pytest's fixtures.
"""

from __future__ import annotations

import functools
import importlib.util
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from acts_tools.testing.launched import Launched, LaunchFile, ProcessLaunch

__all__ = ["HAS_LAUNCH_PYTEST", "LaunchFile", "Launched", "ProcessLaunch", "launch_fixture", "launch_test", "launched"]

HAS_LAUNCH_PYTEST = importlib.util.find_spec("launch_pytest") is not None


@contextmanager
def launched(
    package: str,
    file: str | None = None,
    *,
    domain_id: int,
    environment: Mapping[str, str] | None = None,
    **arguments: str,
) -> Iterator[ProcessLaunch]:
    """Run a launch file by `acts launch` for the length of a block.

    Parameters
    ----------
    package, file, domain_id, environment
        See `LaunchFile`.
    **arguments : str
        Launch arguments.
    """
    launch_file = LaunchFile(package, file, domain_id, arguments, environment or {})
    with _running(launch_file) as run:
        yield run


@contextmanager
def _running(launch_file: LaunchFile) -> Iterator[ProcessLaunch]:
    with tempfile.TemporaryDirectory(prefix="acts_launch_test_") as folder:
        run = ProcessLaunch(launch_file, Path(folder))
        try:
            yield run
        finally:
            run.close()
            # pytest shows it if the test has failed; a failed assertion of the test is not visible here.
            print(run.output)


def launch_fixture(function: Callable[..., LaunchFile]) -> Any:
    """Make a pytest fixture from a function that returns a `LaunchFile`, which runs for the length of the test.

    The function may use other fixtures. The test must be decorated with `launch_test`.
    """
    if HAS_LAUNCH_PYTEST:
        from acts_tools.testing.launch_pytest_backend import make_fixture

        return make_fixture(function)

    @functools.wraps(function)
    def run_it(*args: Any, **kwargs: Any) -> Iterator[ProcessLaunch]:
        with _running(function(*args, **kwargs)) as run:
            yield run

    return pytest.fixture(run_it)


def launch_test(fixture: Any) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Decorate a test that has a `launch_fixture` as an argument of the fixture's name, of type `Launched`."""
    if HAS_LAUNCH_PYTEST:
        from acts_tools.testing.launch_pytest_backend import make_test

        return make_test(fixture)
    return lambda body: body
