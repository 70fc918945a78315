# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A second launch in a folder that is in use is refused, and the first goes on. ROS_DOMAIN_ID 178."""

from pathlib import Path

from launch_support import PACKAGE, START_S, pid_of

from acts_tools.testing.launch_runner import launched


def test_a_second_launch_in_the_same_run_dir_is_refused_and_leaves_the_first_alone(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    board, file = folder / "board", "simulated_board.launch.xml"
    with launched(PACKAGE, file, domain_id=178, run_dir=str(folder)) as first:
        first.wait_for(board.is_symlink, START_S, "the board's link")
        port = board.readlink()
        with launched(PACKAGE, file, domain_id=178, run_dir=str(folder)) as second:
            assert second.wait(START_S) == 1
            assert f"{board} is in use by process {pid_of(first, 'virtual_board')} (" in second.output
            assert "run_dir:=" in second.output
        assert board.readlink() == port
        assert first.stop() == 0
    assert list(folder.iterdir()) == []
