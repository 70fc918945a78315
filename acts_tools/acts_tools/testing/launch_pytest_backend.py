# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The second back-end of launch tests: the real `launch_pytest`, in the process of the tests."""

from __future__ import annotations

import asyncio
import functools
import os
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import launch_pytest
import pytest
from launch import LaunchContext, LaunchDescription
from launch.actions import (
    IncludeLaunchDescription,
    OpaqueFunction,
    RegisterEventHandler,
    SetEnvironmentVariable,
)
from launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from launch.events import Shutdown
from launch.launch_description_sources import AnyLaunchDescriptionSource

from acts_ros.processes import packages
from acts_ros.processes.launcher import STOPPED_CODES
from acts_tools.testing.launched import Launched, LaunchFile


class ServiceLaunch(Launched):
    """A launch by the real launch service of `description`."""

    def __init__(self, launch_file: LaunchFile) -> None:
        super().__init__(launch_file.domain_id)
        self._text: list[str] = []
        self._parts: dict[tuple[int, bool], str] = {}
        self._context: LaunchContext | None = None
        # Written by the launch's thread, read by the test's.
        self._lock = threading.Lock()
        self._alive: set[int] = set()
        self._failed: set[int] = set()
        self._stopping = False
        self.description = LaunchDescription(
            [
                OpaqueFunction(function=self._keep_context),
                *(SetEnvironmentVariable(name, value) for name, value in launch_file.added_environment().items()),
                RegisterEventHandler(OnProcessIO(on_stdout=self._on_output, on_stderr=self._on_output)),
                RegisterEventHandler(OnProcessStart(on_start=self._on_start)),
                RegisterEventHandler(OnProcessExit(on_exit=self._on_exit)),
                # Before the file: otherwise the test would wait for ever for a file that cannot be evaluated.
                launch_pytest.actions.ReadyToTest(),
                IncludeLaunchDescription(
                    AnyLaunchDescriptionSource(str(_path(launch_file))),
                    launch_arguments=list(launch_file.arguments.items()),
                ),
            ]
        )

    @property
    def output(self) -> str:
        """See `Launched`."""
        with self._lock:
            return "".join(self._text)

    @property
    def running(self) -> bool:
        """See `Launched`."""
        return self._context is not None and not self._context.is_shutdown

    def stop(self, timeout_s: float = 30.0) -> int:
        """See `Launched`."""
        assert self._context is not None
        if self.running:
            event = Shutdown(reason="the test is done")
            with self._lock:
                self._stopping = True
            asyncio.run_coroutine_threadsafe(self._context.emit_event(event), self._context.asyncio_loop).result()
        self._wait(lambda: not self._any_alive(), timeout_s, "the processes to end", while_running=False)
        with self._lock:
            return 1 if self._failed else 0

    def _any_alive(self) -> bool:
        with self._lock:
            return bool(self._alive)

    def _keep_context(self, context: LaunchContext) -> None:
        self._context = context

    def _on_output(self, event: Any) -> None:
        # Each line after the name of its process, as launches print it. A line may come in parts.
        source = (event.pid, event.from_stdout)
        with self._lock:
            text = self._parts.pop(source, "") + event.text.decode(errors="replace")
            lines = text.splitlines(keepends=True)
            if lines and not lines[-1].endswith("\n"):
                self._parts[source] = lines.pop()
            self._text += [f"[{event.process_name}] {line}" for line in lines]

    def _on_start(self, event: Any, _context: LaunchContext) -> None:
        with self._lock:
            self._alive.add(event.pid)
            # Restarted by `respawn`: its earlier exit code does not count.
            self._failed.discard(id(event.action))
            self._text.append(f"[{event.process_name}]: process started with pid [{event.pid}]\n")

    def _on_exit(self, event: Any, _context: LaunchContext) -> None:
        with self._lock:
            self._alive.discard(event.pid)
            # Its last lines, where they do not end; its output has been read before.
            for from_stdout in (True, False):
                rest = self._parts.pop((event.pid, from_stdout), "")
                self._text += [f"[{event.process_name}] {rest}\n"] if rest else []
            self._text.append(f"[{event.process_name}]: process ended with exit code {event.returncode}\n")
            if event.returncode not in (STOPPED_CODES if self._stopping else (0,)):
                self._failed.add(id(event.action))


def _path(launch_file: LaunchFile) -> Path:
    if launch_file.file is None:
        return Path(launch_file.package)
    return packages.launch_file(launch_file.package, launch_file.file, os.environ)


def make_fixture(function: Callable[..., LaunchFile]) -> Any:
    """See `launch_runner.launch_fixture`."""

    @functools.wraps(function)
    def describe(*args: Any, **kwargs: Any) -> list[Any]:
        run = ServiceLaunch(function(*args, **kwargs))
        return [run.description, run]

    return launch_pytest.fixture(describe)


def make_test(fixture: Any) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """See `launch_runner.launch_test`."""
    name = fixture.__name__

    def decorate(body: Callable[..., None]) -> Callable[..., None]:
        @functools.wraps(body)
        def test(**kwargs: Any) -> None:
            run = kwargs[name][1]
            try:
                body(**{**kwargs, name: run})
            finally:
                run.close()
                # pytest shows it if the test has failed.
                print(run.output)

        marked: Callable[..., None] = pytest.mark.launch(fixture=fixture)(test)
        return marked

    return decorate
