# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Report of all findings: the verdict, text for a person, and JSON."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from acts_core.words import counted
from acts_tools.doctor import cores, memory, network, ports, scheduling
from acts_tools.doctor.finding import Finding, Level
from acts_tools.doctor.machine import Machine

CHECKS: tuple[Callable[[Machine], Finding], ...] = (
    cores.cores,
    cores.core_clock,
    scheduling.kernel,
    scheduling.time_slices,
    scheduling.rtprio_limit,
    scheduling.locked_memory,
    scheduling.realtime_share,
    scheduling.kernel_workers,
    memory.shared_memory,
    memory.abandoned,
    memory.swap,
    ports.port_rights,
    ports.latency_timers,
    network.socket_buffers,
    network.ros_domain,
    network.discovery,
)
"""All checks, in the order of the report. To add a check, add its function here."""

_WORDS = {Level.OK: "ok", Level.UNKNOWN: "?", Level.NOTE: "note", Level.LACKS: "lacks"}
_COLOURS = {Level.OK: 32, Level.UNKNOWN: 90, Level.NOTE: 33, Level.LACKS: 31}
_LEVEL_WIDTH = max(map(len, _WORDS.values()))


@dataclass(frozen=True)
class Diagnosis:
    """Results of all checks.

    Attributes
    ----------
    findings : sequence of Finding
        In the order of `CHECKS`.
    realtime : bool
        Whether notes about real-time scheduling count as lacking.
    """

    findings: Sequence[Finding]
    realtime: bool = False

    @property
    def is_well(self) -> bool:
        """Whether nothing is lacking."""
        return all(finding.level is not Level.LACKS for finding in self.findings)

    def text(self, *, coloured: bool = False) -> str:
        """The report for a person, with commands below the findings that they correct."""
        name_width = max((len(finding.name) for finding in self.findings), default=0)
        indent = " " * (_LEVEL_WIDTH + name_width + 4)
        lines = []
        for finding in self.findings:
            word = f"{_WORDS[finding.level]:<{_LEVEL_WIDTH}}"
            if coloured:
                word = f"\033[{_COLOURS[finding.level]}m{word}\033[0m"
            lines.append(f"{word}  {finding.name:<{name_width}}  {finding.text}")
            lines += [f"{indent}$ {command}" for command in finding.mend.splitlines()]
        return "\n".join([*lines, "", self.verdict])

    @property
    def verdict(self) -> str:
        """Summary in one line."""
        what = "real time at 1 kHz" if self.realtime else "1 kHz"
        lacking = [finding.name for finding in self.findings if finding.level is Level.LACKS]
        notes = sum(finding.level is Level.NOTE for finding in self.findings)
        if lacking:
            return f"this machine lacks something for {what}: {', '.join(lacking)}"
        rest = f"; {counted(notes, 'note')} on what could be better" if notes else ""
        return f"this machine has what {what} needs{rest}"

    def as_json(self) -> dict[str, Any]:
        """The report for a program."""
        findings = [{**dataclasses.asdict(finding), "level": _WORDS[finding.level]} for finding in self.findings]
        return {"ok": self.is_well, "realtime": self.realtime, "findings": findings}


def examine(machine: Machine, *, realtime: bool = False) -> Diagnosis:
    """Run all checks.

    Parameters
    ----------
    machine : Machine
        The machine.
    realtime : bool
        Whether real-time scheduling is required as well; notes about it then count as lacking.
    """
    findings = [check(machine) for check in CHECKS]
    if realtime:
        findings = [
            dataclasses.replace(finding, level=Level.LACKS)
            if finding.for_realtime and finding.level is Level.NOTE
            else finding
            for finding in findings
        ]
    return Diagnosis(findings, realtime)
