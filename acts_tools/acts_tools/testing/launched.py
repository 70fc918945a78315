# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A launch under test: its description, its interface to tests, and its implementation by `acts launch`."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NoReturn

from acts_tools.testing.probe import Probe

_POLL_S = 0.02
_SHOWN_LINES = 60


@dataclass(frozen=True)
class LaunchFile:
    """The launch file of a test, with its arguments.

    Attributes
    ----------
    package : str
        Package of the launch file, or the path of a launch file.
    file : str or None
        Name of the launch file; None with a path.
    domain_id : int
        ROS domain of its processes; every test has its own.
    arguments : mapping of str to str
        Launch arguments.
    environment : mapping of str to str
        Added to the environment of the processes.
    """

    package: str
    file: str | None = None
    domain_id: int = 0
    arguments: Mapping[str, str] = field(default_factory=dict)
    environment: Mapping[str, str] = field(default_factory=dict)

    def added_environment(self) -> dict[str, str]:
        """Variables of the processes in addition to the environment of the test."""
        return {"ROS_DOMAIN_ID": str(self.domain_id), "PYTHONUNBUFFERED": "1", **self.environment}


class Launched(ABC):
    """A running launch: inspect it, wait for conditions, stop it."""

    def __init__(self, domain_id: int) -> None:
        self._domain_id = domain_id
        self._probe: Probe | None = None

    @property
    @abstractmethod
    def output(self) -> str:
        """All output of its processes and the launch itself so far."""

    @property
    @abstractmethod
    def running(self) -> bool:
        """Whether it is running."""

    @abstractmethod
    def stop(self, timeout_s: float = 30.0) -> int:
        """Stop it like Ctrl-C.

        Returns
        -------
        int
            0 when every process ended in order, 1 when one died (before or while stopping).
        """

    @property
    def probe(self) -> Probe:
        """A node in the launch's ROS domain."""
        if self._probe is None:
            self._probe = Probe(self._domain_id, self._check_running)
        return self._probe

    def wait_for(self, predicate: Callable[[], bool], timeout_s: float = 30.0, what: str = "a condition") -> None:
        """Wait until a condition is true; fail at the deadline, or when the launch has ended."""
        self._wait(predicate, timeout_s, what, while_running=True)

    def _wait(self, predicate: Callable[[], bool], timeout_s: float, what: str, while_running: bool) -> None:
        deadline_s = time.monotonic() + timeout_s
        while not predicate():
            if while_running and not self.running and not predicate():
                self._fail(f"the launch ended while the test waited for {what}")
            if time.monotonic() > deadline_s:
                self._fail(f"waited {timeout_s:g} s in vain for {what}")
            time.sleep(_POLL_S)

    def wait_for_output(self, text: str, timeout_s: float = 30.0) -> None:
        """Wait until a text has been written."""
        self.wait_for(lambda: text in self.output, timeout_s, f"`{text}` in the output")

    def wait_for_node(self, name: str, timeout_s: float = 30.0) -> None:
        """Wait until there is a node with a full name, such as ``/plate/driver``."""
        self._show_on_failure(lambda: self.probe.wait_for_node(name, timeout_s))

    def wait_for_publisher(self, topic: str, timeout_s: float = 30.0) -> None:
        """Wait until a topic has a publisher."""
        self._show_on_failure(lambda: self.probe.wait_for_publisher(topic, timeout_s))

    def wait_for_message(
        self,
        topic: str,
        message_type: type,
        timeout_s: float = 30.0,
        is_wanted: Callable[[Any], bool] = lambda _message: True,
    ) -> Any:
        """The first message on a topic that is wanted, with the quality of service of its publishers."""
        return self._show_on_failure(lambda: self.probe.wait_for_message(topic, message_type, timeout_s, is_wanted))

    def wait_for_messages(self, topic: str, message_type: type, count: int, timeout_s: float = 30.0) -> list[Any]:
        """The first messages on a topic."""
        messages = self._show_on_failure(lambda: self.probe.wait_for_messages(topic, message_type, count, timeout_s))
        assert isinstance(messages, list)
        return messages

    def close(self) -> None:
        """Stop everything that is left."""
        if self._probe is not None:
            self._probe.close()
            self._probe = None

    def _check_running(self) -> None:
        assert self.running, "the launch has ended"

    def _show_on_failure(self, action: Callable[[], Any]) -> Any:
        try:
            return action()
        except AssertionError as error:
            self._fail(str(error))

    def _fail(self, message: str) -> NoReturn:
        tail = "\n".join(self.output.splitlines()[-_SHOWN_LINES:])
        raise AssertionError(f"{message}\n--- end of the launch's output ---\n{tail}")


class ProcessLaunch(Launched):
    """A launch by `acts launch` in a process of its own.

    Parameters
    ----------
    launch_file : LaunchFile
        What to start.
    folder : Path
        Folder for the output.
    """

    def __init__(self, launch_file: LaunchFile, folder: Path) -> None:
        super().__init__(launch_file.domain_id)
        self._output_path = folder / "output.txt"
        words = [word for word in (launch_file.package, launch_file.file) if word is not None]
        words += [f"{name}:={value}" for name, value in launch_file.arguments.items()]
        environment = {"ROS_LOG_DIR": str(folder), **os.environ, **launch_file.added_environment()}
        with self._output_path.open("wb") as output:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "acts_tools", "launch", "--own", *words],
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    @property
    def output(self) -> str:
        """See `Launched`."""
        return self._output_path.read_text(errors="replace")

    @property
    def running(self) -> bool:
        """See `Launched`."""
        return self.process.poll() is None

    def stop(self, timeout_s: float = 30.0) -> int:
        """See `Launched`."""
        if self.running:
            self.process.send_signal(signal.SIGINT)
        return self.wait(timeout_s)

    def wait(self, timeout_s: float = 30.0) -> int:
        """Wait until it has ended by itself, and return its exit code."""
        try:
            return self.process.wait(timeout_s)
        except subprocess.TimeoutExpired:
            self._fail(f"the launch did not end within {timeout_s:g} s")

    def close(self) -> None:
        """See `Launched`."""
        super().close()
        if self.running:
            self.process.send_signal(signal.SIGINT)
            with suppress(subprocess.TimeoutExpired):
                self.process.wait(15.0)
        self.process.kill()  # its processes end with it
        self.process.wait()
