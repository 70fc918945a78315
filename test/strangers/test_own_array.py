# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""docs/own_array.md with the sketch of examples/arduino_16x16 behind a pseudo-terminal. ROS_DOMAIN_ID 192."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import termios
import tty
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from launch_support import START_S

from acts_core.array import ArrayGeometry
from acts_msgs.msg import Contact
from acts_tools.cli import main
from acts_tools.testing.launch_runner import launched

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "own_array.md").read_text()
PORT = "/dev/ttyUSB0"


@pytest.fixture(scope="module")
def sketch(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sketch, compiled for this machine."""
    compiler = shutil.which("g++")
    assert compiler is not None, "g++ is missing, which builds the firmware as well"
    program = tmp_path_factory.mktemp("sketch") / "arduino_16x16"
    source = ROOT / "examples" / "arduino_16x16" / "arduino_16x16.ino"
    model = ["-include", str(ROOT / "test" / "arduino_model" / "Arduino.h")]
    command = [compiler, "-std=c++17", "-Wall", "-Werror", "-pthread", *model, "-x", "c++", str(source)]
    subprocess.run([*command, "-o", str(program)], check=True)
    return program


@pytest.fixture
def port(sketch: Path) -> Iterator[str]:
    """Where the Arduino prints."""
    master, slave = os.openpty()
    tty.setraw(slave)
    with subprocess.Popen([str(sketch)], stdout=master) as arduino:
        os.close(master)
        yield os.ttyname(slave)
        arduino.kill()
        os.close(slave)


def words_of(command: str, port: str) -> list[str]:
    """Words of the page's line that begins with a command, with this port in the place of the page's."""
    line = re.findall(rf"^    {command} (.*?)(?:  +#.*)?$", PAGE, re.MULTILINE)[0]
    return [word.replace(PORT, port).replace("examples/", f"{ROOT}/examples/") for word in line.split()]


def speed_of(port: str) -> int:
    descriptor = os.open(port, os.O_RDWR | os.O_NOCTTY)
    try:
        return int(termios.tcgetattr(descriptor)[5])
    finally:
        os.close(descriptor)


def test_from_the_lines_of_an_arduino_to_contacts(port: str) -> None:
    package, file, *arguments = words_of("acts launch", port)
    given: dict[str, Any] = dict(word.split(":=", 1) for word in arguments)
    with launched(package, file, domain_id=192, **given) as launch:
        contact = launch.wait_for_messages("/plate/contact", Contact, 10, START_S)[-1]
        speed = speed_of(port)
        assert launch.stop() == 0
    geometry = ArrayGeometry(16, 16, 0.010)
    assert contact.in_contact
    assert contact.centre_of_pressure.x == pytest.approx(float(geometry.x_m(11)), abs=0.001)
    assert contact.centre_of_pressure.y == pytest.approx(float(geometry.y_m(5)), abs=0.001)
    assert contact.peak == pytest.approx(600, abs=1)
    assert speed == termios.B1000000


def test_the_first_self_test(port: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--no-touch", "--untouched-s", "1", "--picture", str(tmp_path / "selftest.png")]
    code = main(["selftest", *words_of("acts selftest", port), *words])
    said = capsys.readouterr().out
    assert "16 x 16" in said
    assert re.search(r"WARN +time per taxel", said)
    # Something lies on this skin.
    assert re.search(r"FAIL +high taxels", said)
    assert code == 1
    assert speed_of(port) == termios.B1000000
