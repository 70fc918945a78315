# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts bench skins` for real and for a moment: what it counts, and how it ends. It chooses its ROS domains itself."""

from __future__ import annotations

import json
import os
import pty
import select
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest
from waiting import wait_for

pytestmark = pytest.mark.slow

DEADLINE_S = 240.0


def environment() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if name != "ROS_DOMAIN_ID"}


def command(*words: str) -> list[str]:
    return [sys.executable, "-m", "acts_tools", "bench", "skins", *words]


def measured(path: Path, *words: str) -> tuple[dict[str, Any], str]:
    done = subprocess.run(
        command("--json", str(path), *words),
        env=environment(),
        capture_output=True,
        text=True,
        timeout=DEADLINE_S,
        check=False,
    )
    assert path.exists(), done.stderr
    report = json.loads(path.read_text())
    # A machine that does not run a board for a quarter of a second loses frames, and that is told.
    assert done.returncode == (1 if report["problems"] else 0), done.stderr
    assert all("lost" in problem for problem in report["problems"])
    return report, done.stdout


def check_skin(skin: dict[str, Any], seconds: float) -> None:
    assert skin["received"] > 0
    assert skin["rate_hz"] == pytest.approx(skin["received"] / seconds, rel=1e-3)
    assert skin["lost"] >= 0
    assert {"lost", "overruns", "restarts"} <= skin["driver"].keys()
    assert skin["reconstruction"]["not_published"] >= 0
    latency_ms = [skin["latency_ms"][name] for name in ("median", "p99", "p999", "max")]
    assert latency_ms == sorted(latency_ms)
    # Nothing is received before it was measured, as far as the estimate of the board's clock is right.
    assert latency_ms[0] > 0


def test_one_skin_is_counted_timed_and_judged(tmp_path: Path) -> None:
    report, text = measured(tmp_path / "deep" / "one.json", "--seconds", "1")
    (skin,) = report["skins"]
    assert skin["name"] == "skin_1"
    assert 1.0 <= report["seconds"] < 30.0
    check_skin(skin, report["seconds"])
    assert report["cpu_percent"].keys() == {"bench", "virtual_board skin_1", "tactile skin_1"}
    assert report["rss_mb"].keys() == report["cpu_percent"].keys() == report["realtime_granted"].keys()
    assert all(percent > 0 for percent in report["cpu_percent"].values())
    assert report["cpu_percent_total"] == pytest.approx(sum(report["cpu_percent"].values()), abs=0.1)
    assert all(memory["start"] > 1 and memory["end"] > 1 for memory in report["rss_mb"].values())
    assert (report["load"], report["realtime"]) == (0, "off")
    assert set(report["realtime_granted"].values()) == {0}
    assert len(report["verdict"]) == 3
    assert "tactile skin_1" in text
    assert "wanted at most" in text


def test_two_skins_beside_a_busy_loop(tmp_path: Path) -> None:
    report, text = measured(tmp_path / "two.json", "--skins", "2", "--load", "1", "--seconds", "1", "--markdown")
    assert [skin["name"] for skin in report["skins"]] == ["skin_1", "skin_2"]
    for skin in report["skins"]:
        check_skin(skin, report["seconds"])
    assert {"tactile skin_1", "tactile skin_2", "load 1"} <= report["cpu_percent"].keys()
    assert report["cpu_percent_total"] < sum(report["cpu_percent"].values())
    assert report["verdict"] == []
    assert "| tactile skin_2 |" in text


def test_real_time_is_asked_for_and_what_was_granted_is_told(tmp_path: Path) -> None:
    report, text = measured(tmp_path / "fifo.json", "--realtime", "on", "--load", "1", "--seconds", "1")
    assert report["realtime"] == "on"
    asked = {"bench": 35, "virtual_board skin_1": 45, "tactile skin_1": 40}
    granted = report["realtime_granted"]
    assert granted.pop("load 1") == 0
    # Nothing where the limits of this machine do not allow it, and then that is told.
    assert all(granted[name] in (0, priority) for name, priority in asked.items())
    refused = [name for name, priority in granted.items() if not priority]
    assert [name for name in refused if name not in "".join(report["warnings"])] == []
    assert "in real time" in text


class Running:
    """A measurement of a minute on a terminal."""

    def __init__(self, path: Path) -> None:
        self._end, terminal = pty.openpty()
        words = command("--seconds", "60", "--json", str(path))
        self.process = subprocess.Popen(words, env=environment(), stdout=terminal, stderr=terminal)
        os.close(terminal)
        self.text = ""

    def read_until(self, words: str) -> None:
        wait_for(lambda: words in self.text, repr(words), DEADLINE_S, self._read, lambda: self.text)

    def _read(self) -> None:
        if select.select([self._end], [], [], 0.1)[0]:
            self.text += os.read(self._end, 4096).decode(errors="replace")

    def children(self) -> list[psutil.Process]:
        return psutil.Process(self.process.pid).children(recursive=True)

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        os.close(self._end)


@pytest.fixture
def running(tmp_path: Path) -> Iterator[Running]:
    made = Running(tmp_path / "report.json")
    yield made
    made.close()


def test_a_process_that_dies_is_named_with_the_end_of_its_log(running: Running, tmp_path: Path) -> None:
    running.read_until(" of 60 s: skin_1 ")
    children = running.children()
    (tactile,) = (child for child in children if any("acts_skins/tactile" in word for word in child.cmdline()))
    tactile.kill()
    running.read_until("error: tactile skin_1 ended early with code -9: ")
    running.read_until("reading ")
    assert running.process.wait(DEADLINE_S) == 1
    assert not (tmp_path / "report.json").exists()
    assert psutil.wait_procs(children, timeout=DEADLINE_S)[1] == []


def test_ctrl_c_ends_everything(running: Running) -> None:
    running.read_until(" of 60 s: skin_1 ")
    children = running.children()
    assert len(children) == 2
    running.process.send_signal(signal.SIGINT)
    assert running.process.wait(DEADLINE_S) == 130
    assert psutil.wait_procs(children, timeout=DEADLINE_S)[1] == []
    assert "Traceback" not in running.text
