# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Checks of the serial ports: permissions, and delays of their adapters."""

from __future__ import annotations

from pathlib import Path

from acts_tools.doctor.finding import Finding, Level
from acts_tools.doctor.machine import Machine

_RULE = "60-acts-teensy.rules"
_RULE_FOLDERS = ("etc/udev/rules.d", "usr/lib/udev/rules.d", "lib/udev/rules.d")
# dialout on Debian and Ubuntu, uucp on Arch Linux.
_GROUPS = ("dialout", "uucp")
_CAP_DAC_OVERRIDE = 1
_JOIN = "sudo usermod -a -G dialout $USER     # uucp on Arch Linux; then log out and in again"


def latency_timers(machine: Machine) -> Finding:
    """Check for how long USB serial adapters buffer bytes."""
    name = "serial latency"
    slow = {}
    for path in machine.found("sys/bus/usb-serial/devices/*/latency_timer"):
        latency_ms = machine.number(str(path.relative_to(machine.root)))
        if latency_ms is not None and latency_ms > 1:
            slow[path.parent.name] = latency_ms
    if slow:
        words = ", ".join(f"{port} {latency_ms} ms" for port, latency_ms in slow.items())
        mend = "\n".join(f"echo 1 | sudo tee /sys/bus/usb-serial/devices/{port}/latency_timer" for port in slow)
        return Finding(name, Level.LACKS, f"bytes are buffered at {words}: frames arrive in bursts", mend)
    # A board with native USB, such as a Teensy, has no such timer.
    ports = [path.name for path in (*_ports(machine, "ttyACM*"), *machine.found("sys/bus/usb-serial/devices/*"))]
    return Finding(name, Level.OK, f"{', '.join(ports)}: no delay" if ports else "no port is plugged in")


def port_rights(machine: Machine) -> Finding:
    """Check whether this user may open the ports."""
    name = "port rights"
    ports = [*_ports(machine, "ttyACM*"), *_ports(machine, "ttyUSB*")]
    refused = [port.name for port in ports if not machine.may_use(port)]
    if refused:
        return Finding(name, Level.LACKS, f"this user may not open {', '.join(refused)}", _JOIN)
    if ports:
        return Finding(name, Level.OK, f"this user may open {', '.join(port.name for port in ports)}")
    if machine.has_capability(_CAP_DAC_OVERRIDE):
        return Finding(name, Level.OK, "no port is plugged in; root may open any")
    group = next((group for group in _GROUPS if group in machine.groups), None)
    if group is not None:
        return Finding(name, Level.OK, f"no port is plugged in; this user is in the group {group}")
    if any((machine.root / folder / _RULE).is_file() for folder in _RULE_FOLDERS):
        return Finding(name, Level.OK, "no port is plugged in; the udev rule of acts_driver is installed")
    mend = f"sudo cp acts_driver/udev/{_RULE} /etc/udev/rules.d/ && sudo udevadm control --reload"
    text = "no port is plugged in; a board would be refused: neither its group nor the udev rule"
    return Finding(name, Level.NOTE, text, mend)


def _ports(machine: Machine, pattern: str) -> list[Path]:
    return machine.found(f"dev/{pattern}")
