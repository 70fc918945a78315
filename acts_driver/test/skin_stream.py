# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A board that sends full frames, and a driver on it that is asked to calibrate and to tare."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from driver_rig import Rig
from pty_board import PtyBoard
from std_srvs.srv import Trigger

from acts_core.frames import SampleFrame, Scheme
from acts_msgs.msg import Baseline
from acts_ros.qos import LATCHED

ROWS, COLS = 8, 6
SIZE = ROWS * COLS
FRAME_S = 0.01


class Stream(threading.Thread):
    """A board that sends 100 full frames a second of what `field` says."""

    def __init__(self, board: PtyBoard) -> None:
        super().__init__(daemon=True)
        self.field = np.full(SIZE, 25, dtype=np.uint16)
        self.frame_s = FRAME_S
        self.sent = 0
        self.board = board
        self.ended = threading.Event()

    def run(self) -> None:
        indices = np.arange(SIZE, dtype=np.uint16)
        while not self.ended.wait(self.frame_s):
            sequence, counts = self.sent, self.field + np.uint16(self.sent % 2)
            # Counted by frames, the clock of a loaded machine's board would run slow, and be set anew again and again.
            board_us = time.monotonic_ns() // 1000
            self.board.write_frames(SampleFrame(sequence, board_us, 900, Scheme.RASTER, ROWS, COLS, 0, indices, counts))
            self.sent += 1


def ask(rig: Rig, name: str) -> Trigger.Response:
    client = rig.listener.create_client(Trigger, f"driver/{name}")
    rig.spin_until(client.service_is_ready, "the service")
    future = client.call_async(Trigger.Request())
    rig.spin_until(future.done, "the answer")
    rig.listener.destroy_client(client)
    return future.result()


def ask_until(rig: Rig, name: str, condition: Callable[[Trigger.Response], bool], what: str) -> Trigger.Response:
    """Ask some times a second until the answer is as it should be; that answer."""
    due_s = 0.0
    answers: list[Trigger.Response] = []

    def answered() -> bool:
        nonlocal due_s
        if time.monotonic() < due_s:
            return False
        answers.append(ask(rig, name))
        due_s = time.monotonic() + 0.1
        return condition(answers[-1])

    rig.spin_until(answered, what)
    return answers[-1]


def ask_with_frames(rig: Rig, name: str) -> Trigger.Response:
    """Ask until there are frames enough: their time is counted anew after this machine stood still."""
    return ask_until(rig, name, lambda answer: "s of frames so far" not in answer.message, "frames enough")


def calibrate(rig: Rig) -> None:
    ask_until(rig, "calibrate", lambda answer: bool(answer.success), "a calibration")


def start(rig: Rig, stream: Stream, path: Path, **more: object) -> list[Baseline]:
    """A driver on the stream; what it publishes on `baseline`."""
    rig.start_driver(port=stream.board.path, rows=ROWS, cols=COLS, frame_id="plate", calibration_file=path, **more)
    baselines: list[Baseline] = []
    rig.listener.create_subscription(Baseline, "baseline", baselines.append, LATCHED)
    return baselines


def await_baseline(rig: Rig, baselines: list[Baseline]) -> Baseline:
    """The newest, once there is one."""
    rig.spin_until(lambda: bool(baselines) and baselines[-1].source != Baseline.SOURCE_NONE, "the baseline")
    return baselines[-1]


def start_calibrated(rig: Rig, stream: Stream, path: Path) -> None:
    """A driver on the stream, which flows, and a calibration of it."""
    start(rig, stream, path)
    stream.start()
    calibrate(rig)


def close_port(rig: Rig) -> None:
    assert rig.driver is not None
    rig.driver.trigger_deactivate()
    rig.driver.trigger_cleanup()


def open_port(rig: Rig) -> None:
    assert rig.driver is not None
    rig.driver.trigger_configure()
    rig.driver.trigger_activate()
