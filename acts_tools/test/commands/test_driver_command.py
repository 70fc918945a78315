# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts driver` as a user runs it, on a driver process with a virtual board; ROS_DOMAIN_ID 119."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from rclpy.client import Client
from std_srvs.srv import Trigger

from acts_core.errors import ArrayError, SettingsError
from acts_msgs.msg import BoardState
from acts_tools.bench.rigs.processes import virtual_board
from acts_tools.cli import main
from acts_tools.driver.command import parameters_of
from acts_tools.testing.probe import Probe

pytestmark = pytest.mark.slow

DEADLINE_S = 60.0


@pytest.fixture
def driver(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A driver of a virtual board, in namespace /hand, that has heard from it."""
    monkeypatch.setenv("ROS_DOMAIN_ID", "119")
    with virtual_board(tmp_path, "--board-id", "77") as board:
        process = subprocess.Popen(
            [
                sys.executable,
                "-m",
                "acts_ros.executables.program",
                "acts_driver.nodes.driver_node",
                "--ros-args",
                "-r",
                "__ns:=/hand",
                "-p",
                f"port:={board.link}",
            ],
            env=dict(os.environ),
        )
        try:
            # The command looks for a driver for a few seconds only, and before a board has answered it is told of a
            # setting only once it has.
            with Probe(119) as probe:
                probe.wait_for_message("/hand/board", BoardState, DEADLINE_S, lambda state: state.answers)
            yield
        finally:
            process.terminate()
            process.wait(DEADLINE_S)


def test_a_driver_is_asked_and_told(driver: None, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["driver", "-n", "hand", "set", "m=128", "scheme=tracking"]) == 0
    assert "m=128" in capsys.readouterr().out
    assert main(["driver", "-n", "/hand", "query"]) == 0
    text = capsys.readouterr().out
    assert "board 77, firmware 0.1.0" in text
    assert "tracking, M = 128" in text
    assert main(["driver", "-n", "hand", "set", "scheme=uniform", "m=57"]) == 1
    assert re.match("error: .*no uniform grid", capsys.readouterr().err)
    assert main(["driver", "-n", "hand", "set", "m=2000"]) == 1
    assert capsys.readouterr().err.startswith("error: m = 2000: an array of 32 x 32 has 1024 taxels")
    # Whether it may depends on how much of the skin has been seen; it answers either way.
    refused = main(["driver", "-n", "hand", "tare"])
    told = capsys.readouterr()
    assert told.err.startswith("error: ") if refused else told.out.startswith("tared ")


def test_a_driver_is_taken_through_its_states(driver: None, capsys: pytest.CaptureFixture[str]) -> None:
    for transition, state in (
        ("deactivate", "inactive"),
        ("cleanup", "unconfigured"),
        ("configure", "inactive"),
        ("activate", "active"),
    ):
        assert main(["driver", "-n", "hand", transition]) == 0
        assert capsys.readouterr().out == f"{state}\n"
    assert main(["driver", "-n", "hand", "cleanup"]) == 1
    assert capsys.readouterr().err == "error: /hand/driver is active: allowed is deactivate, not cleanup\n"
    # It goes on as before.
    assert main(["driver", "-n", "hand", "query"]) == 0
    assert "board 77" in capsys.readouterr().out


def test_a_driver_that_cannot_open_its_port_says_where_the_reason_is(
    driver: None, capsys: pytest.CaptureFixture[str]
) -> None:
    for words in ("driver -n hand deactivate", "driver -n hand cleanup", "param /hand/driver port=/nowhere"):
        assert main(words.split()) == 0
    capsys.readouterr()
    assert main(["driver", "-n", "hand", "configure"]) == 1
    told = "error: /hand/driver did not configure and is unconfigured; its log has the reason\n"
    assert capsys.readouterr().err == told


def test_parameters_have_the_types_they_are_declared_with() -> None:
    found = parameters_of(["m=64", "rate_cap_hz=500", "scheme=tracking", "model="])
    assert found == {"m": 64, "rate_cap_hz": 500.0, "scheme": "tracking", "model": ""}
    assert type(found["rate_cap_hz"]) is float
    assert parameters_of(["model=a.npz"]) == {"model": str(Path.cwd() / "a.npz")}
    assert parameters_of(["layout=own.yaml"]) == {"layout": str(Path.cwd() / "own.yaml")}
    assert parameters_of(["layout=glove"]) == {"layout": "glove"}
    with pytest.raises(ArrayError, match="layout 'glvoe': allowed is one of square"):
        parameters_of(["layout=glvoe"])
    for word, told in (
        ("m=5000", "m = 5000: allowed is 0 to 4096 (taxels measured per frame"),
        ("m=-1", "m = -1: allowed is 0 to 4096"),
        ("rate_cap_hz=nan", "rate_cap_hz = nan: allowed is a finite number, 0 to 1e+06"),
        (f"seed={2**63}", f"seed = {2**63}: allowed is -1 to {2**63 - 1}"),
        ("scheme=foo", "scheme = 'foo': allowed is one of empty, adaptive,"),
        ("m=many", "m = 'many': allowed is a value of type whole number, 0 to 4096"),
        ("m=1.5", "m = 1.5: allowed is a value of type whole number, 0 to 4096"),
        ("model=~no_such_person/a.npz", "~no_such_person/a.npz: Could not determine home directory"),
    ):
        with pytest.raises(SettingsError, match=re.escape(told)):
            parameters_of([word])
    for word in ("m", "port=auto"):
        with pytest.raises(SettingsError, match="needed is"):
            parameters_of([word])
    with pytest.raises(SettingsError, match="m=60: m is given twice"):
        parameters_of(["m=55", "scheme=tracking", "m=60"])


def test_words_that_are_no_namespace_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["driver", "-n", "left hand", "query"]) == 1
    assert capsys.readouterr().err.startswith("error: 'left hand' is no namespace: allowed are letters, digits")


def test_a_driver_that_is_not_there_is_named(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "119")
    monkeypatch.setattr("acts_tools.driver.command.FOUND_S", 0.1)
    assert main(["driver", "calibrate"]) == 1
    assert "no driver offers /plate/driver/calibrate" in capsys.readouterr().err
    assert main(["driver", "tare", "m=5"]) == 1
    assert main(["driver", "set"]) == 1


def test_a_driver_that_ends_before_it_answers_is_told_from_one_that_is_slow(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "119")
    with Probe(119) as probe:
        name = "/plate/driver/query_board"
        # Nobody calls back: it never answers.
        service = probe.node.create_service(Trigger, name, lambda _request, response: response)

        def end_when_asked() -> None:
            asked.wait(DEADLINE_S)
            probe.node.destroy_service(service)

        asked = threading.Event()
        ending = threading.Thread(target=end_when_asked)
        ending.start()
        call = Client.call_async

        def call_and_end(client: Client, request: object) -> object:
            future = call(client, request)
            asked.set()
            return future

        monkeypatch.setattr(Client, "call_async", call_and_end)
        assert main(["driver", "query"]) == 1
        assert f"{name} is gone and has not answered" in capsys.readouterr().err
        ending.join()
        service = probe.node.create_service(Trigger, name, lambda _request, response: response)
        monkeypatch.setattr("acts_tools.driver.command.ANSWER_S", 0.0)
        assert main(["driver", "query"]) == 1
        assert f"{name} has not answered within 0 s" in capsys.readouterr().err
