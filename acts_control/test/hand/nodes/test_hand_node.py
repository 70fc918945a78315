# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node of a hand as a process, on the simulated bus; ROS_DOMAIN_ID 206 and 207."""

from __future__ import annotations

import math
import signal
import threading
import time
from typing import Any

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from dynamixel_bus import DEADLINE_S, TIMEOUT_MS, Bus, torques
from hand_loop_rig import MadeBus
from hand_node_rig import node_and_user
from peers import Peers
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger
from waiting import wait_for

from acts_control.hand.control import HandPhase
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.motors import HandError
from acts_control.hand.nodes import motor_node
from acts_control.hand.nodes.hand_node import SETTINGS, HandNode

pytestmark = pytest.mark.slow

DOMAIN_ID = 206
CMD_LEAP_DOMAIN_ID = 207


def diagnostics_of(node: Node) -> list[str]:
    """What the diagnostics say from now on."""
    told: list[str] = []

    def note(array: DiagnosticArray) -> None:
        told.extend(status.message for status in array.status)

    node.create_subscription(DiagnosticArray, "/diagnostics", note, 10)
    return told


def test_the_node_publishes_joint_states_follows_commands_and_ends_in_order(bus: Bus) -> None:
    parameters = (f"port:={bus.link}", f"answer_timeout_ms:={TIMEOUT_MS}", "silence_s:=2.0", "motor_watchdog_s:=1.0")
    with node_and_user(DOMAIN_ID, *parameters) as (process, node, until):
        diagnostics = diagnostics_of(node)
        states: list[JointState] = []
        node.create_subscription(JointState, "joint_states", states.append, 10)
        commands = node.create_publisher(JointState, "hand/command", 10)
        release = node.create_client(Trigger, "hand/release")

        def arrived() -> bool:
            commands.publish(JointState(name=["thumb_cmc", "nobody"], position=[0.7, 0.1]))  # left out, and told
            commands.publish(JointState(name=["thumb_cmc"], position=[0.3]))
            return bool(states) and abs(states[-1].position[12] - 0.3) < 0.02

        until(arrived)
        assert list(states[-1].name) == LEAP_RIGHT.names
        assert release.wait_for_service(DEADLINE_S)
        answer = release.call_async(Trigger.Request())
        until(answer.done)
        assert answer.result().success
        until(lambda: torques(bus) == {0})

        def is_told() -> bool:
            commands.publish(JointState(name=["thumb_cmc"], position=[0.1]))
            return any(
                "left out" in told and "the hand is released: released by request; call" in told for told in diagnostics
            )

        until(is_told)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=DEADLINE_S)
        assert process.returncode == 0
        assert "a command was left out: the hand has no joint 'nobody'" in errors


def test_what_was_commanded_while_the_program_stood_still_as_torque_came_on_is_not_done(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    bus, is_enabling, may_go_on = MadeBus(), threading.Event(), threading.Event()
    enable = bus.enable

    def held() -> None:
        is_enabling.set()
        assert may_go_on.wait(DEADLINE_S)
        enable()

    monkeypatch.setattr(bus, "enable", held)
    monkeypatch.setattr(motor_node, "make_motors", lambda *_arguments: bus)
    user = Peers(DOMAIN_ID, "user")
    node = user.add(HandNode(context=user.context))
    commands = user.peer.create_publisher(JointState, "hand/command", 10)
    command = JointState(name=["index_pip"], position=[0.9])
    try:
        node.begin()
        user.until(lambda: is_enabling.is_set() and commands.get_subscription_count() == 1)
        # Neither its executor nor its loop goes on, as where the process stands still.
        commands.publish(command)
        begin_s = time.monotonic()
        wait_for(lambda: time.monotonic() - begin_s > 1.0, "a while")
        may_go_on.set()
        wait_for(lambda: node.loop.status.phase is HandPhase.ENABLED, "torque")
        cycles = node.loop.status.cycles
        user.until(lambda: node.loop.status.cycles > cycles + 20)
        assert bus.sent[-1] == pytest.approx(bus.q_rad)
        # The node's own reports, once a second, tell the words of each refusal once.
        assert node.report()[2]["refused"] == 1
        assert "a command was left out: this program stood still for " in capfd.readouterr().err

        def is_obeyed() -> bool:
            commands.publish(command)
            return bus.sent[-1][2] > 0.5

        user.until(is_obeyed)
    finally:
        may_go_on.set()
        node.close()
        user.close()


def test_joint_states_that_the_middleware_does_not_take_do_not_switch_the_hand_off(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bus, refused, publish = MadeBus(), 0, Publisher.publish

    def refuse(publisher: Publisher[Any], msg: Any) -> None:
        nonlocal refused
        if isinstance(msg, JointState):
            refused += 1
            raise rclpy_implementation.RCLError("Failed to publish: cannot publish data, at x.cpp:68")
        publish(publisher, msg)

    monkeypatch.setattr(Publisher, "publish", refuse)
    monkeypatch.setattr(motor_node, "make_motors", lambda *_arguments: bus)
    user = Peers(DOMAIN_ID, "user")
    node = user.add(HandNode(context=user.context))
    try:
        node.begin()
        user.until(lambda: len(bus.sent) > 20)
        assert (node.loop.status.phase, bus.has_torque) == (HandPhase.ENABLED, True)
        assert refused > 20
    finally:
        node.close()
        user.close()


def test_goals_that_the_middleware_does_not_take_count_as_not_sent(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_publisher: object, _msg: object) -> None:
        raise rclpy_implementation.RCLError("Failed to publish: cannot publish data, at x.cpp:68")

    user = Peers(CMD_LEAP_DOMAIN_ID, "user")
    try:
        bus = motor_node.make_bus(user.peer, LEAP_RIGHT, SETTINGS["hand"](interface="cmd_leap"))
        bus.command([0.1] * 16)
        monkeypatch.setattr(Publisher, "publish", refuse)
        with pytest.raises(HandError, match=r"^/cmd_leap: Failed to publish: cannot publish data$"):
            bus.command([0.2] * 16)
        assert bus.read().q_rad == (0.1,) * 16
    finally:
        user.close()


def test_whether_somebody_takes_the_angles_is_judged_by_the_topic_that_they_are_remapped_to() -> None:
    user = Peers(CMD_LEAP_DOMAIN_ID, "user")
    node = user.add(
        HandNode(
            context=user.context,
            cli_args=["--ros-args", "-r", "cmd_leap:=/leap/angles"],
            parameter_overrides=[Parameter("interface", value="cmd_leap")],
        )
    )
    try:
        user.until(lambda: "nobody takes /leap/angles" in node.report()[1])
        user.listen(JointState, "/leap/angles", 10)
        user.until(lambda: "nobody takes" not in node.report()[1])
    finally:
        node.close()
        user.close()


def test_the_leap_team_s_own_node_is_commanded_within_the_same_limits() -> None:
    with node_and_user(CMD_LEAP_DOMAIN_ID, "interface:=cmd_leap") as (process, node, until):
        sent: list[JointState] = []
        taken = node.create_subscription(JointState, "cmd_leap", sent.append, 10)
        diagnostics = diagnostics_of(node)
        other = node.create_publisher(JointState, "cmd_leap", 10)
        until(lambda: any("/cmd_leap has 2 publishers (/hand, /user): end all but one" in told for told in diagnostics))
        node.destroy_publisher(other)
        commands = node.create_publisher(JointState, "hand/command", 10)

        def arrived() -> bool:
            commands.publish(JointState(name=["index_pip", "thumb_cmc"], position=[0.2, -9.0]))
            if not sent:
                return False
            motors = sent[-1].position
            return bool(abs(motors[2] - math.pi - 0.2) < 1e-6 and abs(motors[12] - math.pi + 0.349) < 1e-6)

        enable = node.create_client(Trigger, "hand/enable")
        assert enable.wait_for_service(DEADLINE_S)
        # A node that is started beside a hand that holds something does not open it.
        until(lambda: any(told.startswith("released: ") for told in diagnostics))
        assert sent == []
        enabled = enable.call_async(Trigger.Request())
        until(enabled.done)
        until(arrived)
        assert list(sent[-1].position[:2]) == pytest.approx([math.pi, math.pi])
        release = node.create_client(Trigger, "hand/release")
        assert release.wait_for_service(DEADLINE_S)
        answer = release.call_async(Trigger.Request())
        until(answer.done)
        assert not answer.result().success
        assert "the torque stays on" in answer.result().message
        until(lambda: any("released by request" in told and "the torque stays on" in told for told in diagnostics))
        assert node.destroy_subscription(taken)
        until(
            lambda: any("nobody takes /cmd_leap: start the LEAP team's node; released" in told for told in diagnostics)
        )
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=DEADLINE_S)
        assert process.returncode == 0
