# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A tone of some kHz on one taxel, from the virtual board to the topic spectra; ROS_DOMAIN_ID 30."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from ament_index_python.packages import get_package_prefix
from peers import Peers
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter

from acts_core.skin import ForceResponse
from acts_msgs.msg import BoardState, Contact, Spectrum
from acts_ros import qos

pytestmark = pytest.mark.slow

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
    listener = Peers(domain_id=30, namespace="/plate")
    listener.timeout_s = 60.0
    contacts = listener.listen(Contact, "contact", qos.STREAM)
    states = listener.listen(BoardState, "board", qos.LATCHED)
    client = listener.peer.create_client(SetParametersAtomically, "driver/set_parameters_atomically")
    try:
        listener.until(lambda: bool(contacts) and client.service_is_ready())
        chosen = {"scheme": "fixed", "m": 50, "fixed_row": ROW, "fixed_col": COL, "fixed_taxels": 1}
        parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in chosen.items()]
        answer = client.call_async(SetParametersAtomically.Request(parameters=parameters))
        listener.until(answer.done)
        assert answer.result().result.successful, answer.result().result.reason
        listener.until(lambda: bool(states) and states[-1].scheme == "fixed")
        assert (states[-1].fixed_row, states[-1].fixed_col, states[-1].fixed_taxels) == (ROW, COL, 1)
        spectra = listener.listen(Spectrum, "spectra", qos.STREAM)
        # On a busy machine frames are lost, and the first stamps jump while the board's clock is learnt.
        listener.until(lambda: any(is_the_tone(one) for one in spectra))
        told = next(one for one in spectra if is_the_tone(one))
        assert told.sample_rate > 40_000
        assert (told.contacts, told.taxels) == (1, 1)
        assert told.step * (len(told.amplitude) - 1) > 20_000
        assert contacts[-1].in_contact
    finally:
        listener.close()
        for process in processes:
            process.kill()
            process.wait()
