# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Commands of bags as processes."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

TIMEOUT_S = 30.0


@contextmanager
def acts(*words: str, domain_id: int) -> Iterator[subprocess.Popen[str]]:
    """An acts command as a process; killed at the end of the block should it still run."""
    process = subprocess.Popen(
        [sys.executable, "-m", "acts_tools", *words],
        env={**os.environ, "ROS_DOMAIN_ID": str(domain_id)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()
