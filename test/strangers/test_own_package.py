# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The package of docs/own_package.md as it stands there, in a workspace on top of this one. ROS_DOMAIN_ID 118."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
from geometry_msgs.msg import PointStamped
from peers import Peers

from acts_core.array import ArrayGeometry
from acts_core.frames import SampleFrame, Scheme
from acts_msgs.msg import Contact, TactileSamples
from acts_ros.messages import SamplesMessage
from acts_ros.qos import STATE, STREAM

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("colcon") is None, reason="needs colcon: pip install colcon-common-extensions"),
]

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "own_package.md").read_text()
DEADLINE_S = 60.0
DOMAIN_ID = 118


def blocks(language: str) -> list[str]:
    """The page's blocks of code in a language."""
    return re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A workspace with the page's package, built."""
    folder = tmp_path_factory.mktemp("my_ws")
    package = folder / "src" / "my_touch"
    (setup, node), (left,) = blocks("python"), blocks("yaml")
    manifest, of_messages, launch_file = blocks("xml")
    messages = {
        "package.xml": of_messages,
        "CMakeLists.txt": blocks("cmake")[0],
        "msg/Grip.msg": blocks("text")[0],
    }
    files = {
        "package.xml": manifest,
        "setup.py": setup,
        "setup.cfg": blocks("ini")[0],
        "resource/my_touch": "",
        "my_touch/__init__.py": "",
        "my_touch/force.py": node,
        "launch/two_skins.launch.xml": launch_file,
        "launch/left.yaml": left,
        "launch/right.yaml": left.replace("/left", "/right").replace("m: 64", "m: 128"),
    }
    for name, text in files.items():
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text(text)
    for name, text in messages.items():
        path = folder / "src" / "my_msgs" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    in_overlay(folder, "true", "colcon build")
    return folder


def in_overlay(folder: Path, command: str, before: str = "true") -> str:
    """What a command prints in a shell that has sourced the workspace."""
    words = ["bash", "-c", f"{before} && source install/setup.bash && {command}"]
    finished = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=DEADLINE_S)
    assert finished.returncode == 0, finished.stdout + finished.stderr
    return finished.stdout


@pytest.mark.alone  # it builds the workspace
def test_its_launch_file_starts_ours_twice_with_parameters_of_their_own(workspace: Path) -> None:
    share = workspace / "install" / "my_touch" / "share" / "my_touch"
    printed = in_overlay(workspace, "acts launch my_touch two_skins.launch.xml --own --print")
    for side in ("left", "right"):
        (skin,) = (line for line in printed.splitlines() if "lib/acts_skins/tactile" in line and f"/{side}" in line)
        assert f"--params-file {share}/launch/{side}.yaml" in skin
        assert f"__ns:=/{side}" in skin
        assert re.search(rf"--set driver\.port=/dev/shm/acts-\w+/{side}/board ", skin)
    assert re.search(r"lib/my_touch/force .*__ns:=/left", printed)
    with_boards = in_overlay(workspace, "acts launch my_touch two_skins.launch.xml --own --print sim:=false")
    assert "virtual_board" not in with_boards
    assert with_boards.count("--set driver.port=params_file ") == 2


def test_its_node_recovers_frames_and_ends_in_order(workspace: Path) -> None:
    rows, cols = np.indices((32, 32))
    counts = np.rint(600 * np.exp(-((rows - 9) ** 2 + (cols - 20) ** 2) / 4)).astype(np.uint16).ravel()
    frame = SampleFrame(1, 0, 900, Scheme.RASTER, 32, 32, 0, np.arange(1024, dtype=np.uint16), counts)
    program = workspace / "install" / "my_touch" / "lib" / "my_touch" / "force"
    source = f"source {workspace}/install/setup.bash && exec {program}"
    process = subprocess.Popen(["bash", "-c", source], env={**os.environ, "ROS_DOMAIN_ID": str(DOMAIN_ID)})
    peers = Peers(DOMAIN_ID, "skin")
    peers.timeout_s = DEADLINE_S
    heard = peers.listen(PointStamped, "pressed", STATE)
    try:
        message = SamplesMessage("left")
        publisher = peers.peer.create_publisher(TactileSamples, "samples", STREAM)

        def publish() -> None:
            assert process.poll() is None
            publisher.publish(message.fill(frame, time.time_ns()))

        peers.until(lambda: heard, publish)
        process.send_signal(signal.SIGINT)
        assert process.wait(DEADLINE_S) == 0
    finally:
        process.kill()
        process.wait()
        peers.close()
    geometry, point = ArrayGeometry(), heard[0].point
    assert heard[0].header.frame_id == "left"
    assert (point.x, point.y) == pytest.approx((float(geometry.x_m(20)), float(geometry.y_m(9))), abs=1e-3)


def test_its_message_is_one_of_the_workspace(workspace: Path) -> None:
    asked = "from my_msgs.msg import Grip; print(Grip(firmness=0.5).firmness)"
    assert in_overlay(workspace, f"python3 -c '{asked}'").strip() == "0.5"


def test_its_node_in_cpp_reads_fields_that_there_are() -> None:
    fields = set(re.findall(r"\bcontact\.(\w+)", blocks("cpp")[0].partition("class ")[2]))
    assert fields == {"header", "in_contact", "force"}
    assert fields <= set(Contact.get_fields_and_field_types())
