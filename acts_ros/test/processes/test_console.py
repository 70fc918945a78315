# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where the output of a launch goes: the log's folder, a disk that is full, and a terminal that is gone."""

from __future__ import annotations

import errno
import io
import os
import pty
from pathlib import Path

import pytest

from acts_core.errors import LaunchError
from acts_ros.processes.console import Console, make_log_folder


def test_a_log_folder_of_somebody_who_is_not_there_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_LOG_DIR", "~nosuchperson/log")
    with pytest.raises(LaunchError, match="~nosuchperson/log: "):
        make_log_folder()


class Full(io.StringIO):
    """A file on a disk that becomes full."""

    name = "launch.log"

    def write(self, text: str) -> int:
        if self.tell() > 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        return super().write(text)


def test_on_a_full_disk_the_output_goes_on_without_the_log_and_the_launch_without_output() -> None:
    screen = io.StringIO()
    console = Console(None, screen)
    console._log = Full()
    for text in ("one", "two", "three"):
        console.say("INFO", "it", text)
    console.close()
    end = "[WARNING] [launch]: launch.log ends here: No space left on device"
    assert screen.getvalue().splitlines() == ["[INFO] [it]: one", end, "[INFO] [it]: two", "[INFO] [it]: three"]
    full = Console(None, Full())
    for text in ("one", "two", "three"):
        full.say("INFO", "it", text)
    assert not full.screen_lost


def test_a_terminal_that_is_gone_is_given_up_once_and_takes_no_files() -> None:
    # As after the end of a remote session under nohup: each write to it fails.
    master, slave = pty.openpty()
    with os.fdopen(slave, "w") as stream:
        before = len(list(Path("/proc/self/fd").iterdir()))
        console = Console(None, stream)
        os.close(master)
        for number in range(100):
            console.say("INFO", "it", f"line {number}")
        assert len(list(Path("/proc/self/fd").iterdir())) == before - 1
        assert not console.is_behind
        assert not console.screen_lost
        assert os.fstat(stream.fileno()).st_rdev == Path(os.devnull).stat().st_rdev
