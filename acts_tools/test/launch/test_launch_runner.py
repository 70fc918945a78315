# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The launch tests' own tools, on a node made up here; the bodies run by launch_pytest where it is installed.

ROS_DOMAIN_IDs 81 to 83.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from fake_prefix import Prefix
from std_msgs.msg import String

from acts_tools.testing.launch_runner import Launched, LaunchFile, launch_fixture, launch_test, launched
from acts_tools.testing.probe import Probe

pytestmark = pytest.mark.slow

TALKER = """
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.declare_parameter("word", "none")
        self.publisher = self.create_publisher(String, "word", 10)
        self.create_timer(0.05, self.talk)

    def talk(self):
        self.publisher.publish(String(data=self.get_parameter("word").value))

rclpy.init()
node = Talker()
print("talking", flush=True)
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
node.destroy_node()
rclpy.try_shutdown()
"""
BODY = """
  <arg name="word" default="hello"/>
  <group>
    <push-ros-namespace namespace="plate"/>
    <node pkg="fake" exec="talker" name="speaker" output="screen">
      <param name="word" value="$(var word)" type="str"/>
      <remap from="word" to="said"/>
    </node>
  </group>
"""


@launch_fixture
def talker(prefix: Prefix) -> LaunchFile:
    prefix.python("talker", TALKER)
    prefix.launch("talker.launch.xml", BODY)
    return LaunchFile("fake", "talker.launch.xml", domain_id=81, arguments={"word": "123"})


@launch_test(talker)
def test_a_launched_node_has_its_namespace_parameters_and_remaps(talker: Launched) -> None:
    assert talker.wait_for_message("/plate/said", String).data == "123"
    talker.wait_for_node("/plate/speaker")
    talker.wait_for_output("talking")
    assert len(talker.wait_for_messages("/plate/said", String, count=3)) == 3
    assert talker.stop() == 0
    assert not talker.running


@launch_fixture
def mortal(prefix: Prefix) -> LaunchFile:
    prefix.python("mortal", "print('going', flush=True)\nraise SystemExit(4)\n")
    prefix.python("patient", "import time\ntime.sleep(600)\n")
    body = '<node pkg="fake" exec="mortal" output="screen"/><node pkg="fake" exec="patient"/>'
    return LaunchFile(str(prefix.launch("mortal.launch.xml", body)), domain_id=82)


@launch_test(mortal)
def test_a_death_shows_in_the_exit_code(mortal: Launched) -> None:
    mortal.wait_for_output("exit code 4")
    assert mortal.running
    assert mortal.stop() == 1


@launch_fixture
def reborn(prefix: Prefix, tmp_path: Path) -> LaunchFile:
    marker = tmp_path / "died"
    prefix.python(
        "reborn",
        f"import time\nfrom pathlib import Path\nmarker = Path({str(marker)!r})\n"
        "if not marker.exists():\n    marker.touch()\n    raise SystemExit(1)\n"
        "print('alive', flush=True)\ntime.sleep(600)\n",
    )
    body = '<node pkg="fake" exec="reborn" output="screen" respawn="true"/>'
    return LaunchFile(str(prefix.launch("reborn.launch.xml", body)), domain_id=82)


@launch_test(reborn)
def test_a_respawned_death_does_not(reborn: Launched) -> None:
    reborn.wait_for_output("alive")
    assert reborn.stop() == 0


def test_a_message_that_is_wanted_is_waited_for_among_those_of_other_publishers() -> None:
    with Probe(83) as probe:
        publishers = {word: probe.node.create_publisher(String, "/word", 10) for word in ("one", "two")}

        def talk() -> None:
            for word, publisher in publishers.items():
                publisher.publish(String(data=word))

        probe.node.create_timer(0.02, talk)
        wanted = probe.wait_for_messages("/word", String, 3, is_wanted=lambda message: message.data == "two")
    assert [message.data for message in wanted] == ["two"] * 3


def test_waiting_in_vain_fails_with_the_output(prefix: Prefix) -> None:
    prefix.python("talker", "print('a thing to say', flush=True)\nimport time\ntime.sleep(600)\n")
    prefix.launch("talker.launch.xml", BODY)
    with launched("fake", "talker.launch.xml", domain_id=83) as run:
        run.wait_for_output("a thing to say")
        with pytest.raises(AssertionError, match=r"(?s)in vain for a publisher of /plate/said.*a thing to say"):
            run.wait_for_publisher("/plate/said", timeout_s=0.2)
        with pytest.raises(AssertionError, match=r"(?s)in vain for the moon.*a thing to say"):
            run.wait_for(lambda: False, timeout_s=0.1, what="the moon")


def test_waiting_ends_early_when_the_launch_has_ended(prefix: Prefix) -> None:
    prefix.script("short", "#!/bin/sh\necho bye\n")
    path = prefix.launch("short.launch.xml", '<node pkg="fake" exec="short" output="screen"/>')
    with launched(str(path), domain_id=83) as run:
        with pytest.raises(AssertionError, match="the launch ended while the test waited for `never`"):
            run.wait_for_output("never", timeout_s=60.0)
        with pytest.raises(AssertionError, match="the launch has ended"):
            run.wait_for_publisher("/never", timeout_s=60.0)
