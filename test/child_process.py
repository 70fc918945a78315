# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A program beside a test."""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
from types import TracebackType
from typing import TypeVar

P = TypeVar("P", bound="Process")


class Process:
    """A child whose output is kept; stopped with one SIGINT."""

    def __init__(self, *command: str, domain: int | None = None) -> None:
        self._command = command
        self._environment = {**os.environ, "ROS_PYTHON_CHECK_FIELDS": "1"}
        if domain is not None:
            self._environment["ROS_DOMAIN_ID"] = str(domain)
        # A file, not a pipe: nobody reads it while the process runs. Closed at the end of `with`.
        self.output = tempfile.TemporaryFile()  # noqa: SIM115
        self.process = self._start()

    def _start(self) -> subprocess.Popen[str]:
        return subprocess.Popen(
            self._command,
            env=self._environment,
            stdout=self.output,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )

    def text(self) -> str:
        """Everything it has written."""
        # Without a seek: that would move the place where the process goes on to write.
        file = self.output.fileno()
        return os.pread(file, os.fstat(file).st_size, 0).decode()

    def stop(self, number: signal.Signals = signal.SIGINT, timeout_s: float = 20.0) -> int:
        """Signal it once and wait; the exit code."""
        if self.process.poll() is None:
            self.process.send_signal(number)
            # One that a test has made stand still would not get it.
            self.process.send_signal(signal.SIGCONT)
        try:
            return self.process.wait(timeout_s)
        finally:
            if self.process.poll() is None:
                self.process.kill()
                self.process.wait()

    def __enter__(self: P) -> P:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop(signal.SIGTERM)
        if error is not None:
            print(self.text())
        self.output.close()
