# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A second launch of what is in use ends as a whole, and the first goes on. ROS_DOMAIN_ID 178."""

import socket
from pathlib import Path
from typing import Any

from launch_support import PACKAGE, START_S, pid_of

from acts_tools.testing.launch_runner import launched


def test_a_second_launch_in_the_same_run_dir_is_refused_and_leaves_the_first_alone(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    board, file = folder / "board", "simulated_board.launch.xml"
    with launched(PACKAGE, file, domain_id=178, run_dir=str(folder)) as first:
        first.wait_for(board.is_symlink, START_S, "the board's link")
        port = board.readlink()
        with launched(PACKAGE, "tactile.launch.xml", domain_id=178, run_dir=str(folder)) as second:
            assert second.wait(START_S) == 1
            assert "virtual_board-1 refuses what it was given" in second.output
            assert f"{board} is in use by process {pid_of(first, 'virtual_board')} (" in second.output
            assert "run_dir:=" in second.output
        assert board.readlink() == port
        assert first.stop() == 0
    assert list(folder.iterdir()) == []


def test_a_second_simulated_robot_at_an_address_ends_its_launch(tmp_path: Path) -> None:
    address = "127.0.178.1"
    with socket.create_server((address, 30004)):
        arguments: dict[str, Any] = {"run_dir": str(tmp_path / "run"), "robot_ip": address}
        with launched(PACKAGE, "simulated_robot.launch.xml", domain_id=178, **arguments) as second:
            assert second.wait(START_S) == 1
            assert f"cannot listen on {address} port 30004" in second.output
            assert "ur_controller-1 refuses what it was given" in second.output
