# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A simulated skin and robot say nothing to other machines, not even to one that asks them by address.

Two network namespaces stand for the machines; skipped where they are not allowed. ROS_DOMAIN_ID 200.
"""

from __future__ import annotations

import os
import socket
import struct
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import pytest
from launch_support import shipped_parameters_and

from acts_core.errors import LaunchError
from acts_ros.processes import packages
from acts_tools.launch.evaluate import evaluate
from acts_tools.two_machines.cable import ADDRESSES
from acts_tools.two_machines.listener import Listener, listener
from acts_tools.two_machines.machines import Machine, TwoMachines, two_machines

pytestmark = pytest.mark.slow

DOMAIN_ID = 200
RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
# Fast DDS of Jazzy knows only the older name, and newer versions complain of it.
PROFILE = (
    "FASTRTPS_DEFAULT_PROFILES_FILE" if os.environ.get("ROS_DISTRO") == "jazzy" else "FASTDDS_DEFAULT_PROFILES_FILE"
)
HERE = {RANGE: "LOCALHOST"}
# What another machine does to get at nodes that do not look for it: ask the ports of all participants there may be.
INTRUDER = f"""
<dds xmlns="http://www.eprosima.com"><profiles>
  <transport_descriptors><transport_descriptor>
    <transport_id>udp</transport_id><type>UDPv4</type><maxInitialPeersRange>64</maxInitialPeersRange>
  </transport_descriptor></transport_descriptors>
  <participant profile_name="intruder" is_default_profile="true"><rtps>
    <userTransports><transport_id>udp</transport_id></userTransports>
    <useBuiltinTransports>false</useBuiltinTransports>
    <builtin><initialPeersList>
      <locator><udpv4><address>{ADDRESSES[0]}</address></udpv4></locator>
    </initialPeersList></builtin>
  </rtps></participant>
</profiles></dds>
"""
CONTACT, TRUTH, OPEN_TOPIC = "/plate/contact", "/plate/ball/truth", "/open"
# Numba compiles in the first process that needs a kernel; on a busy machine that takes its time.
START_S = 240.0
DEADLINE_S = 60.0
TALKER = f"""
import time, rclpy
from std_msgs.msg import Header
rclpy.init()
publisher = rclpy.create_node("open").create_publisher(Header, "{OPEN_TOPIC}", 1)
while True:
    publisher.publish(Header())
    time.sleep(0.02)
"""


@dataclass
class Running:
    """The whole simulated chain on the near machine."""

    machines: TwoMachines
    folder: Path
    near: Listener


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    folder = tmp_path_factory.mktemp("loopback")
    launch = [sys.executable, "-m", "acts_tools", "launch", "--own", "acts_bringup", "ball_balancing.launch.xml"]
    with ExitStack() as stack:
        try:
            machines = stack.enter_context(two_machines())
        except LaunchError as error:
            pytest.skip(str(error))
        # A quarter of the full rate: what is asked here does not depend on it, and much runs here at once.
        slow = shipped_parameters_and(folder, "ball_balancing", "/plate/driver", "{rate_cap_hz: 250}")
        words = [*launch, f"run_dir:={folder / 'run'}", f"params_file:={slow}"]
        stack.enter_context(machines.near.running(words, DOMAIN_ID, folder / "launch.txt", HERE))
        near = stack.enter_context(listener(machines.near, [CONTACT, TRUTH], DOMAIN_ID, folder / "near.txt", HERE))
        try:
            near.wait_for(
                lambda report: report.received(CONTACT) > 0 and report.received(TRUTH) > 0, START_S, "the simulation"
            )
            yield Running(machines, folder, near)
        finally:
            print((folder / "launch.txt").read_text(errors="replace"))


@pytest.mark.parametrize("name", ["tactile", "ball_balancing", "skins", "hand_reflexes"])
@pytest.mark.parametrize(
    ("sim", "asked", "wanted"), [("true", None, "LOCALHOST"), ("true", "SUBNET", "SUBNET"), ("false", None, None)]
)
def test_a_simulation_keeps_to_this_machine_unless_told_otherwise(
    name: str, sim: str, asked: str | None, wanted: str | None, tmp_path: Path
) -> None:
    environment = {key: value for key, value in os.environ.items() if key != RANGE}
    if asked is not None:
        environment[RANGE] = asked
    file = packages.launch_file("acts_bringup", f"{name}.launch.xml", environment)
    plan = evaluate(file, {"sim": sim}, environment, tmp_path)
    assert {process.environment.get(RANGE) for process in plan.processes} == {wanted}


def bound_addresses(machine: Machine) -> list[str]:
    """What the sockets of a machine are bound to, with their protocol."""
    found = []
    for protocol in ("udp", "tcp"):
        for line in Path(f"/proc/{machine.pid}/net/{protocol}").read_text().splitlines()[1:]:
            address, port = (int(word, 16) for word in line.split()[1].split(":"))
            found.append(f"{protocol} {socket.inet_ntoa(struct.pack('=I', address))}:{port}")
    for protocol in ("udp6", "tcp6"):
        lines = Path(f"/proc/{machine.pid}/net/{protocol}").read_text().splitlines()[1:]
        found += [f"{protocol} {line.split()[1]}" for line in lines]
    return found


def test_every_socket_is_bound_to_the_loopback(running: Running) -> None:
    addresses = bound_addresses(running.machines.near)
    assert {address.partition(" ")[0] for address in addresses} == {"udp", "tcp"}
    assert [address for address in addresses if " 127." not in address] == []


def test_who_names_this_machine_as_its_peer_gets_nothing(running: Running) -> None:
    machines, folder = running.machines, running.folder
    profile = folder / "intruder.xml"
    profile.write_text(INTRUDER)
    reach = {RANGE: "SYSTEM_DEFAULT", PROFILE: str(profile)}
    with (
        listener(machines.far, [CONTACT, TRUTH, OPEN_TOPIC], DOMAIN_ID, folder / "far.txt", reach) as far,
        # A node that only has LOCALHOST, as all had: the other machine gets it, so it would get the others as well.
        machines.near.running([sys.executable, "-c", TALKER], DOMAIN_ID, folder / "open.txt", HERE),
    ):
        report = far.wait_for(lambda report: report.received(OPEN_TOPIC) > 50, DEADLINE_S, "the open node")
    assert report.received(CONTACT) == report.received(TRUTH) == 0
    # Here all of it goes on.
    running.near.wait_for(lambda report: report.topics[CONTACT].received > 0, DEADLINE_S, "contacts on this machine")
