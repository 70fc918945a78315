# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Ctrl-C while Python itself still starts, or ends: no traceback, and it is not lost.

No node is made, so no ROS_DOMAIN_ID is used.
"""

import os
import shutil
import subprocess
from pathlib import Path
from signal import SIGINT

import pytest
from ament_index_python.packages import get_package_prefix
from waiting import wait_for

pytestmark = pytest.mark.slow

DEADLINE_S = 60.0
CHECKOUT = Path(__file__).resolve().parents[2]
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
    path = Path(f"/proc/{process.pid}/exe")
    wait_for(lambda: "python" in path.resolve().name, "Python", DEADLINE_S, meanwhile=lambda: None)


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


# Python imports it while it starts, before anything of ours.
INTERRUPTING = """
import atexit, os, signal, sys
if {word!r} in ' '.join(sys.orig_argv):
    {interrupt}
"""
AT_START = "os.kill(os.getpid(), signal.SIGINT)"
AT_END = "atexit.register(os.kill, os.getpid(), signal.SIGINT)"
AFTER_IT = "os.kill(os.getppid(), signal.SIGINT)"  # only the shell gets it


@pytest.mark.parametrize(
    ("command", "word", "interrupt", "said"),
    [
        ("acts", "-m acts_tools", AT_START, ""),
        (
            str(CHECKOUT / "acts"),
            "bootstrap.py",
            AT_START,
            "[setup] interrupted; the same command does again what is not finished",
        ),
        (str(CHECKOUT / "acts"), "bootstrap.py", AT_END, ""),
        (str(CHECKOUT / "acts"), "bootstrap.py", AFTER_IT, ""),
    ],
)
def test_the_command_says_nothing_of_python_either(
    tmp_path: Path, command: str, word: str, interrupt: str, said: str
) -> None:
    if subprocess.run(["env", "--block-signal=INT", "true"], capture_output=True, check=False).returncode:
        pytest.skip("`env` knows no --block-signal")
    if word == "bootstrap.py" and shutil.which("ros2"):
        pytest.skip("where ROS is installed, nothing is set up")
    (tmp_path / "sitecustomize.py").write_text(INTERRUPTING.format(word=word, interrupt=interrupt))
    environment = {**os.environ, "PYTHONPATH": f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}"}
    done = subprocess.run([command, "--version"], env=environment, capture_output=True, text=True, timeout=DEADLINE_S)
    assert (done.returncode, done.stdout, done.stderr.strip()) == (130, "", said)
