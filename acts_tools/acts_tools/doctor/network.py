# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Checks of the network for ROS: socket buffers, domain and discovery."""

from __future__ import annotations

from acts_ros.middleware import HIGHEST_DOMAIN
from acts_tools.doctor.finding import Finding, Level, unknown
from acts_tools.doctor.machine import Machine

_BUFFER_BYTES = 4 << 20
_BUFFERS = ("rmem_max", "wmem_max")
# The ports of higher domains are among those that Linux gives to any program.
_SAFE_DOMAINS = (range(0, 102), range(215, 233))
_RANGES = ("SUBNET", "LOCALHOST", "OFF", "SYSTEM_DEFAULT")


def socket_buffers(machine: Machine) -> Finding:
    """Check the sizes of socket buffers, as the ROS documentation on DDS tuning advises."""
    name = "socket buffers"
    sizes = {which: machine.number(f"proc/sys/net/core/{which}") for which in _BUFFERS}
    known = {which: size for which, size in sizes.items() if size is not None}
    if len(known) < len(sizes):
        return unknown(name, "/proc/sys/net/core/rmem_max or wmem_max")
    words = ", ".join(f"{which} {size // 1024} KiB" for which, size in known.items())
    if all(size >= _BUFFER_BYTES for size in known.values()):
        return Finding(name, Level.OK, words)
    settings = " ".join(f"net.core.{which}={_BUFFER_BYTES}" for which in _BUFFERS)
    return Finding(
        name,
        Level.NOTE,
        f"{words}: bursts of images at 1 kHz get lost, over a network and on this machine, where nodes talk by UDP",
        f"sudo sysctl -w {settings}     # to keep it: in /etc/sysctl.d/60-ros.conf",
    )


def ros_domain(machine: Machine) -> Finding:
    """Check the ROS domain."""
    name = "ROS domain"
    text = machine.environment.get("ROS_DOMAIN_ID", "")
    if text and not (text.isdecimal() and int(text) <= HIGHEST_DOMAIN):
        allowed = f"allowed is 0 to {HIGHEST_DOMAIN}"
        return Finding(name, Level.LACKS, f"ROS_DOMAIN_ID={text}: {allowed}, no node starts", "export ROS_DOMAIN_ID=42")
    domain = int(text or 0)
    if not any(domain in safe for safe in _SAFE_DOMAINS):
        shown = f"{domain}: its ports may be taken by any program; 0 to 101 and 215 to 232 are safe"
        return Finding(name, Level.NOTE, shown, "export ROS_DOMAIN_ID=42")
    if text:
        return Finding(name, Level.OK, f"{domain}")
    if _is_local(machine):
        return Finding(name, Level.OK, "0, on this machine only")
    return Finding(
        name,
        Level.NOTE,
        "0, the default: robots of others on this network communicate with yours",
        "export ROS_DOMAIN_ID=42     # or: export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST",
    )


def discovery(machine: Machine) -> Finding:
    """Check the range of discovery."""
    name = "ROS discovery"
    text = machine.environment.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "")
    if text and text not in _RANGES:
        shown = f"ROS_AUTOMATIC_DISCOVERY_RANGE={text}: allowed is one of {', '.join(_RANGES)}"
        return Finding(name, Level.NOTE, shown, "export ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET")
    if text == "OFF":
        mend = "export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST"
        return Finding(name, Level.LACKS, "off: nodes do not find one another, not even on this machine", mend)
    return Finding(name, Level.OK, "this machine" if _is_local(machine) else "this machine and its network")


def _is_local(machine: Machine) -> bool:
    environment = machine.environment
    return (
        environment.get("ROS_AUTOMATIC_DISCOVERY_RANGE") == "LOCALHOST" or environment.get("ROS_LOCALHOST_ONLY") == "1"
    )
