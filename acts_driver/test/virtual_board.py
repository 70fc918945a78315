# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The process `virtual_board`, for tests."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from types import TracebackType

from ament_index_python.packages import get_package_prefix
from driver_rig import end_process, read_until


class VirtualBoard:
    """The process and what it said at its start."""

    def __init__(self, link: Path, *options: str) -> None:
        program = Path(get_package_prefix("acts_firmware")) / "lib/acts_firmware/virtual_board"
        command = [str(program), "--link", str(link), "--print-status", *options]
        self.link = link
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.start = json.loads(read_until(self.process, "{"))

    def kill(self) -> None:
        """End it without a chance to tidy up."""
        self.process.kill()
        self.process.communicate()

    def close(self) -> None:
        """End it."""
        if self.process.poll() is None:
            end_process(self.process)

    def __enter__(self) -> VirtualBoard:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()
