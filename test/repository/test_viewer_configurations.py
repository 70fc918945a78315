# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Shipped layouts of RViz, Foxglove and PlotJuggler name topics that the README lists, and fields that they have."""

from __future__ import annotations

import importlib
import json
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from ament_index_python.packages import get_package_share_directory

ROOT = Path(__file__).parents[2]
FOLDER = Path(get_package_share_directory("acts_config")) / "viewers"
SKIN = "/plate"
RVIZ_TYPES = {
    "rviz_default_plugins/Image": "sensor_msgs/Image",
    "rviz_default_plugins/MarkerArray": "visualization_msgs/MarkerArray",
    "rviz_default_plugins/PointStamped": "geometry_msgs/PointStamped",
}


def listed_topics() -> dict[str, str]:
    """Full names of the topics in the README, and their types."""
    table = (ROOT / "README.md").read_text().partition("## Topics")[2].partition("\n## ")[0]
    found = {}
    for names, types in re.findall(r"^\| (`[^|]*) \| ([^|]*) \|", table, re.MULTILINE):
        kinds = re.findall(r"\w+_msgs/\w+", types)
        for name in re.findall(r"`([^`]+)`", names):
            if kinds:
                found[name if name.startswith("/") else f"{SKIN}/{name}"] = kinds[0]
    return found


TOPICS = listed_topics()


def require_field(path: str) -> None:
    """Fail unless a path of topic and fields, with slashes between, names a number."""
    topic = max((name for name in TOPICS if path.startswith(f"{name}/")), key=len, default="")
    assert topic, f"{path}: no such topic"
    package, name = TOPICS[topic].split("/")
    message: Any = getattr(importlib.import_module(f"{package}.msg"), name)()
    for field in path.removeprefix(f"{topic}/").split("/"):
        assert hasattr(message, field), f"{path}: {type(message).__name__} has no field {field}"
        message = getattr(message, field)
    assert isinstance(message, int | float), f"{path} is no number"


def test_topics_are_found_in_the_readme() -> None:
    assert TOPICS["/plate/contact"] == "acts_msgs/Contact"
    require_field("/plate/contact/force")
    with pytest.raises(AssertionError, match="no such topic"):
        require_field("/plate/touch/force")
    with pytest.raises(AssertionError, match="Contact has no field pressure"):
        require_field("/plate/contact/pressure")


def test_rviz() -> None:
    content = yaml.safe_load((FOLDER / "plate.rviz").read_text())
    manager = content["Visualization Manager"]
    assert manager["Global Options"]["Fixed Frame"] == SKIN.strip("/")
    shown = {one["Topic"]["Value"]: one["Class"] for one in manager["Displays"] if "Topic" in one}
    assert {topic: RVIZ_TYPES[kind] for topic, kind in shown.items()} == {topic: TOPICS[topic] for topic in shown}
    assert "/plate/image" in shown
    # What is published best effort reaches no reliable subscription.
    assert all(one["Topic"]["Reliability Policy"] == "Best Effort" for one in manager["Displays"] if "Topic" in one)


def test_foxglove() -> None:
    content = json.loads((FOLDER / "plate_foxglove.json").read_text())
    panels = content["configById"]
    assert sorted(places(content["layout"])) == sorted(panels)
    topics = [panels["Image!picture"]["imageMode"]["imageTopic"], *panels["3D!contacts"]["topics"]]
    topics += [panel["topicToRender"] for panel in panels.values() if "topicToRender" in panel]
    assert set(topics) <= set(TOPICS)
    paths = [path["value"] for panel in panels.values() for path in panel.get("paths", ())]
    assert len(paths) == 7
    for path in paths:
        require_field(path.replace(".", "/"))


def places(layout: Any) -> Iterator[str]:
    """Panels in a layout, which is a panel or is divided in two."""
    if isinstance(layout, str):
        yield layout
    else:
        assert layout["direction"] in ("row", "column")
        yield from places(layout["first"])
        yield from places(layout["second"])


def test_plotjuggler() -> None:
    root = ET.parse(FOLDER / "plate_plotjuggler.xml").getroot()
    assert root.tag == "root"
    for splitter in root.iter("DockSplitter"):
        shares = [float(share) for share in splitter.attrib["sizes"].split(";")]
        assert len(shares) == len(splitter) == int(splitter.attrib["count"])
        assert sum(shares) == pytest.approx(1.0, abs=1e-3)
    curves = [curve.attrib["name"] for curve in root.iter("curve")]
    assert len(curves) == 13
    for curve in curves:
        require_field(curve)
