# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The nodes over DDS: ball_state and ball_trajectory in this process, parameters refused in processes of their own.

ROS_DOMAIN_IDs 60 to 63.
"""

import itertools
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from arm_in_process import ArmInProcess
from child_process import Process
from control_rig import Bench, node_command
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Vector3Stamped
from waiting import wait_for

from acts_control.ball import LoopStatus, Phase
from acts_control.ball.nodes.ball_control_node import BallControlNode
from acts_control.ball.nodes.ball_state_node import BallStateNode
from acts_control.ball.nodes.ball_trajectory_node import BallTrajectoryNode
from acts_core.errors import REFUSED_EXIT_CODE
from acts_core.runtime import StreamCounter
from acts_msgs.msg import BalanceStatus, BallReference, BallState
from acts_ros.diagnostics import WARN
from acts_ros.messages import set_stamp
from acts_ros.qos import STATE, STREAM

pytestmark = pytest.mark.slow

MS = 1_000_000
# What the bench subscribes to of ball_state.
HEARD = ("/plate/ball/state", "/plate/contact_statistics")


@pytest.fixture
def bench(request: pytest.FixtureRequest) -> Iterator[Bench]:
    with Bench(request.param) as bench:
        yield bench


def start_state_node(bench: Bench, *parameters: str) -> BallStateNode:
    arguments = [word for parameter in parameters for word in ("-p", parameter)]
    node = BallStateNode(context=bench.context, namespace="/plate", cli_args=["--ros-args", *arguments])
    bench.add(node)
    bench.start()
    wait_for(lambda: bench.contacts.get_subscription_count() == 1, "the node's subscription")
    # Matched, not only known to the graph: what is published before is lost for good.
    heard = [publisher for publisher in node.publishers if publisher.topic_name in HEARD]
    assert len(heard) == len(HEARD)
    wait_for(lambda: all(publisher.get_subscription_count() == 1 for publisher in heard), "the subscriptions to it")
    return node


def publish_contacts(bench: Bench, sequences: list[int], age_ms: float = 20.0) -> int:
    """Contacts a millisecond apart, the last one `age_ms` old; in handfuls, so that no queue runs over.

    The stamp that would follow is returned [ns].
    """

    def received(count: int) -> bool:
        return bool(bench.states) and bench.states[-1].contacts_received > count

    first_ns = bench.now_ns() - round((age_ms + len(sequences)) * MS)
    for k, sequence in enumerate(sequences):
        bench.publish_contact(sequence, first_ns + k * MS, 0.01, -0.02)
        if k % 25 == 24:
            wait_for(partial(received, k - 10), "the queue to empty")
    return first_ns + len(sequences) * MS


@pytest.mark.parametrize("bench", [60], indirect=True)
def test_state_counts_and_latencies_of_a_thousand_contacts(bench: Bench) -> None:
    start_state_node(bench)
    # Wraps at 2^32; three are missing, then ten.
    sequences = [
        s % 2**32 for s in range(2**32 - 500, 2**32 + 513) if s not in (2**32, *range(2**32 + 100, 2**32 + 112))
    ]
    publish_contacts(bench, sequences)
    wait_for(lambda: bool(bench.statistics) and bench.statistics[-1].received == 1000, "the statistics")
    last = bench.statistics[-1]
    assert (last.lost, last.topic, last.receiver) == (13, "/plate/contact", "/plate/ball_state")
    latencies = np.concatenate([message.latencies for message in bench.statistics])
    assert len(latencies) == 1000
    assert latencies.min() > 0.015
    # 1000 ms of contacts at 250 Hz.
    wait_for(lambda: bench.states[-1].contacts_received >= 996, "the last state")
    assert 240 <= len(bench.states) <= 260
    state = bench.states[-1]
    assert state.valid
    assert (state.position.x, state.position.y) == pytest.approx((0.01, -0.02), abs=1e-6)
    assert (state.velocity.x, state.velocity.y) == pytest.approx((0.0, 0.0), abs=1e-6)
    assert 0.0 < state.position_sigma < 0.001
    assert state.header.frame_id == "plate"


@pytest.mark.parametrize("bench", [61], indirect=True)
def test_state_uses_the_tilt_and_tells_when_the_ball_is_gone(bench: Bench) -> None:
    start_state_node(bench, "lost_after_s:=1.0", "publish_rate_hz:=1000.0", "lever_arm_m:=0.155")
    tilts = bench.node.create_publisher(Vector3Stamped, "ball/tilt", STREAM)
    wait_for(lambda: tilts.get_subscription_count() == 1, "the node's subscription")
    next_ns = publish_contacts(bench, list(range(100)))
    wait_for(lambda: len(bench.states) >= 100, "states")
    tilt = Vector3Stamped()
    tilt.vector.y = 0.1
    set_stamp(tilt.header.stamp, next_ns)
    tilts.publish(tilt)
    # Stamped a millisecond apart, however slowly all this runs: the ball counts as lost after 1 s by the stamps.
    stamps_ns = itertools.count(next_ns, MS)

    def moved() -> bool:
        # The tilt travels on a topic of its own: it may arrive after the first of these.
        bench.publish_contact(200, next(stamps_ns), 0.01, -0.02, touched=False)
        return bool(bench.states[-1].velocity.x > 0.0)

    wait_for(moved, "a velocity from the tilt alone")

    def gone() -> bool:
        bench.publish_contact(201, bench.now_ns(), 0.0, 0.0, touched=False)
        return not bench.states[-1].valid

    wait_for(gone, "an estimate that is not valid")
    state = bench.states[-1]
    assert (state.position.x, state.velocity.x, state.position_sigma) == (0.0, 0.0, 0.0)


def reports_of(bench: Bench) -> list[DiagnosticStatus]:
    """What the nodes report from now on; to be called before the bench spins."""
    reports: list[DiagnosticStatus] = []
    bench.node.create_subscription(DiagnosticArray, "/diagnostics", lambda message: reports.extend(message.status), 10)
    return reports


@pytest.mark.parametrize("bench", [62], indirect=True)
def test_a_nan_in_a_contact_is_counted_and_reported_once(bench: Bench) -> None:
    reports = reports_of(bench)
    start_state_node(bench)
    wait_for(lambda: bool(reports), "a report")
    publish_contacts(bench, list(range(100)))
    bench.publish_contact(100, bench.now_ns(), float("nan"), 0.0)
    bench.publish_contact(101, bench.now_ns(), 0.01, -0.02)
    wait_for(lambda: bool(bench.statistics) and bench.statistics[-1].received == 102, "the statistics")
    assert all(np.isfinite([state.position.x, state.velocity.x]).all() for state in bench.states)
    told = "1 contact was not finite and was left out"
    wait_for(lambda: any(told in report.message for report in reports), "a warning")
    warning = next(report for report in reports if told in report.message)
    assert warning.level == DiagnosticStatus.WARN
    # What is past hides nothing that comes later.

    def is_well() -> bool:
        bench.publish_contact(102, bench.now_ns(), 0.01, -0.02)
        return reports[-1].message == "ball"

    wait_for(is_well, "a report without it")
    assert {value.key: value.value for value in reports[-1].values}["not_finite"] == "1"
    assert sum(told in report.message for report in reports) == 1


@pytest.mark.parametrize("bench", [62], indirect=True)
def test_contacts_in_another_frame_are_left_out_and_reported(bench: Bench) -> None:
    reports = reports_of(bench)
    start_state_node(bench, "frame_id:=arm/plate")
    wait_for(lambda: bool(reports), "a report")
    for sequence in range(3):
        bench.publish_contact(sequence, bench.now_ns(), 0.01, -0.02)
    left_out = "3 contacts in the frame 'plate' were left out: that of the skin is 'arm/plate' (parameter frame_id)"
    told = f"no contact messages on /plate/contact; {left_out}"
    wait_for(lambda: any(report.message == told for report in reports), "contacts that are left out")
    assert all(report.level == DiagnosticStatus.WARN for report in reports)
    assert not bench.states
    bench.publish_contact(3, bench.now_ns(), 0.01, -0.02, frame_id="arm/plate")
    wait_for(lambda: bool(bench.states), "a state")
    assert (bench.states[-1].header.frame_id, bench.states[-1].contacts_received) == ("arm/plate", 1)


@pytest.mark.parametrize("bench", [62], indirect=True)
def test_estimates_and_references_in_another_frame_are_left_out_and_reported(bench: Bench) -> None:
    node = BallControlNode(lambda _settings: ArmInProcess(), context=bench.context, namespace="/plate", cli_args=[])
    bench.add(node)

    def tell(frame_id: str) -> None:
        state, reference = BallState(valid=True), BallReference()
        for message in (state, reference):
            message.header.frame_id = frame_id
            message.position.x = 0.03
        node._on_state(state)
        node._on_reference(reference)

    node._loop.status = LoopStatus(phase=Phase.WAITING, reason="waiting for a ball", touch_age_s=0.0)
    tell("camera")
    tell("base_link")
    assert (node._loop.ball, node._loop.reference) == (None, None)
    level, words, values = node._report()
    assert level == WARN
    assert words == (
        "waiting: waiting for a ball; 2 estimates in the frame 'base_link' were left out: that of the skin is 'plate' "
        "(parameter frame_id); 2 references in the frame 'base_link' were left out: that of the skin is 'plate' "
        "(parameter frame_id)"
    )
    assert values["in_another_frame"] == 4
    assert node._report()[1] == "waiting: waiting for a ball"
    # Made by hand, they may name none.
    for frame_id in ("plate", ""):
        node._loop.ball = node._loop.reference = None
        tell(frame_id)
        assert node._loop.ball is not None
        assert node._loop.ball.ball.x_m == 0.03
        assert node._loop.reference is not None
        assert node._loop.reference.reference.x_m == 0.03
    assert node._report()[1] == "waiting: waiting for a ball"


@pytest.mark.parametrize("bench", [62], indirect=True)
def test_tilts_in_another_frame_are_left_out_and_reported(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    node = BallStateNode(context=bench.context, namespace="/plate", cli_args=[])
    bench.add(node)
    told: list[tuple[float, float]] = []
    monkeypatch.setattr(node, "set_tilt", lambda _stamp_ns, tilt_rad: told.append(tilt_rad))
    for frame_id in ("base_link", "plate", ""):
        tilt = Vector3Stamped()
        tilt.header.frame_id = frame_id
        tilt.vector.x = 0.1
        node._on_tilt(tilt)
    assert told == [(0.1, 0.0)] * 2
    _, words, values = node._report()
    assert "1 tilt in the frame 'base_link' was left out: that of the skin is 'plate' (parameter frame_id)" in words
    assert values["in_another_frame"] == 1


@pytest.mark.parametrize("bench", [63], indirect=True)
def test_the_trajectory_starts_with_balancing_pauses_and_starts_anew(bench: Bench) -> None:
    arguments = [
        "--ros-args",
        "-p",
        "trajectory:=hold,I,",
        "-p",
        "hold_s:=0.2",
        "-p",
        "speed_m_s:=0.5",
        "-p",
        "acceleration_m_s2:=2.0",
    ]
    node = BallTrajectoryNode(context=bench.context, namespace="/plate", cli_args=arguments)
    bench.add(node)
    statuses = bench.node.create_publisher(BalanceStatus, "ball/status", STATE)
    bench.start()
    wait_for(lambda: statuses.get_subscription_count() >= 1 and bool(bench.references), "the node")

    def tell(state: int) -> None:
        statuses.publish(BalanceStatus(state=state))

    def telling(state: int, condition: str) -> bool:
        tell(state)
        last = bench.references[-1]
        return bool(last.finished if condition == "finished" else last.segment == condition)

    tell(BalanceStatus.STATE_WAITING)
    count = len(bench.references)
    wait_for(lambda: len(bench.references) > count + 20, "references")
    first = bench.references[-1]
    assert (first.segment, first.segment_time, first.finished) == ("hold", 0.0, False)
    assert first.header.frame_id == "plate"
    assert (first.position.x, first.velocity.y) == (0.0, 0.0)

    wait_for(lambda: telling(BalanceStatus.STATE_BALANCING, "finished"), "the end")
    assert [name for name in ("hold", "move", "I") if any(r.segment == name for r in bench.references)] == [
        "hold",
        "move",
        "I",
    ]
    last = bench.references[-1]
    assert (last.segment, last.position.y, last.velocity.y) == ("I", pytest.approx(0.032), 0.0)
    stamps = np.array([r.header.stamp.sec * 10**9 + r.header.stamp.nanosec for r in bench.references])
    assert np.all(np.diff(stamps) > 0)
    assert max(abs(r.velocity.y) for r in bench.references) > 0.1

    wait_for(lambda: telling(BalanceStatus.STATE_WAITING, "I"), "a pause")
    wait_for(lambda: telling(BalanceStatus.STATE_STOPPED, "hold"), "the beginning")
    assert not bench.references[-1].finished


@pytest.mark.parametrize(
    ("module", "parameters", "words"),
    [
        ("ball_trajectory_node", {"trajectory": "hold,X"}, "'X' is not one of hold, N, B, I, circle"),
        ("ball_trajectory_node", {"letter_height_m": 0.2}, "beyond reach_m = 0.045"),
        ("ball_control_node", {"kpp": 1.0}, "did you mean 'kp'?"),
        ("ball_control_node", {"max_tilt_rad": 1.0}, "max_tilt_rad = 1.0: allowed is"),
        ("ball_state_node", {"publish_rate_hz": 0.0}, "publish_rate_hz = 0.0: allowed is"),
    ],
)
def test_bad_parameters_are_an_error_at_start(module: str, parameters: dict[str, object], words: str) -> None:
    with Process(*node_command(module, **parameters), domain=63) as process:
        wait_for(lambda: process.process.poll() is not None, "the end of the process")
        assert process.process.returncode == REFUSED_EXIT_CODE
        assert words in process.text()
        assert process.text().startswith("error: ")


def test_settings_files_reach_all_three_nodes_of_the_composed_process(tmp_path: Path) -> None:
    path = tmp_path / "params.yaml"
    path.write_text("/**/ball_state:\n  ros__parameters:\n    gate_sigmas: 0.5\n")
    command = [
        *node_command("ball_balancing", "--set", "ball_trajectory.trajectory=hold,N,"),
        "--params-file",
        str(path),
    ]
    with Process(*command, domain=63) as process:
        wait_for(lambda: process.process.poll() is not None, "the end of the process")
        assert "parameters of /plate/ball_state: gate_sigmas = 0.5" in process.text()
    with Process(*node_command("ball_balancing", "--nonsense"), domain=63) as process:
        wait_for(lambda: process.process.poll() is not None, "the end of the process")
        assert "unrecognized arguments: --nonsense" in process.text()


def test_the_stream_counter_on_wraps_repeats_and_restarts() -> None:
    counter = StreamCounter()
    for sequence in (2**32 - 2, 2**32 - 1, 0, 2, 3):
        counter.step(sequence, 0.001)
    assert (counter.received, counter.lost) == (5, 1)
    counter.step(3, 0.001)
    counter.step(0, 0.001)
    counter.step(1, 0.002)
    assert (counter.received, counter.lost) == (8, 1)
    latencies = counter.take_latencies()
    assert (len(latencies), latencies.typecode) == (8, "f")
    assert len(counter.take_latencies()) == 0
