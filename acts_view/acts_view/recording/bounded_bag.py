# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A bag that takes no more than so much, and tells instead of raising: who writes are callbacks and readers."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

from acts_core.errors import RecordingError
from acts_ros.bags.writing import BagWriter


class BoundedBag(BagWriter):
    """See `BagWriter`; to be written from one thread, and flushed and closed from another.

    Parameters
    ----------
    path : Path
        Folder to make; it must not exist.
    bytes_max : int
        Of the messages together; their headers come to some tens of bytes each.
    """

    def __init__(self, path: Path, bytes_max: int) -> None:
        super().__init__(path, "acts view")
        self._bytes_max = bytes_max
        self._lock = threading.Lock()
        self.messages = 0
        """How many have been written."""
        self.written_bytes = 0
        self.problem = ""
        """Why nothing is written any more; empty where all is well."""

    def write(self, topic: Any, data: bytes) -> None:
        """As `BagWriter.write`, while there is no problem."""
        with self._lock:
            if self.problem:
                return
            if self.written_bytes + len(data) > self._bytes_max:
                self.problem = f"it has the {self._bytes_max / 1e6:g} MB that are allowed (parameter record_max_mb)"
                return
            try:
                super().write(topic, data)
            except RecordingError as error:
                self.problem = str(error)
                return
            self.messages += 1
            self.written_bytes += len(data)

    def flush(self) -> None:
        """As `BagWriter.flush`."""
        with self._lock:
            super().flush()

    def close(self) -> None:
        """As `BagWriter.close`; what an executor or a reader still brings is not written."""
        with self._lock:
            self.problem = self.problem or "it is closed"
            super().close()
