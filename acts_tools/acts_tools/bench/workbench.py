"""What a measurement is given: time, a folder, and word when it is to stop."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

from acts_tools.bags.stopping import StopFlag


@dataclass(frozen=True)
class Workbench:
    """Conditions of one measurement.

    Attributes
    ----------
    seconds : float
        How long to measure [s].
    folder : Path
        An empty folder of its own, in memory, removed afterwards: links to ports, recordings, logs.
    stop : StopFlag
        Set when the user wants to stop.
    """

    seconds: float
    folder: Path
    stop: StopFlag

    def check_stop(self) -> None:
        """Leave by KeyboardInterrupt when the user wants to stop; to be called in every loop."""
        if self.stop.is_set:
            raise KeyboardInterrupt

    def sleep(self, seconds: float) -> None:
        """Wait, or leave by KeyboardInterrupt."""
        if not self.stop.sleep_until(time.monotonic() + seconds):
            raise KeyboardInterrupt
