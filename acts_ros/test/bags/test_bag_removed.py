# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Bags that somebody removes, or moves elsewhere, while they are written."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Any

import pytest

from acts_core.errors import RecordingError
from acts_ros.bags.message_types import Definitions
from acts_ros.bags.reading import open_bag
from acts_ros.bags.writing import BagWriter

STRING = "std_msgs/msg/String"
GONE = r"cannot write to the bag '.*touch': No such file or directory. It is not there any more: deleted, or moved."


def begun(path: Path) -> tuple[BagWriter, Any]:
    """A bag with a message on the disk, and its topic."""
    bag = BagWriter(path)
    topic = bag.add_topic("/word", STRING, *Definitions().describe(STRING), [])
    bag.write(topic, bytes(40))
    bag.flush()
    return bag, topic


@pytest.mark.parametrize("what", ["folder", "file"])
def test_a_bag_that_was_deleted_is_told_at_once(what: str, tmp_path: Path) -> None:
    bag, topic = begun(tmp_path / "touch")
    if what == "folder":
        shutil.rmtree(bag.path)
    else:
        (bag.path / "touch.mcap").unlink()
    bag.write(topic, bytes(40))
    with pytest.raises(RecordingError, match=GONE):
        bag.flush()
    bag.close()


def test_a_file_system_that_does_not_count_names_takes_a_bag(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real = os.fstat
    monkeypatch.setattr(os, "fstat", lambda number: os.stat_result((*real(number)[:3], 0, *real(number)[4:])))
    bag, _ = begun(tmp_path / "touch")
    bag.close()
    with open_bag(bag.path) as read:
        assert len(list(read.messages(["/word"]))) == 1


def test_a_bag_that_was_moved_is_gone_on_with(tmp_path: Path) -> None:
    bag, topic = begun(tmp_path / "touch")
    bag.path.rename(tmp_path / "moved")
    bag.write(topic, bytes(40))
    bag.flush()
    with pytest.raises(RecordingError, match=GONE):
        bag.close()
    with open_bag(tmp_path / "moved") as moved:
        assert len(list(moved.messages(["/word"]))) == 2
