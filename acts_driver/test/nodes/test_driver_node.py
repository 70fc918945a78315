# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node over real DDS: samples, drops, diagnostics, life cycle, parameters. ROS_DOMAIN_IDs 23 and 149."""

from __future__ import annotations

import math
import re
import threading
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import rclpy
from driver_rig import Rig, end_process, intake_of, read_until, start_process
from lifecycle_msgs.msg import Transition
from pty_board import PtyBoard, frame
from rclpy.context import Context
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.lifecycle import node as lifecycle_node

from acts_core.errors import REFUSED_EXIT_CODE
from acts_core.frames import SampleFrame
from acts_core.wire import encode_frame
from acts_driver.nodes import report as report_module
from acts_driver.nodes.driver_node import DriverNode
from acts_msgs.msg import TactileSamples
from acts_ros.qos import STREAM

pytestmark = pytest.mark.slow

NS_PER_S = 1_000_000_000


@pytest.fixture
def board(tmp_path: Path) -> Iterator[PtyBoard]:
    with PtyBoard(tmp_path) as board:
        yield board


@pytest.fixture
def rig() -> Iterator[Rig]:
    rig = Rig(23)
    yield rig
    rig.close()


def stamp_ns(message: object) -> int:
    stamp = message.header.stamp  # type: ignore[attr-defined]
    return int(stamp.sec) * NS_PER_S + int(stamp.nanosec)


def test_frames_become_messages_with_their_contents_in_order(board: PtyBoard, rig: Rig) -> None:
    rig.start_driver(port=board.path, frame_id="plate")
    rig.wait_until_active()
    sent = [frame(k, m=55) for k in range(100)]
    before_ns = time.time_ns()
    for one in sent:
        board.write_frames(one)
    rig.spin_until(lambda: len(rig.samples) == len(sent), "all messages")
    after_ns = time.time_ns()
    for message, one in zip(rig.samples, sent, strict=True):
        assert message.header.frame_id == "plate"
        assert (message.sequence, message.scheme, message.rows, message.cols) == (one.sequence, 3, 32, 32)
        assert (message.duration.sec, message.duration.nanosec) == (0, 973_000)
        np.testing.assert_array_equal(message.indices, one.indices)
        np.testing.assert_array_equal(message.counts, one.counts)
    stamps = [stamp_ns(message) for message in rig.samples]
    assert (np.diff(stamps) > 0).all()
    assert stamps[-1] <= after_ns
    # The board says that the frames are 1 ms apart, however fast they came.
    assert stamps[0] >= before_ns - len(sent) * 1_000_000
    status = rig.status_until(lambda status: status.get("frames") == "100", "the report")
    assert (status["lost"], status["crc_errors"], status["malformed"], status["wrong_size"]) == ("0",) * 4
    assert status["name"] == "plate/driver"
    assert status["port"] == str(board.path)
    for name in ("rate_hz", "overruns", "clock_offset_us", "clock_drift_ppm", "reconnects", "state"):
        assert name in status


def test_bad_frames_are_dropped_alone_and_reported(board: PtyBoard, rig: Rig) -> None:
    rig.start_driver(port=board.path)
    rig.wait_until_active()
    board.write_frames(frame(0))
    rig.spin_until(lambda: rig.samples, "the first message")
    damaged = bytearray(encode_frame(frame(1)))
    damaged[-4] ^= 1
    board.write(bytes(damaged))
    board.write_frames(frame(2), frame(3, rows=16, cols=24), frame(4), frame(7))
    rig.spin_until(lambda: len(rig.samples) == 4, "the good frames")
    assert [message.sequence for message in rig.samples] == [0, 2, 4, 7]
    assert rig.samples[0].header.frame_id == "plate"
    status = rig.status_until(lambda status: status.get("frames") == "5", "the counts")
    assert (status["lost"], status["crc_errors"], status["wrong_size"]) == ("3", "1", "1")


def test_frames_of_many_sizes_do_not_fill_the_log(board: PtyBoard, rig: Rig, capfd: pytest.CaptureFixture[str]) -> None:
    rig.start_driver(port=board.path)
    rig.wait_until_active()
    for k in range(0, 200, 2):
        board.write_frames(frame(k), frame(k + 1, rows=1 + k % 30, cols=24))
    rig.status_until(lambda status: status.get("wrong_size") == "100", "the counts")
    log = capfd.readouterr().err
    told = log.count("they are dropped: set the parameters rows and cols")
    # At first at once, then now and then.
    assert 1 <= told < 10
    # Of whichever of these sizes it is told, it is that one which acts view would need.
    sizes = re.findall(r"the board sends frames of (\d+) x (\d+) taxels, .* \(of acts view: --size \1 \2\)", log)
    assert len(sizes) == told
    assert log.count("a simulated board reads no params file, it needs the launch arguments rows:=32 cols:=32") == told


def test_a_report_names_both_sizes_and_falls_back_to_fine(
    board: PtyBoard, rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    # A busy machine may read them late, which would be told before all else.
    monkeypatch.setattr(report_module, "_LATE_US", math.inf)
    driver = rig.start_driver(port=board.path)
    rig.wait_until_active()
    # Reports are made by hand here: their timer asks at a time of its own.
    driver._diagnostics.destroy()

    def sent_now(sequence: int, rows: int = 32, cols: int = 32) -> SampleFrame:
        # Counted by frames, the board's clock would stand still while a loaded machine makes a pause: read late.
        return frame(sequence, rows=rows, cols=cols, board_us=time.monotonic_ns() // 1000)

    def report(*frames_sent: SampleFrame) -> tuple[int, str]:
        wanted = intake_of(driver)._report.totals().frames + len(frames_sent)
        board.write_frames(*frames_sent)
        rig.spin_until(lambda: intake_of(driver)._report.totals().frames == wanted, "the frames")
        level, message, _ = driver._make_report()
        return level, message

    assert report(sent_now(0), sent_now(1))[0] == 0
    level, message = report(sent_now(2, rows=16, cols=24), sent_now(3))
    assert level == 1
    assert "1 frame of 16 x 24 taxels dropped, expected are 32 x 32" in message
    level, message = report(sent_now(4, rows=16, cols=24))
    assert level == 2
    assert "16 x 24" in message
    level, message = report(sent_now(9))
    assert (level, message) == (1, "4 frames lost")
    assert report(sent_now(10))[0] == 0
    level, message = report()
    assert level == 2
    assert message.startswith("no frames from")


def test_unplugged_and_plugged_in_again(board: PtyBoard, rig: Rig) -> None:
    driver = rig.start_driver(port=board.path, reconnect_s=0.05)
    rig.wait_until_active()
    board.write_frames(frame(0))
    rig.spin_until(lambda: rig.samples, "the first message")
    board.unplug()
    words = ("is not there", "was lost")
    rig.status_until(lambda s: s["level"] == "2" and any(word in s["message"] for word in words), "the loss")
    board.plug_in()
    rig.spin_until(lambda: intake_of(driver).reader.connected, "the port")
    # This board says nothing, and its frames wait until that is certain.
    session = intake_of(driver).session
    assert session is not None
    rig.spin_until(lambda: session.may_publish, "the silence")
    # A board that was without power counts from zero: nothing is lost, and stamps go on.
    board.write_frames(frame(0, board_us=100), frame(1, board_us=1100))
    rig.spin_until(lambda: len(rig.samples) == 3, "messages after the recovery")
    assert stamp_ns(rig.samples[0]) < stamp_ns(rig.samples[1]) < stamp_ns(rig.samples[2])
    status = rig.status_until(lambda status: status.get("reconnects") == "1", "the recovery")
    assert (status["lost"], status["restarts"]) == ("0", "1")


def test_with_autostart_the_driver_waits_for_the_board(tmp_path: Path, rig: Rig) -> None:
    board = PtyBoard(tmp_path)
    driver = rig.start_driver(port=board.path, reconnect_s=0.05)
    status = rig.status_until(lambda status: status["level"] == "2", "the missing port")
    assert "is not there" in status["message"]
    assert status["state"] == "unconfigured"
    rig.wait_for_match()
    with board:
        rig.spin_until(lambda: driver.active, "the port")
        rig.wait_for_verdict()
        assert rig.state() == "active"
        board.write_frames(frame(0))
        rig.spin_until(lambda: rig.samples, "a message")
        driver.close()


def test_a_second_publisher_of_samples_is_told(board: PtyBoard, rig: Rig) -> None:
    rig.start_driver(port=board.path)
    rig.wait_until_active()
    rig.listener.create_publisher(TactileSamples, "samples", STREAM)
    rig.status_until(
        lambda status: (
            "/plate/samples has 2 publishers (/plate/driver, /plate/listener): end all but one" in status["message"]
        ),
        "the warning",
    )


def test_autostart_is_over_once_somebody_else_has_configured_the_driver(
    tmp_path: Path, rig: Rig, capfd: pytest.CaptureFixture[str]
) -> None:
    board = PtyBoard(tmp_path)
    driver = rig.start_driver(port=board.path, reconnect_s=0.5)
    rig.status_until(lambda status: status["level"] == "2", "the missing port")
    with board:
        assert driver.trigger_configure() == TransitionCallbackReturn.SUCCESS
        reports = len(rig.statuses)
        rig.spin_until(lambda: len(rig.statuses) >= reports + 3, "two seconds of reports")
        assert rig.state() == "inactive"
        driver.close()
    assert "Unable to start transition" not in capfd.readouterr().err


def test_life_cycle(board: PtyBoard, rig: Rig) -> None:
    driver = rig.start_driver(port=board.path, autostart=False)
    assert rig.state() == "unconfigured"
    rig.wait_for_match()
    assert rig.change_state(Transition.TRANSITION_CONFIGURE)
    assert rig.state() == "inactive"
    rig.wait_for_verdict()
    # Inactive, the board is read, so that nothing old waits, and nothing is published.
    board.write_frames(frame(0))
    rig.spin_until(lambda: intake_of(driver).stream.statistics.frames == 1, "reading")
    assert rig.change_state(Transition.TRANSITION_ACTIVATE)
    board.write_frames(frame(1))
    rig.spin_until(lambda: rig.samples, "a message")
    assert [message.sequence for message in rig.samples] == [1]
    assert rig.change_state(Transition.TRANSITION_DEACTIVATE)
    board.write_frames(frame(2))
    rig.spin_until(lambda: intake_of(driver).stream.statistics.frames == 3, "reading")
    assert rig.change_state(Transition.TRANSITION_CLEANUP)
    assert rig.state() == "unconfigured"
    assert driver.intake is None
    assert rig.change_state(Transition.TRANSITION_CONFIGURE)
    assert rig.change_state(Transition.TRANSITION_ACTIVATE)
    rig.wait_for_verdict()
    board.write_frames(frame(3))
    rig.spin_until(lambda: len(rig.samples) == 2, "a message of the second life")
    assert [message.sequence for message in rig.samples] == [1, 3]
    assert rig.change_state(Transition.TRANSITION_ACTIVE_SHUTDOWN)
    assert rig.state() == "finalized"
    assert driver.intake is None
    status = rig.status_until(lambda status: status.get("state") == "finalized", "the report of the end")
    assert status["message"] == "shut down: start the driver anew to read"
    assert "shut down: start the driver anew" in rig.query()[1]


def test_without_autostart_a_missing_port_fails_the_configuration(tmp_path: Path, rig: Rig) -> None:
    rig.start_driver(port=tmp_path / "nothing", autostart=False)
    assert not rig.change_state(Transition.TRANSITION_CONFIGURE)
    assert rig.state() == "unconfigured"
    status = rig.status_until(lambda status: status["level"] == "2", "the report")
    assert "nothing is not there" in status["message"]
    # Of another port nothing is known yet.
    assert rig.set_parameters(port=str(tmp_path / "other")) == (True, "")
    status = rig.status_until(lambda status: status["port"].endswith("other"), "the report on the other port")
    assert (status["level"], status["message"]) == ("0", "unconfigured")


def test_a_second_driver_on_the_port_is_told_who_holds_it(board: PtyBoard, rig: Rig) -> None:
    rig.start_driver(port=board.path)
    rig.wait_until_active()
    process = start_process(rig.domain_id, "-p", f"port:={board.path}")
    told = read_until(process, "waiting for") + end_process(process)
    assert "is held by" in told
    assert "stop that program first" in told
    assert process.returncode == 0


def test_the_raster_sketch(board: PtyBoard, rig: Rig) -> None:
    rig.start_driver(port=board.path, protocol="raster_ascii", rows=2, cols=3)
    rig.wait_until_active()
    before_ns = time.time_ns()
    board.write(b"9,120\r\n1,2,3,4,5,1023,120\r\n6,5,4,3,2,0,121\r\n")
    rig.spin_until(lambda: len(rig.samples) == 2, "two scans")
    assert [list(message.counts) for message in rig.samples] == [[1, 2, 3, 4, 5, 1023], [6, 5, 4, 3, 2, 0]]
    assert [message.scheme for message in rig.samples] == [4, 4]
    assert before_ns < stamp_ns(rig.samples[0]) < stamp_ns(rig.samples[1]) <= time.time_ns()


def test_a_driver_that_gets_nothing_it_can_use_says_so_and_why(board: PtyBoard) -> None:
    # A sketch that prints all values, but not how long they took.
    line, ended = [b"1,2,3,4,5,1023\r\n"], threading.Event()

    def send() -> None:
        while not ended.wait(0.02):
            board.write(line[0])

    words = [f"port:={board.path}", "protocol:=raster_ascii", "rows:=2", "cols:=3"]
    process = start_process(149, *(part for word in words for part in ("-p", word)))
    sender = threading.Thread(target=send, daemon=True)
    sender.start()
    told = read_until(process, "no frames from").splitlines()[-1]
    assert "[ERROR]" in told
    assert "malformed packets, last: " in told
    line[0] = b"1,2,3,4,5,1023,120\r\n"
    read_until(process, "frames again: ")
    ended.set()
    sender.join()
    end_process(process)


@pytest.mark.parametrize(
    ("argument", "words"),
    [
        ("speed:=3", ["parameters of /plate/driver", "'speed'"]),
        ("rows:=65", ["rows = 65", "1 to 64"]),
        ("protocol:=morse", ["protocol = 'morse'", "binary, raster_ascii"]),
        ("port:=7", ["port = 7", "text"]),
    ],
)
def test_a_wrong_parameter_ends_the_process_with_the_reason(argument: str, words: list[str], rig: Rig) -> None:
    process = start_process(rig.domain_id, "-p", argument)
    output, _ = process.communicate(timeout=30)
    assert process.returncode == REFUSED_EXIT_CODE
    for word in ["error: ", *words]:
        assert word in output


def test_a_destroyed_driver_leaves_the_graph_at_once(board: PtyBoard, rig: Rig) -> None:
    watching = Rig(23)
    driver = rig.start_driver(port=board.path)
    service = "/plate/driver/change_state"
    watching.spin_until(lambda: watching.listener.count_services(service) == 1, "the driver")
    driver.close()
    driver.destroy_node()
    rig.driver = None
    # While the object is still there: nothing is left to the garbage collector.
    watching.spin_until(lambda: watching.listener.count_services(service) == 0, "the end of the driver")
    assert not driver.active
    watching.close()


def test_a_driver_whose_making_a_signal_breaks_off_is_destroyed_as_any_other(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    half_made: list[DriverNode] = []

    class Driver(DriverNode):
        def __new__(cls, **_: object) -> Driver:
            half_made.append(super().__new__(cls))
            return half_made[0]

    monkeypatch.setattr(lifecycle_node._rclpy, "LifecycleStateMachine", interrupt)
    context = Context()
    rclpy.init(args=[], context=context, domain_id=23)
    with pytest.raises(KeyboardInterrupt):
        Driver(context=context)
    assert list(half_made[0].publishers)
    # As it ends, ROS destroys the nodes that it knows; before Kilted, it knows none.
    if not hasattr(context, "track_node"):
        half_made[0].destroy_node()
    rclpy.try_shutdown(context=context)
    assert not list(half_made[0].publishers)
    assert not context.ok()


def test_quality_of_service_can_be_overridden(board: PtyBoard, rig: Rig) -> None:
    driver = rig.start_driver(port=board.path, **{"qos_overrides./plate/samples.publisher.depth": 17})
    assert driver._publisher.qos_profile.depth == 17


def test_a_node_of_the_same_process_gets_frames_and_what_fails_in_it_keeps_nothing_back(
    board: PtyBoard, rig: Rig
) -> None:
    driver = rig.start_driver(port=board.path, frame_id="plate")
    taken: list[tuple[list[int], str]] = []

    def consume(frames: list, frame_id: str) -> None:
        taken.append(([one.sequence for one, _ in frames], frame_id))
        if taken[-1][0] == [1]:
            raise ZeroDivisionError("by mistake")

    driver.consumers.append(consume)
    rig.wait_until_active()

    def has_come(number: int) -> bool:
        return len(rig.samples) == number + 1

    for number in range(3):
        board.write_frames(frame(number, m=55))
        rig.spin_until(partial(has_come, number), "the message")
    # A board may have sent results without a frame.
    driver._publish([], [])
    assert taken == [([0], "plate"), ([1], "plate"), ([2], "plate")]
    rig.status_until(lambda status: status.get("consumer_errors") == "1", "the failure in the diagnostics")
