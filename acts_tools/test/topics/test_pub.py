# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts pub`: typed values as messages, and the command with subscribers of this process; ROS_DOMAIN_ID 8."""

from __future__ import annotations

import array
import contextlib
import math
import signal
import subprocess
import sys
from typing import Any

import pytest
import yaml
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PointStamped
from hypothesis import given
from hypothesis import strategies as st
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import Image, Imu, JointState
from std_msgs.msg import UInt8

from acts_core.errors import ActsError, SettingsError
from acts_msgs.msg import Contact, Impact
from acts_ros.qos import STREAM
from acts_tools.cli import main
from acts_tools.echo.message_text import message_text
from acts_tools.pub.typed_message import typed_message, typed_values
from acts_tools.testing.probe import Probe

pytestmark = pytest.mark.slow

DEADLINE_S = 60.0
NOW_NS = 1_700_000_000_000_000_007


@pytest.fixture(autouse=True)
def _domain(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "8")


def test_fields_are_filled_and_others_keep_their_defaults() -> None:
    typed = typed_message(JointState, typed_values("{name: [index_pip, index_dip], position: [1, 1e-3]}"), NOW_NS)
    assert typed == JointState(name=["index_pip", "index_dip"], position=[1.0, 0.001])


def test_messages_in_messages_arrays_and_bytes_are_filled() -> None:
    text = "{status: [{level: 2, name: plate, values: [{key: lost, value: 'yes'}]}]}"
    (status,) = typed_message(DiagnosticArray, typed_values(text), NOW_NS).status
    assert (status.level, status.values[0].key, status.values[0].value) == (DiagnosticStatus.ERROR, "lost", "yes")
    imu = typed_message(Imu, {"orientation_covariance": [*range(9)]}, NOW_NS)
    assert imu.orientation_covariance.tolist() == [*range(9)]
    image = typed_message(Image, {"data": [0, 255], "is_bigendian": True}, NOW_NS)
    assert image.data == array.array("B", [0, 255])
    assert math.isnan(typed_message(Contact, typed_values("force: .nan"), NOW_NS).force)


def test_now_and_auto_are_the_time_of_the_message() -> None:
    for text in ("{header: auto, point: {x: 2}}", "{header: {stamp: now}, point: {x: 2}}"):
        point = typed_message(PointStamped, typed_values(text), NOW_NS)
        assert point.header.stamp == Time(sec=1_700_000_000, nanosec=7)
        assert point.point.x == 2.0


@given(
    st.builds(
        dict,
        number=st.integers(0, 2**32 - 1),
        is_over=st.booleans(),
        force=st.lists(
            st.floats(width=32, allow_nan=False, allow_infinity=False).map(lambda x: float(f"{x:.7g}"))
        ).filter(lambda forces: all(abs(force) < 1e38 for force in forces)),
        path_x=st.lists(st.floats(-1, 1, width=32)),
        header=st.builds(
            dict,
            frame_id=st.text(st.characters(codec="utf-8", exclude_characters="\0")),
            stamp=st.builds(dict, sec=st.integers(-(2**31), 2**31 - 1), nanosec=st.integers(0, 2**32 - 1)),
        ),
    )
)
def test_what_echo_prints_can_be_published(fields: dict[str, Any]) -> None:
    message = typed_message(Impact, fields, NOW_NS)
    told = message_text(message)
    again = typed_message(Impact, typed_values(f"{told}---\n"), NOW_NS)
    assert message_text(again) == told
    assert (again.number, again.is_over, again.header) == (message.number, message.is_over, message.header)


@pytest.mark.parametrize(
    ("kind", "text", "error"),
    [
        (UInt8, "data: 256", "data = 256: allowed is uint8"),
        (UInt8, "data: 1.5", "data = 1.5: allowed is uint8"),
        (UInt8, "date: 1", "date: there is no such field, only data; did you mean data?"),
        (UInt8, "{1: 2}", "1: there is no such field, only data"),
        (Contact, "force: much", "force = 'much': allowed is float"),
        (Contact, "force: 1e39", "force = '1e39': allowed is float"),
        (Contact, "in_contact: 1", "in_contact = 1: allowed is boolean"),
        (Contact, "centre_of_pressure: 3", "centre_of_pressure = 3: allowed are values of x, y, z, in braces"),
        (Contact, "centre_of_pressure: {x: [1]}", "centre_of_pressure.x = [1]: allowed is double"),
        (Contact, "{header: {stamp: auto}}", "header.stamp = 'auto': allowed are values of sec, nanosec, in braces"),
        (JointState, "name: index_pip", "name = 'index_pip': allowed is sequence<string>"),
        (JointState, "position: [1, x]", "position = [1, 'x']: allowed is sequence<double>"),
        (Imu, "orientation_covariance: [1, 2]", "orientation_covariance = [1, 2]: allowed is double[9]"),
        (DiagnosticArray, "status: [{level: 256}]", "status[0].level = 256: allowed is octet"),
        (DiagnosticArray, "status: [{}, 3]", "status[1] = 3: allowed are values of level, name, message"),
    ],
)
def test_a_value_that_cannot_be_is_refused(kind: type, text: str, error: str) -> None:
    with pytest.raises(SettingsError) as caught:
        typed_message(kind, typed_values(text), NOW_NS)
    assert str(caught.value).startswith(error)


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("[1, 2]", "values = '[1, 2]': allowed are fields with values"),
        ("", "values = '': allowed are fields with values"),
        ("{data: 'a", "the values are no YAML: "),
        ("data: 1\n---\ndata: 2", "the values are no YAML: expected a single document"),
    ],
)
def test_words_that_are_no_fields_are_refused(text: str, error: str) -> None:
    with pytest.raises(SettingsError) as caught:
        typed_values(text)
    assert str(caught.value).startswith(error)


FIELDS = st.sampled_from(["header", "stamp", "sec", "frame_id", "status", "level", "name", "values", "key", "other"])
ANYTHING = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text() | st.sampled_from(["now", "auto"]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(FIELDS, inner, max_size=3),
)


@given(st.text() | st.dictionaries(FIELDS, ANYTHING).map(yaml.safe_dump))
def test_any_words_are_taken_or_refused(text: str) -> None:
    with contextlib.suppress(ActsError):
        typed_message(DiagnosticArray, typed_values(text), NOW_NS)


def publishing(*words: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "acts_tools", "pub", *words]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def ended(process: subprocess.Popen[str]) -> tuple[int, str, str]:
    out, err = process.communicate(timeout=DEADLINE_S)
    return process.returncode, out, err


@pytest.mark.parametrize("profile", [STREAM, QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)])
def test_as_many_messages_as_are_wanted_reach_a_subscriber(profile: QoSProfile) -> None:
    heard: list[JointState] = []
    with Probe(8) as probe:
        probe.node.create_subscription(JointState, "/hand/command", heard.append, profile)
        values = "{header: auto, name: [index_pip], position: [0.4]}"
        words = ["-n", "3", "-r", "50", "hand/command", "sensor_msgs/msg/JointState", values]
        process = publishing(*words)
        try:
            probe.wait_for(lambda: len(heard) == 3, DEADLINE_S, "three messages")
            code, out, _ = ended(process)
        finally:
            process.kill()
    assert (code, out) == (0, "/hand/command: 3 messages published\n")
    assert all((list(one.name), list(one.position)) == (["index_pip"], [0.4]) for one in heard)
    stamps = [(one.header.stamp.sec, one.header.stamp.nanosec) for one in heard]
    assert stamps[0][0] > 0
    assert stamps[0] < stamps[1] < stamps[2]


def test_ctrl_c_ends_it() -> None:
    heard: list[UInt8] = []
    with Probe(8) as probe:
        probe.node.create_subscription(UInt8, "/word", heard.append, STREAM)
        process = publishing("-r", "100", "/word", "std_msgs/msg/UInt8", "data: 3")
        try:
            probe.wait_for(lambda: len(heard) > 2, DEADLINE_S, "messages")
            process.send_signal(signal.SIGINT)
            code, out, _ = ended(process)
        finally:
            process.kill()
    assert code == 0
    assert out.startswith("/word: ")
    assert out.endswith(" messages published\n")
    assert {one.data for one in heard} == {3}


def test_without_a_subscriber_nothing_is_published() -> None:
    assert ended(publishing("-d", "0.3", "/nobody", "std_msgs/msg/UInt8")) == (
        1,
        "",
        "/nobody: no subscriber found, nothing published\n",
    )


def test_a_type_that_subscribers_do_not_have_is_refused() -> None:
    with Probe(8) as probe:
        probe.node.create_subscription(UInt8, "/word", lambda _: None, STREAM)
        code, out, err = ended(publishing("/word", "sensor_msgs/msg/JointState"))
    assert (code, out) == (1, "")
    # On a busy machine subscribers may be found late, which is told before.
    assert err.splitlines()[-1] == "error: /word is of the type std_msgs/msg/UInt8, not sensor_msgs/msg/JointState"


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (
            ["/word", "std_msgs/UInt8"],
            "TYPE = std_msgs/UInt8: allowed is a message, such as sensor_msgs/msg/JointState",
        ),
        (["/word", "std_srvs/srv/Trigger"], "TYPE = std_srvs/srv/Trigger: allowed is a message"),
        (
            ["/word", "std_msgs/msg/Uint8"],
            "unknown message type 'std_msgs/msg/Uint8': the package 'std_msgs' that is installed has no such message; "
            "did you mean UInt8?",
        ),
        (
            ["/word", "std_msg/msg/UInt8"],
            "unknown message type 'std_msg/msg/UInt8': install or source the workspace that has package 'std_msg'",
        ),
        (["/word", "std_msgs/msg/UInt8", "data: x"], "data = 'x': allowed is uint8"),
    ],
)
def test_what_cannot_be_published_is_refused_at_once(
    words: list[str], error: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["pub", *words]) == 1
    assert capsys.readouterr().err.startswith(f"error: {error}")
