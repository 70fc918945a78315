# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Driver and reconstruction in one process, with the virtual board; ROS_DOMAIN_IDs 130 to 132."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from ament_index_python.packages import get_package_prefix
from diagnostic_msgs.msg import DiagnosticArray
from peers import Peers
from pressed_frames import disc_recording
from waiting import wait_for

from acts_core.array import ArrayGeometry
from acts_core.errors import REFUSED_EXIT_CODE
from acts_msgs.msg import Contact, TactileSamples
from acts_ros import qos

pytestmark = pytest.mark.slow

DEADLINE_S = 90.0


@contextmanager
def running(*command: str, domain_id: int) -> Iterator[subprocess.Popen[str]]:
    environment = {**os.environ, "ROS_DOMAIN_ID": str(domain_id), "ROS_PYTHON_CHECK_FIELDS": "1"}
    with subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    ) as process:
        try:
            yield process
        finally:
            process.kill()


@contextmanager
def pressed_board(folder: Path, domain_id: int) -> Iterator[Path]:
    """A board that sees a disc of 21 taxels around row 8, column 24."""
    link = folder / "board"
    words = [
        "--link",
        str(link),
        "--recording",
        str(disc_recording(folder)),
        "--loop",
        "--scheme",
        "tracking",
        "--m",
        "55",
    ]
    program = f"{get_package_prefix('acts_firmware')}/lib/acts_firmware/virtual_board"
    with running(program, *words, domain_id=domain_id):
        wait_for(lambda: os.path.lexists(link), "the board")
        yield link


class Listener(Peers):
    """What comes out of the process."""

    timeout_s = DEADLINE_S


@pytest.fixture
def listener(request: pytest.FixtureRequest) -> Iterator[Listener]:
    made = Listener(request.param, namespace="/plate")
    yield made
    made.close()


def tactile(link: Path, *words: str) -> list[str]:
    program = [
        sys.executable,
        "-m",
        "acts_ros.executables.program",
        "acts_skins.tactile",
        "--set",
        f"driver.port={link}",
    ]
    return [*program, *words, "--ros-args", "-r", "__ns:=/plate"]


@pytest.mark.parametrize("listener", [130], indirect=True)
def test_contacts_come_without_samples_being_sent_and_samples_for_those_who_ask(
    listener: Listener, tmp_path: Path
) -> None:
    geometry = ArrayGeometry()
    with pressed_board(tmp_path, 130) as link, running(*tactile(link), domain_id=130) as process:
        contacts = listener.listen(Contact, "contact", qos.STREAM)
        statuses = listener.listen(DiagnosticArray, "/diagnostics", 10)
        listener.until(lambda: len(contacts) > 200)
        contact = contacts[-1]
        assert contact.in_contact
        assert contact.header.frame_id == "plate"
        assert contact.centre_of_pressure.x == pytest.approx(float(geometry.x_m(24)), abs=geometry.pitch_m / 4)
        assert contact.centre_of_pressure.y == pytest.approx(float(geometry.y_m(8)), abs=geometry.pitch_m / 4)
        stamps = [message.header.stamp.sec * 10**9 + message.header.stamp.nanosec for message in contacts]
        assert all(np.diff(stamps) > 0)
        samples = listener.listen(TactileSamples, "samples", qos.STREAM)

        def common() -> list[TactileSamples]:
            known = {message.sequence for message in contacts}
            return [message for message in samples if message.sequence in known]

        # The same frames: each contact is of the samples with its number and stamp.
        listener.until(lambda: len(samples) > 50 and bool(common()))
        by_sequence = {message.sequence: message for message in contacts}
        assert all(message.header.stamp == by_sequence[message.sequence].header.stamp for message in common())
        names = {"plate/driver", "plate/reconstruction"}
        listener.until(lambda: names <= {status.name for message in statuses for status in message.status})
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=DEADLINE_S)
    assert process.returncode == 0, output
    assert "Traceback" not in output
    assert "FATAL" not in output


@pytest.mark.parametrize("listener", [131], indirect=True)
def test_frames_that_the_reconstruction_cannot_use_do_not_stop_the_driver(listener: Listener, tmp_path: Path) -> None:
    words = ["--set", "reconstruction.rows=16", "--set", "reconstruction.cols=16"]
    with pressed_board(tmp_path, 131) as link, running(*tactile(link, *words), domain_id=131) as process:
        statuses = listener.listen(DiagnosticArray, "/diagnostics", 10)

        def told() -> bool:
            found = {status.name: status for message in statuses for status in message.status}
            recon, driver = found.get("plate/reconstruction"), found.get("plate/driver")
            if recon is None or driver is None:
                return False
            return "messages dropped" in recon.message and "frames/s" in driver.message

        listener.until(told)
        process.send_signal(signal.SIGTERM)
        assert process.wait(DEADLINE_S) == 0


def test_a_wrong_parameter_is_told_in_one_line() -> None:
    with running(*tactile(Path("/dev/null"), "--set", "driver.prot=x"), domain_id=132) as process:
        output, _ = process.communicate(timeout=DEADLINE_S)
    assert process.returncode == REFUSED_EXIT_CODE
    assert output == "error: parameters of driver: unknown key 'prot'; did you mean 'port'?\n"
