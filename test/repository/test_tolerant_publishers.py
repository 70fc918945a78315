# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""No node ends, and no thread that holds a robot, because the middleware did not take a message."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# The goals of a hand, which have to be known not to be sent; and a measurement.
RAISING = {"acts_control/hand/nodes/motor_node.py": 1, "acts_tools/bench/cases/frame_parts.py": 1}


def test_services_are_asked_in_one_place() -> None:
    asking = [path.name for path in ROOT.glob("acts_*/acts_*/**/*.py") if ".call_async(" in path.read_text()]
    assert asking == ["middleware.py"]


def test_publishers_of_nodes_are_tolerant() -> None:
    found = 0
    raising: dict[str, int] = {}
    for path in ROOT.glob("acts_*/acts_*/**/*.py"):
        text = path.read_text()
        for call in re.findall(r"create_publisher\((?:[^()]|\([^()]*\))*\)", text):
            found += 1
            if "publisher_class=TolerantPublisher" not in call and "**published(" not in call:
                name = path.relative_to(ROOT / path.relative_to(ROOT).parts[0]).as_posix()
                raising[name] = raising.get(name, 0) + 1
        assert text.count("create_publisher(") == len(re.findall(r"create_publisher\((?:[^()]|\([^()]*\))*\)", text))
    assert found > 30
    assert raising == RAISING
