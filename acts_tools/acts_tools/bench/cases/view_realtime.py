# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The page beside a skin with real-time scheduling; a browser on the same machine then delays no frame."""

from __future__ import annotations

from acts_tools.bench.cases import view
from acts_tools.bench.result import Result
from acts_tools.bench.workbench import Workbench


def measure(workbench: Workbench) -> Result:
    """As `acts_tools.bench.cases.view.measure`, under SCHED_FIFO where that is allowed."""
    return view.measure(workbench, is_realtime=True)
