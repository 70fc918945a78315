# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The driver node and its board: parameters, topic `board`, the query service, resets; with a real virtual board.

ROS_DOMAIN_ID 36.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from driver_rig import Rig, intake_of
from lifecycle_msgs.msg import Transition
from pty_board import PtyBoard, frame
from virtual_board import VirtualBoard

from acts_msgs.msg import BoardState
from acts_ros.qos import LATCHED

pytestmark = pytest.mark.slow

# A busy machine keeps up with it, or the driver's reports would tell that it does not.
SLOW = ("--rate-hz", "100")


class BoardRig(Rig):
    """A rig that also listens to `board`."""

    def __init__(self) -> None:
        super().__init__(36)
        self.boards: list[BoardState] = []

    def listen_to_board(self) -> None:
        self.listener.create_subscription(BoardState, "board", self.boards.append, LATCHED)

    def wait_for_size(self, m: int) -> None:
        self.spin_until(lambda: self.samples and len(self.samples[-1].indices) == m, f"frames of {m}")


@pytest.fixture
def rig() -> Iterator[BoardRig]:
    rig = BoardRig()
    yield rig
    rig.close()


@pytest.fixture
def board(tmp_path: Path) -> Iterator[VirtualBoard]:
    with VirtualBoard(tmp_path / "board", "--board-id", "77", *SLOW) as board:
        yield board


def test_parameters_become_settings_of_the_board(board: VirtualBoard, rig: BoardRig, tmp_path: Path) -> None:
    np.savez(tmp_path / "d.npz", atoms=np.eye(64))
    rig.start_driver(port=board.link, scheme="tracking", m=100)
    rig.wait_for_size(100)
    # A late joiner gets the last state.
    rig.listen_to_board()
    rig.spin_until(lambda: rig.boards and rig.boards[-1].m == 100, "the board's state")
    message = rig.boards[-1]
    assert (message.answers, message.problem, message.board_id) == (True, "", 77)
    assert (message.scheme, message.rows, message.firmware_version) == ("tracking", 32, "0.1.0")
    assert message.header.frame_id == "plate"
    status = rig.status_until(lambda status: status.get("board") == "77", "the report")
    assert "tracking, M = 100" in status["board_settings"]

    assert rig.set_parameters(m=128) == (True, "")
    rig.wait_for_size(128)
    succeeded, reason = rig.set_parameters(scheme="uniform", m=57)
    assert not succeeded
    assert "no uniform grid of 32 x 32" in reason
    assert rig.set_parameters(m=5000)[0] is False
    assert rig.set_parameters(port="elsewhere")[0] is False
    assert rig.set_parameters(scheme="uniform", m=64, model=str(tmp_path / "d.npz"), output="image") == (True, "")
    rig.spin_until(lambda: rig.boards[-1].model == "patch_dictionary", "the model")
    assert (rig.boards[-1].output, rig.boards[-1].samples_only, rig.boards[-1].m) == ("image", False, 64)
    succeeded, text = rig.query()
    assert succeeded
    for words in ("board 77", "firmware 0.1.0", "uniform, M = 64", "patch_dictionary"):
        assert words in text
    # A report during which the machine was busy says so instead.
    rig.spin_until(lambda: "frames/s, active" in rig.query()[1], "a report without trouble")


def test_the_port_changes_only_while_nothing_is_read(board: VirtualBoard, rig: BoardRig, tmp_path: Path) -> None:
    driver = rig.start_driver(port=board.link)
    rig.listen_to_board()
    rig.wait_until_active()
    with VirtualBoard(tmp_path / "other", "--board-id", "78", "--rows", "16", *SLOW) as other:
        succeeded, reason = rig.set_parameters(port=str(other.link), rows=16)
        assert not succeeded
        assert reason.startswith("port can be changed only while /plate/driver is unconfigured")
        assert rig.change_state(Transition.TRANSITION_DEACTIVATE)
        assert rig.set_parameters(rows=16)[0] is False
        assert rig.change_state(Transition.TRANSITION_CLEANUP)
        rig.spin_until(lambda: rig.boards and not rig.boards[-1].answers, "word that no board is known now")
        succeeded, reason = rig.query()
        assert (succeeded, "not configured: nothing is read" in reason) == (False, True)
        # As at the start, what cannot be is refused: this file holds no baseline.
        (tmp_path / "no.npz").write_text("nothing")
        succeeded, reason = rig.set_parameters(calibration_file=str(tmp_path / "no.npz"))
        assert (succeeded, "no.npz" in reason) == (False, True), reason
        assert rig.set_parameters(port=str(other.link), rows=16) == (True, "")
        assert rig.change_state(Transition.TRANSITION_CONFIGURE)
        assert rig.change_state(Transition.TRANSITION_ACTIVATE)
        rig.samples.clear()
        rig.spin_until(lambda: rig.samples and rig.samples[-1].rows == 16, "frames of the other board")
        rig.status_until(lambda status: status.get("board") == "78" and status["level"] == "0", "a good report")
        driver.close()


def test_a_query_tells_that_no_usable_frames_come(rig: BoardRig, tmp_path: Path) -> None:
    with PtyBoard(tmp_path) as board:
        driver = rig.start_driver(port=board.path, protocol="raster_ascii", rows=2, cols=3)
        rig.wait_until_active()
        answers: list[tuple[bool, str]] = []

        def is_told() -> bool:
            # Of those of the last report: after it, without more of them, there is nothing any more.
            board.write(b"1,2,3,4,5,6\n" * 20)
            answers.append(rig.query())
            return "malformed packets, last: " in answers[-1][1]

        rig.spin_until(is_told, "the report")
        succeeded, reason = answers[-1]
        assert not succeeded
        assert "no frames from" in reason
        driver.close()


def test_a_board_that_forgot_is_told_again(board: VirtualBoard, rig: BoardRig) -> None:
    driver = rig.start_driver(port=board.link, m=64, reconnect_s=0.05)
    rig.wait_for_size(64)
    board.kill()
    rig.spin_until(lambda: not intake_of(driver).reader.connected, "the loss")
    # A wish is noted while there is no board.
    assert rig.set_parameters(m=80) == (True, "")
    with VirtualBoard(board.link):
        rig.wait_for_size(80)


def test_a_size_unlike_the_parameters_is_an_error(board: VirtualBoard, rig: BoardRig) -> None:
    rig.start_driver(port=board.link, rows=16)
    status = rig.status_until(lambda status: "say 16 x 32" in status["message"], "the report")
    assert status["level"] == "2"
    assert "the board measures 32 x 32 taxels" in status["message"]


def test_a_silent_board_is_heard_all_the_same(rig: BoardRig, tmp_path: Path) -> None:
    with PtyBoard(tmp_path) as board:
        driver = rig.start_driver(port=board.path, m=64)
        rig.wait_until_active()
        board.write_frames(frame(0))
        rig.spin_until(lambda: rig.samples, "a message")
        status = rig.status_until(lambda status: status.get("board") == "does not answer", "the report")
        # Something was asked of it, so it matters.
        assert int(status["level"]) >= 1
        succeeded, reason = rig.set_parameters(m=32)
        assert not succeeded
        assert "does not answer" in reason
        assert rig.query()[0] is False
        driver.close()


def test_the_raster_sketch_takes_no_settings(rig: BoardRig, tmp_path: Path) -> None:
    with PtyBoard(tmp_path) as board:
        driver = rig.start_driver(port=board.path, protocol="raster_ascii", rows=2, cols=3)
        rig.wait_until_active()
        succeeded, reason = rig.set_parameters(m=32)
        assert not succeeded
        assert "binary protocol" in reason
        driver.close()
