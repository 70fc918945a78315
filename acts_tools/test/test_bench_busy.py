"""`acts bench busy`, much shorter than it is meant to be, in a process of its own. ROS_DOMAIN_ID 147."""

import json
import os
import subprocess
import sys
from pathlib import Path

DEADLINE_S = 120.0


def test_contacts_are_dated_under_both_schedulers(tmp_path: Path) -> None:
    finished = subprocess.run(
        [sys.executable, "-m", "acts_tools", "bench", "busy", "--seconds", "2", "--out", str(tmp_path)],
        capture_output=True,
        text=True,
        timeout=DEADLINE_S,
        env={**os.environ, "ROS_DOMAIN_ID": "147", "ROS_PYTHON_CHECK_FIELDS": "1"},
    )
    report = (tmp_path / "bench.json").read_text()
    measured = json.loads(report)["measurements"]["busy"]
    figures = {figure["key"]: figure["value"] for figure in measured["figures"]}
    assert figures["ordinary_contacts"] > 0
    if finished.returncode == 1:
        # Where SCHED_FIFO is not allowed, it is told.
        assert any("SCHED_FIFO" in problem for problem in measured["problems"]), finished
        return
    assert finished.returncode == 0, finished
    assert figures["fifo_contacts"] > 0
    assert figures["ratio"] > 0.0
