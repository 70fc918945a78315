# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts diagnostics`: its table and exit codes, and the command on a publisher of this process; ROS_DOMAIN_ID 189."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from acts_skins.overview.aggregate import Status
from acts_tools.cli import main
from acts_tools.diagnostics.statuses import Statuses
from acts_tools.testing.probe import Probe

pytestmark = pytest.mark.slow

TOPICS = ("/diagnostics", "/diagnostics_agg")


def statuses(*levels: int) -> Statuses:
    heard = Statuses(TOPICS)
    for number, level in enumerate(levels):
        heard.take(
            TOPICS[0], Status(f"plate/node{number}", level, f"word {number}", "port", {"rate_hz": "987", "a": ""})
        )
    return heard


@pytest.mark.parametrize(("levels", "worst"), [((), 0), ((0, 0), 0), ((0, 1), 1), ((2, 1), 2), ((3, 0), 3), ((9,), 2)])
def test_the_worst_level_is_the_exit_code(levels: tuple[int, ...], worst: int) -> None:
    assert statuses(*levels).worst == worst
    assert statuses(*levels).is_empty is not bool(levels)


def test_the_table_has_level_name_message_and_values() -> None:
    heard = statuses(0, 2)
    heard.take(TOPICS[1], Status("/Skins", 3, "all stale"))
    assert list(heard.lines(with_values=True)) == [
        "/diagnostics",
        "  OK     plate/node0  word 0 [port]",
        "           rate_hz  987",
        "           a",
        "  ERROR  plate/node1  word 1 [port]",
        "           rate_hz  987",
        "           a",
        "/diagnostics_agg",
        "  STALE  /Skins  all stale",
    ]
    assert len(list(heard.lines(with_values=False))) == 5


def test_json_has_it_all_and_the_newest_counts() -> None:
    heard = statuses(2)
    heard.take(TOPICS[0], Status("plate/node0", 0, "well again", "port", {"rate_hz": "1000"}))
    assert json.loads(json.dumps(heard.as_json())) == {
        "/diagnostics": [
            {
                "name": "plate/node0",
                "level": "OK",
                "message": "well again",
                "hardware_id": "port",
                "values": {"rate_hz": "1000"},
            }
        ]
    }


def test_a_node_that_has_fallen_silent_is_stale_and_told_with_its_last_report() -> None:
    heard = Statuses(TOPICS)
    heard.take(TOPICS[0], Status("plate/driver", 0, "1000 frames/s", "port"), now_s=10.0)
    heard.take(TOPICS[0], Status("plate/reconstruction", 1, "busy"), now_s=14.9)
    heard.tell_silent(15.0)
    assert list(heard.lines(with_values=False)) == [
        "/diagnostics",
        "  STALE  plate/driver          silent for 5.0 s; before: OK, 1000 frames/s [port]",
        "  WARN   plate/reconstruction  busy",
    ]
    assert heard.worst == 3


@contextmanager
def publishing(probe: Probe, level: bytes) -> Iterator[None]:
    """Somebody who reports again and again, from a thread."""
    publisher = probe.node.create_publisher(DiagnosticArray, "/diagnostics", 10)
    status = DiagnosticStatus(
        level=level, name="plate/driver", message="5 frames lost", values=[KeyValue(key="lost", value="5")]
    )
    ended = threading.Event()

    def publish() -> None:
        while not ended.wait(0.1):
            publisher.publish(DiagnosticArray(status=[status]))

    thread = threading.Thread(target=publish)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def test_the_command_prints_what_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "189")
    command = [sys.executable, "-m", "acts_tools", "diagnostics"]
    with Probe(189) as probe, publishing(probe, DiagnosticStatus.WARN):
        result = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (result.returncode, result.stderr) == (1, "")
    assert result.stdout.splitlines() == ["/diagnostics", "  WARN   plate/driver  5 frames lost", "           lost  5"]


def test_the_command_names_a_node_that_falls_silent_while_it_watches(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "189")
    command = [sys.executable, "-m", "acts_tools", "diagnostics", "--timeout", "60", "--watch", "4"]
    with Probe(189) as probe, subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        # Reliable: what is published once it is matched arrives.
        publisher = probe.node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        probe.wait_for(publisher.get_subscription_count, 60, "the command's subscription")
        publisher.publish(DiagnosticArray(status=[DiagnosticStatus(name="plate/driver", message="1000 frames/s")]))
        told, _ = process.communicate(timeout=60)
    assert process.returncode == 3
    assert "  STALE  plate/driver  silent for " in told
    assert " s; before: OK, 1000 frames/s" in told


def test_where_nobody_reports_it_says_so(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "189")
    assert main(["diagnostics", "--timeout", "0.2"]) == 3
    assert "no node has reported on /diagnostics or /diagnostics_agg within 0.2 s" in capsys.readouterr().err


def test_interrupted_before_anything_came_it_does_not_say_that_nobody_reports() -> None:
    command = [sys.executable, "-m", "acts_tools", "diagnostics", "--timeout", "60"]
    with (
        Probe(189) as probe,
        subprocess.Popen(
            command, env={**os.environ, "ROS_DOMAIN_ID": "189"}, stderr=subprocess.PIPE, text=True
        ) as process,
    ):
        probe.wait_for_node("/acts_diagnostics")
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=60)
        assert output is None
        assert errors == ""
    assert process.returncode == 130
