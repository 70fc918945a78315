# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Commands that are given a name that nothing has say which one may have been meant; ROS_DOMAIN_ID 152."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from rclpy.node import Node
from spinning import spinning_node
from std_srvs.srv import Trigger
from waiting import wait_for

from acts_core.errors import SettingsError
from acts_msgs.msg import Contact
from acts_ros.qos import STREAM
from acts_tools.cli import main
from acts_tools.driver.command import parameters_of
from acts_tools.running.near_names import did_you_mean

DEADLINE_S = 60.0


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("/plate/contct", "; did you mean /plate/contact?"),
        ("/contact", "; did you mean /left/contact or /plate/contact?"),
        ("contcat", ""),
        ("/nobody", ""),
        # All of it but the namespace, which they share, is another.
        ("/plate/twst", ""),
        ("/plate/contact", "; did you mean /plate/contacts?"),
    ],
)
def test_what_may_have_been_meant(name: str, words: str) -> None:
    names = ["/plate/contacts", "/plate/contact", "/left/contact", "/plate/contact"]
    assert did_you_mean(name, names) == words


@pytest.fixture
def plate(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    """A node `gains` in namespace /plate, with a topic, a service and a parameter."""
    monkeypatch.setenv("ROS_DOMAIN_ID", "152")
    for module in ("driver.command.FOUND_S", "parameters.command.FOUND_S", "services.command.FOUND_S"):
        monkeypatch.setattr(f"acts_tools.{module}", 0.5)

    def furnish(node: Node) -> None:
        node.create_publisher(Contact, "contact", STREAM)
        node.create_service(Trigger, "driver/tare", lambda _request, response: response)
        node.declare_parameter("stiffness", 1.0)

    with spinning_node("gains", "/plate", 152, furnish) as node:
        yield node


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("echo -d 0.5 /contact", "/contact: no publisher found; did you mean /plate/contact?"),
        ("listen -d 0.5 --every 0.1 /contact", "/contact  no publisher found yet; did you mean /plate/contact?"),
        ("record -d 0.5 -o BAG /contact", "/contact, no publisher was found; did you mean /plate/contact?"),
        ("driver -n plat tare", "with this ROS_DOMAIN_ID; did you mean /plate/driver/tare?"),
        ("call /plate/driver/tar", "lists those there are; did you mean /plate/driver/tare?"),
        ("param /gains", "with this ROS_DOMAIN_ID; did you mean /plate/gains?"),
        ("param /plate/gain", "with this ROS_DOMAIN_ID; did you mean /plate/gains?"),
        ("param /plate/gains stifness", "lists those it has; did you mean stiffness?"),
    ],
)
def test_commands_say_it(words: str, told: str, plate: Node, capfd: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    def says_it() -> bool:
        """Once the command has found the node: how long that takes is the middleware's matter."""
        shutil.rmtree(tmp_path / "bag", ignore_errors=True)
        assert main(words.replace("BAG", str(tmp_path / "bag")).split()) == 1
        output = capfd.readouterr()
        return told in output.out + output.err

    wait_for(says_it, told, DEADLINE_S)


def test_a_node_is_not_likened_to_others_for_the_service_that_all_have(
    plate: Node, capfd: pytest.CaptureFixture[str]
) -> None:
    def others_are_found() -> bool:
        assert main(["param", "/gains"]) == 1
        return "did you mean" in capfd.readouterr().err

    wait_for(others_are_found, "the node", DEADLINE_S)
    assert main(["param", "/nosuch"]) == 1
    told = capfd.readouterr().err
    assert "no node offers /nosuch/list_parameters" in told
    assert "did you mean" not in told
    # Another node takes parameters, too, but it is no driver.
    assert main(["driver", "-n", "plate", "set", "m=64"]) == 1
    told = capfd.readouterr().err
    assert "no driver offers /plate/driver/set_parameters_atomically" in told
    assert "did you mean" not in told


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("echo -d 1 /nobody", "/nobody: no publisher found yet. Ctrl-C ends the waiting"),
        ("record -d 1 -o BAG /nobody", "not there yet: /nobody, no publisher found"),
    ],
)
def test_who_waits_for_long_is_told_meanwhile(
    words: str, told: str, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "152")
    monkeypatch.setattr("acts_tools.running.near_names.NOTICE_S", 0.0)
    assert main(words.replace("BAG", str(tmp_path / "bag")).split()) == 1
    output = capfd.readouterr()
    assert (output.out + output.err).count(told) == 1


def test_a_misspelt_parameter_of_a_board_is_told() -> None:
    with pytest.raises(SettingsError, match=r"shceme=tracking: needed is NAME=VALUE .*; did you mean scheme\?"):
        parameters_of(["shceme=tracking"])


def test_a_launch_file_without_its_package_is_told(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", "tactile.launch.xml", "--own"]) == 1
    told = "'tactile.launch.xml' does not exist; did you mean acts launch acts_bringup tactile.launch.xml?"
    assert told in capfd.readouterr().err
    assert main(["launch", "nothing.launch.xml", "--own"]) == 1
    assert "did you mean" not in capfd.readouterr().err
