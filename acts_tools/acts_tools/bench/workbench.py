# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Resources of a measurement: time, a folder, and a stop flag."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

from acts_tools.running.stopping import StopFlag


@dataclass(frozen=True)
class Workbench:
    """Resources of one measurement.

    Attributes
    ----------
    seconds : float
        Duration of the measurement [s].
    folder : Path
        A temporary folder in memory, for links to ports, recordings and logs.
    stop : StopFlag
        Set when the user wants to stop.
    """

    seconds: float
    folder: Path
    stop: StopFlag

    def check_stop(self) -> None:
        """Raise KeyboardInterrupt if the user wants to stop; to be called in every loop."""
        if self.stop.is_set:
            raise KeyboardInterrupt

    def sleep(self, seconds: float) -> None:
        """Wait; raise KeyboardInterrupt if the user wants to stop."""
        if not self.stop.sleep_until(time.monotonic() + seconds):
            raise KeyboardInterrupt
