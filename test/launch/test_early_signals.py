# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Ctrl-C while Python itself still starts: no traceback, exit code 0. No node is made, so no ROS_DOMAIN_ID is used."""

import subprocess
import time
from pathlib import Path
from signal import SIGINT

import pytest
from ament_index_python.packages import get_package_prefix

pytestmark = pytest.mark.slow

DEADLINE_S = 60.0
PROGRAMS = [
    ("acts_control", "ball_balancing"),
    ("acts_driver", "driver"),
    ("acts_sim", "ball_world"),
    ("acts_sim", "ur_controller"),
    ("acts_skins", "tactile"),
    ("acts_view", "view"),
]


def wait_for_python(process: subprocess.Popen[str]) -> None:
    """Until `env` has become Python, whose own handlers are not there yet, or have just been made."""
    deadline_s = time.monotonic() + DEADLINE_S
    while "python" not in Path(f"/proc/{process.pid}/exe").resolve().name:
        assert time.monotonic() < deadline_s


@pytest.mark.parametrize(("package", "name"), PROGRAMS)
def test_a_signal_before_any_module_of_ours_is_an_orderly_end(package: str, name: str) -> None:
    program = Path(get_package_prefix(package)) / "lib" / package / name
    if "--block-signal" not in program.read_text().partition("\n")[0]:
        pytest.skip(f"{program}: installed without scripts/bootstrap.py, or `env` knows no --block-signal")
    with subprocess.Popen([program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        wait_for_python(process)
        process.send_signal(SIGINT)
        output, errors = process.communicate(timeout=DEADLINE_S)
    assert (process.returncode, output, errors) == (0, "", "")
