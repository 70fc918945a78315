# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""One controller for a robot, among all the programs of a machine."""

import os
import socket
import subprocess
import sys
import threading

import pytest

from acts_control.robots.base import RobotClaim, RobotTakenError

HOLDER = """
import sys
from acts_control.robots.base import RobotClaim
claim = RobotClaim("127.0.9.1")
print("claimed", flush=True)
sys.stdin.read()
"""


def test_a_second_controller_is_refused_with_the_name_of_the_first_until_that_has_gone() -> None:
    with subprocess.Popen([sys.executable, "-c", HOLDER], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as first:
        assert first.stdout is not None
        assert first.stdout.readline() == b"claimed\n"
        RobotClaim("127.0.9.2").close()
        # Who waits for a claim asks again and again.
        for _ in range(200):
            with pytest.raises(RobotTakenError, match=rf"127.0.9.1 is controlled by process {first.pid} \(.*python"):
                RobotClaim("127.0.9.1")
        first.kill()
        first.wait()
        RobotClaim("127.0.9.1").close()


def test_a_robot_of_two_names_is_one() -> None:
    # Not localhost: a controller that another test has just started may claim the robot of the default settings.
    name, address = "127.0.2308", "127.0.9.4"
    claim = RobotClaim(name)
    with pytest.raises(RobotTakenError):
        RobotClaim(address)
    claim.close()
    RobotClaim(address).close()


def test_what_a_program_that_is_just_starting_still_holds_is_waited_for() -> None:
    claim = RobotClaim("127.0.9.3")
    reads, writes = os.pipe()
    child = os.fork()
    if child == 0:
        # Between fork and exec it has copies of all descriptors.
        os.close(writes)
        os.read(reads, 1)
        os._exit(0)
    claim.close()
    with pytest.raises(OSError, match="in use"), socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as other:
        other.bind(b"\0acts/robot/127.0.9.3")
    begins = threading.Timer(0.1, os.close, (writes,))
    begins.start()
    RobotClaim("127.0.9.3").close()
    begins.join()
    os.waitpid(child, 0)
    os.close(reads)
