# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""An arm in this process, and control loops that move it."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import pytest
from arm_in_process import ArmInProcess
from control_loop_rig import Make

from acts_control.ball import ControlLoop, LoopConfig


@pytest.fixture
def arm() -> ArmInProcess:
    return ArmInProcess()


@pytest.fixture
def make(arm: ArmInProcess) -> Iterator[Make]:
    loops: list[ControlLoop] = []

    def make_one(**settings: Any) -> ControlLoop:
        # Loaded machines: touch may be late here without that being the test's subject.
        defaults: dict[str, Any] = {"connect_retry_s": 0.05, "touch_stale_after_s": 1.0, "touch_stop_after_s": 5.0}
        loop = ControlLoop(LoopConfig(**(defaults | settings)), arm, time.time_ns)
        loops.append(loop)
        loop.launch()
        return loop

    yield make_one
    for loop in loops:
        loop.close()
