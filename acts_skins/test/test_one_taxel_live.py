# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A tone of some kHz on one taxel, from the virtual board to the topic spectra; ROS_DOMAIN_ID 30."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import rclpy
from ament_index_python.packages import get_package_prefix
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from waiting import wait_for

from acts_core.skin import ForceResponse
from acts_msgs.msg import BoardState, Contact, Spectrum
from acts_ros import qos

pytestmark = pytest.mark.slow

DEADLINE_S = 60.0
ROW, COL = 8, 24
TONE_HZ = 3000.0
TONE_N = 0.1
RECORDING_HZ = 300_000.0


def tone_recording(folder: Path) -> Path:
    """One wave of a force on a taxel that is the only pressed one."""
    angle = 2 * np.pi * TONE_HZ / RECORDING_HZ * np.arange(RECORDING_HZ / TONE_HZ)
    frames = np.zeros((angle.size, 32, 32), dtype=np.uint16)
    frames[:, ROW, COL] = np.rint(ForceResponse().counts(0.4 + TONE_N * np.cos(angle)))
    np.save(folder / "tone.npy", frames)
    return folder / "tone.npy"


def is_the_tone(spectrum: Spectrum) -> bool:
    """Whether its largest peak is the recording's."""
    if not spectrum.peak_frequency:
        return False
    error_hz = spectrum.peak_frequency[0] - TONE_HZ
    return abs(error_hz) < 1.0 and bool(spectrum.peak_amplitude[0] == pytest.approx(TONE_N, rel=0.1))


def test_a_tone_of_3_khz_is_told_when_the_board_is_set_to_one_taxel(tmp_path: Path) -> None:
    board = [f"{get_package_prefix('acts_firmware')}/lib/acts_firmware/virtual_board", "--link", f"{tmp_path}/board"]
    board += ["--recording", str(tone_recording(tmp_path)), "--recording-rate-hz", str(RECORDING_HZ), "--loop"]
    skin = [sys.executable, "-m", "acts_ros.executables.program", "acts_skins.tactile"]
    skin += ["--set", f"driver.port={tmp_path}/board", "--set", "reconstruction.spectra_window_s=0.5"]
    environment = {**os.environ, "ROS_DOMAIN_ID": "30"}
    processes = [
        subprocess.Popen(command, env=environment) for command in (board, [*skin, "--ros-args", "-r", "__ns:=/plate"])
    ]
    context = Context()
    rclpy.init(context=context, domain_id=30)
    node = Node("listener", namespace="/plate", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)

    def until(condition: Callable[[], bool]) -> None:
        wait_for(condition, timeout_s=DEADLINE_S, meanwhile=lambda: executor.spin_once(timeout_sec=0.05))

    contacts: list[Contact] = []
    states: list[BoardState] = []
    spectra: list[Spectrum] = []
    node.create_subscription(Contact, "contact", contacts.append, qos.STREAM)
    node.create_subscription(BoardState, "board", states.append, qos.LATCHED)
    client = node.create_client(SetParametersAtomically, "driver/set_parameters_atomically")
    try:
        until(lambda: bool(contacts) and client.service_is_ready())
        chosen = {"scheme": "fixed", "m": 50, "fixed_row": ROW, "fixed_col": COL, "fixed_taxels": 1}
        parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in chosen.items()]
        answer = client.call_async(SetParametersAtomically.Request(parameters=parameters))
        until(answer.done)
        assert answer.result().result.successful, answer.result().result.reason
        until(lambda: states[-1].scheme == "fixed")
        assert (states[-1].fixed_row, states[-1].fixed_col, states[-1].fixed_taxels) == (ROW, COL, 1)
        node.create_subscription(Spectrum, "spectra", spectra.append, qos.STREAM)
        # On a busy machine frames are lost, and the first stamps jump while the board's clock is learnt.
        until(lambda: any(is_the_tone(one) for one in spectra))
        told = next(one for one in spectra if is_the_tone(one))
        assert told.sample_rate > 40_000
        assert (told.contacts, told.taxels) == (1, 1)
        assert told.step * (len(told.amplitude) - 1) > 20_000
        assert contacts[-1].in_contact
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown(context=context)
        for process in processes:
            process.kill()
            process.wait()
