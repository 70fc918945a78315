# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts doctor` on made-up machines: a good one, and one for everything that can be missing."""

from __future__ import annotations

import json
import os
import resource
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import pytest

from acts_tools.cli import main
from acts_tools.doctor.finding import Level
from acts_tools.doctor.machine import Machine, Space
from acts_tools.doctor.report import CHECKS, examine

MIB = 1 << 20
NO_LIMIT = (resource.RLIM_INFINITY, resource.RLIM_INFINITY)

GOOD = {
    "proc/version": "Linux version 6.12.0 #1 SMP PREEMPT_RT Tue Apr 30",
    "sys/kernel/realtime": "1",
    "proc/48/stat": f"48 (kworker/u8:0-events_unbound) I 2 {'0 ' * 35}1 1 0",
    "proc/49/stat": f"49 (cat) S 2 {'0 ' * 35}0 0 0",
    "proc/self/status": "Name:\tpython3\nCapEff:\t0000000000000000\nCpus_allowed_list:\t0-3\n",
    "proc/self/cgroup": "0::/user.slice",
    "sys/fs/cgroup/user.slice/cpu.max": "max 100000",
    "proc/sys/kernel/sched_rt_runtime_us": "950000",
    "proc/sys/kernel/sched_rt_period_us": "1000000",
    "sys/devices/system/cpu/cpu0/cpufreq/scaling_governor": "performance",
    "sys/devices/system/cpu/cpu1/cpufreq/scaling_governor": "performance",
    "dev/shm/fastdds_1_el": "",
    "proc/locks": "",
    "proc/swaps": "Filename Type Size Used Priority",
    "proc/sys/net/core/rmem_max": "4194304",
    "proc/sys/net/core/wmem_max": "8388608",
    "dev/ttyACM0": "",
    "sys/bus/usb-serial/devices/ttyUSB0/latency_timer": "1",
}


def lay_out(root: Path, files: Mapping[str, str | None]) -> None:
    for name, content in files.items():
        path = root / name
        if content is None:
            path.unlink()
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content + "\n" if content else "")


def limits(**changed: tuple[int, int]) -> Callable[[int], tuple[int, int]]:
    numbers = {resource.RLIMIT_RTPRIO: (99, 99), resource.RLIMIT_MEMLOCK: NO_LIMIT}
    numbers.update({getattr(resource, f"RLIMIT_{name.upper()}"): limit for name, limit in changed.items()})
    return numbers.__getitem__


@pytest.fixture
def good(tmp_path: Path) -> Machine:
    lay_out(tmp_path, GOOD)
    inode = (tmp_path / "dev/shm/fastdds_1_el").stat().st_ino
    lay_out(tmp_path, {"proc/locks": f"1: FLOCK  ADVISORY  WRITE 15552 00:1b:{inode} 0 EOF"})
    return Machine(
        root=tmp_path,
        environment={"ROS_DOMAIN_ID": "7"},
        limit=limits(),
        groups=frozenset({"users"}),
        may_use=lambda path: True,
        space=lambda path: Space(1000 * MIB, 900 * MIB),
    )


def test_a_good_machine_lacks_nothing(good: Machine) -> None:
    diagnosis = examine(good, realtime=True)
    assert [finding for finding in diagnosis.findings if finding.level is not Level.OK] == []
    assert diagnosis.is_well
    assert diagnosis.verdict == "this machine has what real time at 1 kHz needs"


@dataclass(frozen=True)
class Case:
    """A change of the good machine and what is said of it."""

    check: str
    level: Level
    words: str
    mend: str = ""
    files: Mapping[str, str | None] = field(default_factory=dict)
    machine: Mapping[str, Any] = field(default_factory=dict)
    for_realtime: bool = False


OK, NOTE, LACKS, UNKNOWN = Level.OK, Level.NOTE, Level.LACKS, Level.UNKNOWN
STATUS = "proc/self/status"
NO_PORT: dict[str, str | None] = {"dev/ttyACM0": None, "sys/bus/usb-serial/devices/ttyUSB0/latency_timer": None}
NO_DOMAIN: dict[str, object] = {"environment": {}}


def environment(**variables: str) -> dict[str, object]:
    return {"environment": variables}


CASES = [
    Case("cores", LACKS, "0.5 cores", "--cpus=2", {"sys/fs/cgroup/user.slice/cpu.max": "50000 100000"}),
    Case("cores", NOTE, "3 cores", "", {"sys/fs/cgroup/user.slice/cpu.max": "300000 100000"}),
    Case(
        "cores", LACKS, "0.9 cores", "--cpus=2",
        {"proc/self/cgroup": "4:cpu,cpuacct:/docker/1",
         "sys/fs/cgroup/cpu/docker/1/cpu.cfs_quota_us": "90000",
         "sys/fs/cgroup/cpu/docker/1/cpu.cfs_period_us": "100000"},
    ),
    Case("cores", NOTE, "one", "", {STATUS: "Cpus_allowed_list:\t2"}),
    Case("cores", UNKNOWN, "Cpus_allowed_list", "", {STATUS: None}),
    Case(
        "core clock", NOTE, "performance on 1, powersave on 1", "cpupower",
        {"sys/devices/system/cpu/cpu1/cpufreq/scaling_governor": "powersave"}, for_realtime=True,
    ),
    Case(
        "core clock", NOTE, "performance on 2, unknown on 1", "cpupower",
        {"sys/devices/system/cpu/cpu2/cpufreq/scaling_governor/is/a_folder": ""}, for_realtime=True,
    ),
    Case(
        "core clock", UNKNOWN, "virtual machines", "",
        {f"sys/devices/system/cpu/cpu{core}/cpufreq/scaling_governor": None for core in (0, 1)},
    ),
    Case("kernel", OK, "PREEMPT_RT", "", {"sys/kernel/realtime": None}),
    Case(
        "kernel", NOTE, "not PREEMPT_RT", "realtime-kernel",
        {"sys/kernel/realtime": None, "proc/version": "Linux version 6.8.0 #1 SMP PREEMPT_DYNAMIC"},
    ),
    Case("time slices", OK, "runs soon", "", {"proc/version": "Linux version 6.12.0 #1 SMP"}),
    Case("time slices", NOTE, "before 6.12", "hwe", {"proc/version": "Linux version 6.8.0-49-generic #1 SMP"}),
    Case("time slices", UNKNOWN, "/proc/version", "", {"proc/version": None}),
    Case(
        "kernel workers",
        NOTE,
        "late by some ms, whatever realtime_priority is",
        "chrt -f -p 1",
        {"proc/50/stat": f"50 (kworker/u9:1) I 2 {'0 ' * 35}0 0 0"},
    ),
    Case("kernel workers", UNKNOWN, "kworker/u", "", {"proc/48/stat": None}),
    Case("kernel", UNKNOWN, "/proc/version", "", {"sys/kernel/realtime": None, "proc/version": None}),
    Case(
        "rtprio limit", NOTE, "no effect", "rtprio 99", machine={"limit": limits(rtprio=(0, 0))}, for_realtime=True,
    ),
    Case("rtprio limit", OK, "up to 40", "", machine={"limit": limits(rtprio=(40, 40))}),
    Case(
        "rtprio limit", NOTE, "up to 0 are", "ulimit -r 99", machine={"limit": limits(rtprio=(0, -1))},
        for_realtime=True,
    ),
    Case(
        "rtprio limit", OK, "CAP_SYS_NICE", "", {STATUS: "CapEff:\t0000000000800000"},
        {"limit": limits(rtprio=(0, 0))},
    ),
    Case(
        "locked memory", NOTE, "8192 KiB", "memlock unlimited", machine={"limit": limits(memlock=(8 * MIB, 8 * MIB))},
        for_realtime=True,
    ),
    Case(
        "locked memory", OK, "CAP_IPC_LOCK", "", {STATUS: "CapEff:\t0000000000004000"},
        {"limit": limits(memlock=(0, 0))},
    ),
    Case("real-time share", NOTE, "guard is off", "950000", {"proc/sys/kernel/sched_rt_runtime_us": "-1"}),
    Case(
        "real-time share", NOTE, "held after 10 %", "950000", {"proc/sys/kernel/sched_rt_runtime_us": "100000"},
        for_realtime=True,
    ),
    Case("real-time share", UNKNOWN, "sched_rt", "", {"proc/sys/kernel/sched_rt_runtime_us": None}),
    Case(
        "real-time share", NOTE, "refused", "cpu.rt_runtime_us",
        {"proc/self/cgroup": "1:cpu:/a", "sys/fs/cgroup/cpu/a/cpu.rt_runtime_us": "0"}, for_realtime=True,
    ),
    Case(
        "shared memory", LACKS, "without a run_dir elsewhere", "mount",
        machine={"may_use": lambda path: path.name != "shm"},
    ),
    Case(
        "shared memory", LACKS, "needs up to 17", "--shm-size",
        machine={"space": lambda path: Space(64 * MIB, 8 * MIB)},
    ),
    Case("shared memory", OK, "18 of 64 MiB", "", machine={"space": lambda path: Space(64 * MIB, 18 * MIB)}),
    Case("shared memory", LACKS, "may not be written", "mount", machine={"may_use": lambda path: path.name != "shm"}),
    Case(
        "shared memory", LACKS, "8 of 64 MiB", "--shm-size", machine={"space": lambda path: Space(64 * MIB, 8 * MIB)}
    ),
    Case("left-over files", NOTE, "1 segment of", "rm -f /dev/shm/fastdds", {"dev/shm/fastdds_2_el": ""}),
    Case("left-over files", OK, "none", "", {"dev/shm/fastdds_port7400_el": ""}),
    Case("left-over files", UNKNOWN, "/proc/locks", "", {"proc/locks": None}),
    Case("swap", NOTE, "on", "swappiness=10", {"proc/swaps": "Filename Type\n/swap file"}),
    Case("swap", OK, "in need", "", {"proc/swaps": "Filename\n/swap", "proc/sys/vm/swappiness": "10"}),
    Case("swap", UNKNOWN, "/proc/swaps", "", {"proc/swaps": None}),
    Case("port rights", OK, "ttyACM0, ttyUSB0", "", {"dev/ttyUSB0": ""}),
    Case(
        "port rights", LACKS, "may not open ttyACM0", "usermod", machine={"may_use": lambda path: path.name == "shm"}
    ),
    Case("port rights", OK, "group dialout", "", NO_PORT, {"groups": frozenset({"dialout"})}),
    Case("port rights", OK, "udev rule", "", {**NO_PORT, "etc/udev/rules.d/60-acts-teensy.rules": "#"}),
    Case("port rights", NOTE, "would be refused", "udevadm", NO_PORT),
    Case(
        "serial latency", LACKS, "ttyUSB0 16 ms", "echo 1 | sudo tee /sys/bus/usb-serial/devices/ttyUSB0/latency_timer",
        {"sys/bus/usb-serial/devices/ttyUSB0/latency_timer": "16"},
    ),
    Case("serial latency", OK, "ttyACM0, ttyUSB0: no delay"),
    Case("socket buffers", NOTE, "rmem_max 208 KiB", "net.core.rmem_max", {"proc/sys/net/core/rmem_max": "212992"}),
    Case(
        "socket buffers", NOTE, "on this machine, where nodes talk by UDP", "net.core.rmem_max",
        {"proc/sys/net/core/rmem_max": "212992"},
    ),
    Case("socket buffers", UNKNOWN, "rmem_max", "", {"proc/sys/net/core/rmem_max": None}),
    Case("ROS domain", NOTE, "robots of others", "ROS_DOMAIN_ID=42", machine=NO_DOMAIN),
    Case("ROS domain", OK, "this machine only", "", machine=environment(ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST")),
    Case("ROS domain", OK, "this machine only", "", machine=environment(ROS_LOCALHOST_ONLY="1")),
    Case("ROS domain", LACKS, "ROS_DOMAIN_ID=300", "export", machine=environment(ROS_DOMAIN_ID="300")),
    Case("ROS domain", LACKS, "ROS_DOMAIN_ID=a", "export", machine=environment(ROS_DOMAIN_ID="a")),
    Case("ROS domain", NOTE, "150: its ports", "export", machine=environment(ROS_DOMAIN_ID="150")),
    Case("ROS discovery", LACKS, "do not find", "LOCALHOST", machine=environment(ROS_AUTOMATIC_DISCOVERY_RANGE="OFF")),
    Case("ROS discovery", NOTE, "=NEAR", "SUBNET", machine=environment(ROS_AUTOMATIC_DISCOVERY_RANGE="NEAR")),
]  # fmt: skip


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.check}: {case.words}")
def test_what_is_missing_is_told_with_what_mends_it(good: Machine, case: Case) -> None:
    lay_out(good.root, case.files)
    machine = replace(good, **case.machine)
    for realtime in (False, True):
        found = {finding.name: finding for finding in examine(machine, realtime=realtime).findings}[case.check]
        expected = Level.LACKS if realtime and case.for_realtime else case.level
        assert (found.level, case.words in found.text) == (expected, True), found
        assert case.mend in found.mend
        assert (found.mend == "") == (case.mend == "")


def test_a_folder_with_nothing_in_it_is_no_error(tmp_path: Path) -> None:
    diagnosis = examine(Machine(root=tmp_path, environment={}))
    assert len(diagnosis.findings) == len(CHECKS)
    assert [finding.name for finding in diagnosis.findings if finding.level is Level.LACKS] == ["shared memory"]


def test_the_report_has_a_line_each_and_the_commands_below(good: Machine) -> None:
    diagnosis = examine(replace(good, limit=limits(rtprio=(0, 0))), realtime=True)
    lines = diagnosis.text().splitlines()
    at = next(k for k, line in enumerate(lines) if line.startswith("lacks  rtprio limit"))
    assert lines[at + 1].split("$ ")[1].startswith("sudo groupadd")
    assert lines[-1] == "this machine lacks something for real time at 1 kHz: rtprio limit"
    assert "\033" not in diagnosis.text()
    assert "\033[31mlacks\033[0m  rtprio limit" in diagnosis.text(coloured=True)


def test_the_command_reports_and_its_exit_code_tells(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    root = tmp_path / "root"
    lay_out(root, GOOD)
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    monkeypatch.delenv("ROS_AUTOMATIC_DISCOVERY_RANGE", raising=False)
    assert main(["doctor", "--root", str(root), "--json", str(tmp_path / "report.json")]) == 0
    assert "this machine has what 1 kHz needs" in capsys.readouterr().out
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["ok"]
    assert {finding["name"] for finding in report["findings"]} >= {"kernel", "rtprio limit", "serial latency"}
    lay_out(root, {"sys/bus/usb-serial/devices/ttyUSB0/latency_timer": "16"})
    assert main(["doctor", "--root", str(root)]) == 1
    assert main(["doctor", "--root", str(root / "none")]) == 1
    assert main(["doctor", "--root", str(root), "--json", str(tmp_path / "no/report.json")]) == 1
    assert "cannot be written" in capsys.readouterr().err


def test_it_looks_at_the_machine_it_runs_on(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor"]) in (0, 1)
    lines = capsys.readouterr().out.splitlines()
    cores = next(line for line in lines if " cores " in line)
    assert str(len(os.sched_getaffinity(0))) in cores or "one" in cores
