# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Output of a launch and its processes to the screen and a log file, in the format of `ros2 launch`."""

from __future__ import annotations

import os
import socket
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from datetime import datetime
from pathlib import Path
from typing import TextIO

from acts_core.errors import LaunchError
from acts_core.files import path_of
from acts_ros.processes.screen import Screen


def make_log_folder() -> Path:
    """Make a folder for the logs of one launch in ``ROS_LOG_DIR``, ``ROS_HOME/log`` or ``~/.ros/log``.

    Raises
    ------
    LaunchError
        It cannot be made.
    """
    base = os.environ.get("ROS_LOG_DIR") or f"{os.environ.get('ROS_HOME') or '~/.ros'}/log"
    name = f"{datetime.now():%Y-%m-%d-%H-%M-%S-%f}-{socket.gethostname()}-{os.getpid()}"
    folder = path_of(base, error=LaunchError) / name
    try:
        folder.mkdir(parents=True)
    except OSError as error:
        raise LaunchError(f"cannot make the log folder {folder}: {error.strerror}. Set ROS_LOG_DIR.") from error
    return folder


class Console:
    """Writes lines to the screen and to ``launch.log``.

    Parameters
    ----------
    folder : Path or None
        Folder of the log file; None: no log file.
    screen : TextIO
        Standard output unless told otherwise.
    """

    def __init__(self, folder: Path | None, screen: TextIO | None = None) -> None:
        self._stream = sys.stdout if screen is None else screen
        self._screen: Screen | None = Screen(self._stream)
        self._log: TextIO | None = None
        if folder is not None:
            # Arguments of a process may be no text at all.
            self._log = (folder / "launch.log").open("a", buffering=1, encoding="utf-8", errors="backslashreplace")
        self.screen_lost = False

    @property
    def is_behind(self) -> bool:
        """Whether lines wait until somebody reads the screen; see `catch_up`."""
        return self._screen is not None and self._screen.is_behind and not self.screen_lost

    def catch_up(self, timeout_s: float = 0.0) -> None:
        """Write lines that wait, as far as the screen is read within a time [s]."""
        self._to_screen(lambda screen: screen.catch_up(timeout_s))

    def close(self) -> None:
        """Close the log file."""
        if self._log is not None:
            with suppress(OSError):
                self._log.close()

    def say(self, level: str, who: str, text: str) -> None:
        """Write a message of the launch itself; `level` is INFO, WARNING or ERROR."""
        self.write(f"[{level}] [{who}]: {text}", to_screen=True, to_log=True)

    def write(self, line: str, to_screen: bool, to_log: bool) -> None:
        """Write one line to the screen, the log file, both or neither."""
        if to_log and self._log is not None:
            try:
                self._log.write(f"{time.time():.7f} {line}\n")
            except OSError as error:
                # What is launched goes on: it may move a robot.
                log, self._log = self._log, None
                with suppress(OSError):
                    log.close()
                self.say("WARNING", "launch", f"{log.name} ends here: {error.strerror}")
        if to_screen:
            self._to_screen(lambda screen: screen.write(line))

    def _to_screen(self, write: Callable[[Screen], None]) -> None:
        if self._screen is None or self.screen_lost:
            return
        try:
            write(self._screen)
        except BrokenPipeError:
            # The reader of our output has ended; the launcher notices and stops its processes in order.
            self.screen_lost = True
        except OSError:
            # A file on a full disk, or a terminal that is gone under nohup: likewise, what is launched goes on, now
            # without a screen. What Python still holds goes nowhere.
            self._screen.close()
            self._screen = None
            with suppress(OSError), Path(os.devnull).open("wb") as nowhere:
                os.dup2(nowhere.fileno(), self._stream.fileno())
