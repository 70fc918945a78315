# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts info`, without a node."""

from __future__ import annotations

import time
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path

import pytest
from bag_of_strings import make_bag

from acts_tools.cli import main

STRING = "std_msgs/msg/String"
SEVEN_O_CLOCK_MS = 1_700_031_600_000


@pytest.fixture(autouse=True)
def _in_utc(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    with monkeypatch.context() as patched:
        patched.setenv("TZ", "UTC")
        time.tzset()
        yield
    time.tzset()


def told(path: Path, capsys: pytest.CaptureFixture[str]) -> list[str]:
    assert main(["info", str(path)]) == 0
    return capsys.readouterr().out.splitlines()


def test_topics_types_counts_and_rates_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    stamps_ms = [SEVEN_O_CLOCK_MS + 500 * number for number in range(9)]
    make_bag(tmp_path / "bag", {"/word": STRING, "/a/longer/name": STRING}, stamps_ms, monkeypatch)
    lines = told(tmp_path / "bag", capsys)
    assert lines == [
        "9 messages from 2023-11-15 07:00:00+00:00, 4.0 s long",
        "topic           type                 messages  a second",
        "/a/longer/name  std_msgs/msg/String         4       1.0",
        "/word           std_msgs/msg/String         5       1.2",
    ]
    (file,) = (tmp_path / "bag").glob("*.mcap")
    assert told(file, capsys) == lines


def test_what_a_killed_recorder_has_left_is_told_with_a_note(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    make_bag(tmp_path / "bag", {"/word": STRING}, [1000, 2000], monkeypatch)
    (tmp_path / "bag" / "metadata.yaml").unlink()
    note, *lines = told(tmp_path / "bag", capsys)
    assert note.startswith("note: the bag ")
    assert "was never closed" in note
    assert lines == [
        "2 messages from 1970-01-01 00:00:01+00:00, 1.0 s long",
        "topic  type                 messages  a second",
        "/word  std_msgs/msg/String         2       2.0",
    ]


def test_a_single_message_and_none_have_no_rate(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    make_bag(tmp_path / "one", {"/word": STRING, "/other": STRING}, [1000], monkeypatch)
    assert told(tmp_path / "one", capsys)[2:] == [
        "/other  std_msgs/msg/String         0",
        "/word   std_msgs/msg/String         1",
    ]
    make_bag(tmp_path / "none", {"/word": STRING}, [], monkeypatch)
    assert told(tmp_path / "none", capsys) == [
        "no message; 1 topic",
        "topic  type                 messages  a second",
        "/word  std_msgs/msg/String         0",
    ]


@pytest.mark.parametrize("is_closed", [True, False])
def test_messages_of_one_moment_have_no_rate(
    is_closed: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    make_bag(tmp_path / "bag", {"/word": STRING}, [1000, 1000, 1000], monkeypatch)
    if not is_closed:
        (tmp_path / "bag" / "metadata.yaml").unlink()
    assert told(tmp_path / "bag", capsys)[-3:] == [
        "3 messages from 1970-01-01 00:00:01+00:00, 0.0 s long",
        "topic  type                 messages  a second",
        "/word  std_msgs/msg/String         3",
    ]


def test_a_topic_of_a_type_that_is_not_installed_is_told_and_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    make_bag(tmp_path / "bag", {"/word": STRING, "/grip": "their_msgs/msg/Grip"}, [1000, 2000], monkeypatch)
    lines = told(tmp_path / "bag", capsys)
    assert "/grip  their_msgs/msg/Grip         1" in lines
    assert lines[-1].startswith(
        "not readable here: /grip: unknown message type 'their_msgs/msg/Grip': install or source"
    )


@pytest.mark.parametrize("stamp_ms", [0, 9_223_372_036_854])
def test_any_stamp_is_told(
    stamp_ms: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    make_bag(tmp_path / "bag", {"/word": STRING}, [stamp_ms], monkeypatch)
    when = told(tmp_path / "bag", capsys)[0].removeprefix("1 message from ").partition(",")[0]
    assert datetime.fromisoformat(when).timestamp() == stamp_ms // 1000


def test_what_is_no_bag_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", str(tmp_path / "none")]) == 1
    assert "there is no bag" in capsys.readouterr().err
    assert main(["info", str(tmp_path)]) == 1
    assert "holds no bag that can be read" in capsys.readouterr().err
