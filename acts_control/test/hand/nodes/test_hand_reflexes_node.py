# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `hand_reflexes` as a process, on the simulated bus, with made touch; ROS_DOMAIN_ID 215."""

from __future__ import annotations

import signal
import time
from dataclasses import replace

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from dynamixel_bus import DEADLINE_S, TIMEOUT_MS, Bus
from hand_node_rig import Spin, node_and_user
from hand_rig import all_regions, region
from peers import Peers
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from acts_control.hand.control import HandPhase
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.motors import HandReading
from acts_control.hand.nodes.reflexes_node import HandReflexesNode
from acts_control.hand.reflexes import HandState
from acts_control.loop_rate import steady_s
from acts_core.skin import RegionContact as Touch
from acts_msgs.msg import HandStatus, HandTiming, RegionContact, RegionContacts
from acts_ros.messages import ns_of
from acts_ros.qos import STREAM

pytestmark = pytest.mark.slow

DOMAIN_ID = 215
GRIPPED = [region(f"{finger}_distal", 0.8) for finger in LEAP_RIGHT.fingers]
TIP = region("index_distal", 0.5, 1, sharpness=10.0)


def message_of(touch: Touch) -> RegionContact:
    message = RegionContact(
        name=touch.name,
        link=touch.link,
        active_taxels=touch.active_taxels,
        force=touch.force_n,
        area=touch.area_m2,
        peak=touch.peak_n,
        concentration=touch.concentration,
        sharpness=touch.sharpness,
        slip=touch.slip_m,
        slipping=touch.slipping,
    )
    message.centre.x, message.centre.y, message.centre.z = touch.centre_m
    message.normal.x, message.normal.y, message.normal.z = touch.normal
    return message


def test_the_hand_grasps_avoids_and_opens_by_touch_and_ends_in_order(bus: Bus) -> None:
    parameters = (
        *(f"port:={bus.link}", f"answer_timeout_ms:={TIMEOUT_MS}", "silence_s:=2.0", "motor_watchdog_s:=0.0"),
        *("touch_stale_after_s:=2.0", "close_speed_rad_s:=4.0", "rate_hz:=100.0", "reflexes:=sharp slip"),
    )
    with node_and_user(DOMAIN_ID, *parameters, program="hand_reflexes") as (process, node, until):
        statuses: list[HandStatus] = []
        reports: list[DiagnosticArray] = []
        node.create_subscription(HandStatus, "hand/status", statuses.append, 10)
        timings: list[HandTiming] = []
        node.create_subscription(DiagnosticArray, "/diagnostics", reports.append, 10)
        node.create_subscription(HandTiming, "hand/timing", timings.append, 10)
        regions = node.create_publisher(RegionContacts, "regions", STREAM)

        def feel(*touches: Touch) -> bool:
            """Publish touch; always true, for conditions."""
            message = RegionContacts(regions=[message_of(one) for one in all_regions(*touches)])
            message.header.stamp = node.get_clock().now().to_msg()
            regions.publish(message)
            return True

        def until_state(state: int, *touches: Touch) -> HandStatus:
            def there() -> bool:
                feel(*touches)
                return bool(statuses) and statuses[-1].state == state

            until(there)
            return statuses[-1]

        def called(name: str) -> Trigger.Response:
            return answer_of(node, until, name)

        until(lambda: any("no touch so far; " in status.message for report in reports for status in report.status))
        until_state(HandStatus.STATE_STOPPED)
        until(lambda: statuses[-1].steps > 0)
        # Touch has to be there before the hand may close.
        until(lambda: feel() and statuses[-1].touch_age < 1.0)
        answers: list[Trigger.Response] = []

        def is_heard() -> bool:
            """Whether it is not refused because a busy machine has just not run the hand's process for a while."""
            feel()
            answers.append(called("grasp"))
            return "this program stood still" not in answers[-1].message

        until(is_heard)
        grasped = answers[-1]
        assert grasped.success
        # It has only begun.
        assert grasped.message == "the hand closes until it grips something"
        until_state(HandStatus.STATE_CLOSING)
        until(lambda: feel() and statuses[-1].goals[2] > 0.4)
        held = until_state(HandStatus.STATE_HOLDING, *GRIPPED)
        assert held.reason.startswith("gripped by index")
        avoiding = until_state(HandStatus.STATE_AVOIDING, TIP, *GRIPPED[1:])
        assert list(avoiding.active) == ["sharp"]
        assert dict(zip(avoiding.reflexes, avoiding.events, strict=True))["sharp"] == 1
        released = called("release")
        assert released.success
        assert released.message == "the hand opens"
        opening = until_state(HandStatus.STATE_OPEN)
        assert len(opening.goals) == 16
        until(lambda: any(dict_of(report).get("hand") == "OPEN" for report in reports))
        until(lambda: feel() and any(timing.latencies for timing in timings))
        told = next(timing for timing in timings if timing.latencies)
        assert all(duration > 0.0 for duration in told.durations)
        assert 0 < len(told.latencies) <= len(told.durations) <= told.cycles

        def is_said() -> bool:
            feel(region("index_distal", float("nan")))
            return any(
                status.level == DiagnosticStatus.WARN and " left out: " in status.message
                for report in reports
                for status in report.status
            )

        until(is_said)
        partly = RegionContacts(regions=[message_of(region("palm"))])

        def is_missed() -> bool:
            partly.header.stamp = node.get_clock().now().to_msg()
            regions.publish(partly)
            words = "touch says nothing of index_proximal, index_medial, "
            return any(words in status.message for report in reports for status in report.status)

        until(is_missed)
        forger = Node("forger", context=node.context)
        forger.create_publisher(RegionContacts, "regions", STREAM)
        words = "/regions has 2 publishers (/forger, "
        until(lambda: any(words in status.message for report in reports for status in report.status))
        forger.destroy_node()
        # A hand without torque is about nothing.
        assert statuses[-1].state == HandStatus.STATE_OPEN
        assert called("disable").success
        assert until_state(HandStatus.STATE_STOPPED).reason == "the hand is released: released by request"
        until(lambda: any(dict_of(report).get("hand") == "STOPPED" for report in reports[-1:]))
        refused = called("grasp")
        assert not refused.success
        assert refused.message == "the hand is released: released by request; call enable"
        # Who stops a hand is not told to switch its torque on.
        assert called("stop").message == "the hand is released: released by request"
        # Who has enabled a hand can move it at once.
        until(lambda: called("enable").success)
        stopped = called("stop")
        assert stopped.success
        assert stopped.message == "the hand stands still, its torque on"
        until(lambda: statuses[-1].reason == "stopped by request")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=DEADLINE_S)
        assert process.returncode == 0
    assert {motor["torque_enable"] for motor in bus.motors()} == {0}


def test_a_hand_does_not_begin_to_move_by_what_was_asked_for_while_its_program_stood_still(bus: Bus) -> None:
    parameters = (f"port:={bus.link}", f"answer_timeout_ms:={TIMEOUT_MS}", "silence_s:=2.0", "autostart:=false")
    quiet = ("motor_watchdog_s:=0.0", "rate_hz:=100.0")
    with node_and_user(DOMAIN_ID, *parameters, *quiet, program="hand_reflexes") as (process, node, until):
        reports: list[DiagnosticArray] = []
        node.create_subscription(DiagnosticArray, "/diagnostics", reports.append, 10)
        clients = {
            name: node.create_client(Trigger, f"hand_reflexes/{name}") for name in ("enable", "grasp", "disable")
        }
        until(lambda: all(client.service_is_ready() for client in clients.values()))
        until(lambda: any("connected" in status.message for report in reports for status in report.status))

        def asked_while_it_stands_still(name: str) -> Trigger.Response:
            process.send_signal(signal.SIGSTOP)
            future = clients[name].call_async(Trigger.Request())
            begin_s = time.monotonic()
            until(lambda: time.monotonic() - begin_s > 1.5)
            process.send_signal(signal.SIGCONT)
            until(future.done)
            return future.result()

        def obeys(name: str) -> bool:
            future = clients[name].call_async(Trigger.Request())
            until(future.done)
            return bool(future.result().success)

        for name in ("enable", "grasp"):
            answer = asked_while_it_stands_still(name)
            assert not answer.success
            assert answer.message.startswith("this program stood still for ")
        assert {motor["torque_enable"] for motor in bus.motors()} == {0}
        until(lambda: obeys("enable"))
        # What ends motion is done, however old.
        assert asked_while_it_stands_still("disable").success
        assert {motor["torque_enable"] for motor in bus.motors()} == {0}


def test_touch_is_known_while_the_torque_is_off(bus: Bus) -> None:
    parameters = (
        *(f"port:={bus.link}", f"answer_timeout_ms:={TIMEOUT_MS}", "silence_s:=2.0", "motor_watchdog_s:=0.0"),
        *("touch_stale_after_s:=2.0", "rate_hz:=100.0", "autostart:=false"),
    )
    with node_and_user(DOMAIN_ID, *parameters, program="hand_reflexes") as (_process, node, until):
        statuses: list[HandStatus] = []
        reports: list[DiagnosticArray] = []
        node.create_subscription(HandStatus, "hand/status", statuses.append, 10)
        node.create_subscription(DiagnosticArray, "/diagnostics", reports.append, 10)
        regions = node.create_publisher(RegionContacts, "regions", STREAM)
        message = RegionContacts(regions=[message_of(one) for one in all_regions()])

        def is_touched() -> bool:
            message.header.stamp = node.get_clock().now().to_msg()
            regions.publish(message)
            return bool(statuses) and statuses[-1].touch_age < 1.0

        def says(words: str) -> bool:
            return any(words in status.message for report in reports for status in report.status)

        until(is_touched)
        # A report from before it may be heard after the status.
        touched_ns = ns_of(statuses[-1].header.stamp)

        def is_reported() -> bool:
            reports[:] = [report for report in reports if ns_of(report.header.stamp) > touched_ns]
            return is_touched() and says("released: connected")

        until(is_reported)
        assert not says("no touch")
        # Nor does what was felt long ago count, once it is on.
        until(lambda: says("no touch for "))
        until(lambda: answer_of(node, until, "enable").success)
        assert answer_of(node, until, "grasp").message.startswith("no touch for ")


def test_stop_is_answered_while_enable_waits_and_the_torque_stays_off(bus: Bus) -> None:
    parameters = (
        *(f"port:={bus.link}", f"answer_timeout_ms:={TIMEOUT_MS}", "silence_s:=10.0", "motor_watchdog_s:=0.0"),
        *("rate_hz:=100.0", "autostart:=false"),
    )
    with node_and_user(DOMAIN_ID, *parameters, program="hand_reflexes") as (_process, node, until):
        statuses: list[HandStatus] = []
        readings: list[JointState] = []
        node.create_subscription(HandStatus, "hand/status", statuses.append, 10)
        node.create_subscription(JointState, "joint_states", readings.append, 10)
        enable, stop = (node.create_client(Trigger, f"hand_reflexes/{name}") for name in ("enable", "stop"))
        assert enable.wait_for_service(DEADLINE_S)
        assert stop.wait_for_service(DEADLINE_S)
        until(lambda: bool(readings) and bool(statuses))
        # As long as one is silent none gets torque, and the answer to enable waits.
        bus.command("lose 14")
        enabled, stopped = enable.call_async(Trigger.Request()), stop.call_async(Trigger.Request())
        until(stopped.done)
        assert stopped.result().success, stopped.result().message
        assert stopped.result().message == "the torque stays off"
        until(enabled.done)
        assert enabled.result().message == "the torque is off: stopped before it was on"
        bus.command("find 14")
        until(lambda: statuses[-1].reason == "the hand is released: stopped before it was on")
        readings.clear()
        until(lambda: len(readings) > 10)
        assert {motor["torque_enable"] for motor in bus.motors()} == {0}
        assert statuses[-1].state == HandStatus.STATE_STOPPED
        # Nor does that last: who wants it on after all is obeyed.
        until(lambda: answer_of(node, until, "enable").success)
        assert answer_of(node, until, "stop").success
        until(lambda: statuses[-1].reason == "stopped by request")
        assert {motor["torque_enable"] for motor in bus.motors()} == {1}


def test_what_is_asked_for_while_a_motor_is_started_anew_is_no_failure() -> None:
    peers = Peers(DOMAIN_ID, "user")
    # Its loop is not launched: the hand stays as it is put here.
    hand, user = peers.add(HandReflexesNode(context=peers.context)), peers.peer
    try:
        # Who is told that the hand cannot be reached is also told what it does when it can be.
        hand.loop.status = replace(hand.loop.status, phase=HandPhase.CONNECTING, reason="the cable is out")
        answer = user.create_client(Trigger, "hand_reflexes/release").call_async(Trigger.Request())
        peers.executor.spin_until_future_complete(answer, timeout_sec=DEADLINE_S)
        assert not answer.result().success
        words = (
            "the hand is not connected: the cable is out; as soon as it can, its torque comes on and its joints stand"
        )
        assert answer.result().message.startswith(words)
        hand.loop.status = replace(hand.loop.status, phase=HandPhase.RECOVERING, reason="index_pip: overload")
        for name in ("stop", "release"):
            client = user.create_client(Trigger, f"hand_reflexes/{name}")
            answer = client.call_async(Trigger.Request())
            peers.executor.spin_until_future_complete(answer, timeout_sec=DEADLINE_S)
            assert answer.result().success, answer.result().message
        hand.loop.status = replace(hand.loop.status, phase=HandPhase.GIVEN_UP, reason="index_pip: overload, 2 times")
        told = peers.listen(HandStatus, "hand/status", 10)
        given_up = "the hand is given up: index_pip: overload, 2 times"
        peers.until(lambda: told and told[-1].reason == given_up)
    finally:
        peers.close()


def test_a_grasp_is_not_done_when_its_program_has_stood_still_since() -> None:
    peers = Peers(DOMAIN_ID, "user")
    # Its loop is not launched, and nobody spins: the node stays as it is put here.
    hand = peers.add(HandReflexesNode(context=peers.context))
    try:
        hand.stalls.begin()
        now_s = steady_s()
        assert hand._supervisor.touch(all_regions(*GRIPPED), now_s, now_s)
        hand._supervisor.watch(now_s)
        assert hand._supervisor.grasp() == ""
        hand.stalls._looked_s -= 5.0
        hand._touched.restart(recovered=True)
        none = (0.0,) * 16
        hand._touched.step(HandReading(none, none, none, (30,) * 16, ("",) * 16), none, now_s, 0.004)
        status = hand._supervisor.status
        assert status.state is HandState.STOPPED
        assert status.reason == "this program stood still for 5.0 s before it began to close; grasp anew"
    finally:
        peers.close()


def test_a_hand_whose_torque_is_about_to_go_off_is_not_said_to_begin_to_move() -> None:
    peers = Peers(DOMAIN_ID, "user")
    # Its loop is not launched: motors that are silent hold it up for seconds while it switches their torque off.
    hand = peers.add(HandReflexesNode(context=peers.context))
    try:
        now_s = steady_s()
        assert hand._supervisor.touch(all_regions(*GRIPPED), now_s, now_s)
        hand._supervisor.watch(now_s)
        hand.loop.status = replace(hand.loop.status, phase=HandPhase.ENABLED, reason="acting")
        hand.loop.ask_release()
        for ask in (hand._on_grasp, hand._on_release):
            answer = ask(Trigger.Request(), Trigger.Response())
            assert not answer.success
            assert answer.message == "the torque is about to go off, as was asked for before; call enable"
        # A stop counts at any time: the torque may stay on after all.
        assert hand._on_stop(Trigger.Request(), Trigger.Response()).success
        hand.loop._wish.on()
        assert hand._on_grasp(Trigger.Request(), Trigger.Response()).success
    finally:
        peers.close()


def test_a_region_that_touch_tells_of_now_and_then_is_logged_now_and_then(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    peers = Peers(DOMAIN_ID, "user")
    monkeypatch.setattr(time, "monotonic", lambda: 100.0)
    # Its loop is not launched, and nobody spins.
    hand = peers.add(HandReflexesNode(context=peers.context))
    try:

        def logged(*unfelt: tuple[str, ...]) -> int:
            for names in unfelt:
                hand._supervisor.status = replace(hand._supervisor.status, unfelt=names)
                hand._publish_status()
            return capfd.readouterr().err.count("touch says nothing of palm")

        assert logged(("palm",), ("palm",)) == 1
        # As from two skins that take turns.
        assert logged(*[(), ("palm",)] * 200) <= 5
    finally:
        peers.close()


def answer_of(node: Node, until: Spin, name: str) -> Trigger.Response:
    client = node.create_client(Trigger, f"hand_reflexes/{name}")
    assert client.wait_for_service(DEADLINE_S)
    answer = client.call_async(Trigger.Request())
    until(answer.done)
    return answer.result()


def dict_of(report: DiagnosticArray) -> dict[str, str]:
    return {value.key: value.value for status in report.status for value in status.values}
