# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recording from the page: begun, ended and fetched by messages and in a real browser; ROS_DOMAIN_ID 193."""

from __future__ import annotations

import json
import re
import shutil
import time
from collections.abc import Callable, Iterator, Sequence
from datetime import datetime, tzinfo
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.serialization import deserialize_message
from spinning import Spinning
from view_browser import expect, needs_browser
from view_node_bench import header_where
from waiting import wait_for
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

import acts_view.recording.recording
from acts_core.frames import SampleFrame, Scheme
from acts_driver.baseline import Baseline, BaselineSource
from acts_msgs.msg import Contact, TactileSamples
from acts_ros import qos
from acts_ros.bags.message_types import Definitions
from acts_ros.bags.reading import open_bag
from acts_view.local import board_feed
from acts_view.local.board_feed import BoardFeed
from acts_view.nodes.view_node import ViewNode
from acts_view.recording.bounded_bag import BoundedBag
from acts_view.recording.recording import Recording

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = pytest.mark.slow

DOMAIN_ID = 193
DEADLINE_S = 30.0
# A recording that has just begun may have none, and would be an empty one if it were ended then.
SOME_MESSAGES = re.compile(r" [1-9]\d* messages, 0 lost")


class Bench:
    """The node, and a skin that publishes."""

    def __init__(self, folder: Path, *, control: bool = True, record_max_mb: float = 100.0) -> None:
        self._context = Context()
        rclpy.init(context=self._context, domain_id=DOMAIN_ID)
        self._skin = Node("driver", namespace="/plate", context=self._context)
        self._samples = self._skin.create_publisher(TactileSamples, "samples", qos.STREAM)
        self._contact = self._skin.create_publisher(Contact, "contact", qos.STREAM)
        self._sequence = 0
        self._skin.create_timer(0.005, self._publish)
        values = {"port": 0, "control": control, "record_dir": str(folder), "record_max_mb": record_max_mb}
        options = [Parameter(name, value=value) for name, value in values.items()]
        self.view = ViewNode(context=self._context, parameter_overrides=options)
        self.url = self.view.address.url
        self._spinning = Spinning(self._context, self._skin, self.view)

    def connect(self, path: str = "/stream", origin: str | None = None) -> ClientConnection:
        own = self.url.rstrip("/")
        return connect(own.replace("http", "ws") + path, origin=Origin(origin or own), compression=None)

    def close(self) -> None:
        if not self._context.ok():
            return
        self._spinning.end()
        self.view.close()
        for node in (self._skin, self.view):
            node.destroy_node()
        rclpy.try_shutdown(context=self._context)

    def add_skin(self, name: str) -> None:
        """Another one, which publishes as the first one does."""
        self.late = self._skin.create_publisher(TactileSamples, f"{name}/samples", qos.STREAM)
        contact = self._skin.create_publisher(Contact, f"{name}/contact", qos.STREAM)
        self._skin.create_timer(0.005, lambda: (self.late.publish(TactileSamples()), contact.publish(Contact())))

    def skip(self, count: int) -> None:
        """Leave out frames."""
        self._sequence += count

    def _publish(self) -> None:
        self._sequence += 1
        self._samples.publish(
            TactileSamples(sequence=self._sequence, rows=2, cols=2, indices=[0, 1], counts=[self._sequence % 1024, 7])
        )
        self._contact.publish(Contact(sequence=self._sequence))


@pytest.fixture
def begin(tmp_path: Path) -> Iterator[Callable[..., Bench]]:
    made: list[Bench] = []

    def make(**options: Any) -> Bench:
        made.append(Bench(tmp_path / "recordings", **options))
        return made[-1]

    yield make
    for one in made:
        one.close()


class Asker:
    """A page that asks, without a browser."""

    def __init__(self, client: ClientConnection, skins: Sequence[str] = ("/plate",)) -> None:
        self._client = client
        self._number = 0
        # Only what is known to publish is recorded.
        self.until(lambda header: header["type"] == "status" and header["skins"] == list(skins))

    def until(self, condition: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        return header_where(self._client, condition)

    def ask(self, what: str) -> tuple[bool, str]:
        self._number += 1
        self._client.send(json.dumps({"id": self._number, "do": what}))
        answer = self.until(lambda header: header.get("id") == self._number)
        return answer["done"], answer["text"]

    def recording(self, condition: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        found = self.until(lambda header: condition(header.get("recording", {})))["recording"]
        assert isinstance(found, dict)
        return found


def sequences(path: Path) -> list[int]:
    """Of the samples in a bag."""
    with open_bag(path) as bag:
        assert bag.note is None or path.suffix == ".mcap"
        return [deserialize_message(data, TactileSamples).sequence for _, _, data in bag.messages(["/plate/samples"])]


def fetched(bench: Bench, name: str) -> bytes:
    with bench.connect(f"/recordings/{name}") as client:
        return b"".join(piece for piece in client if isinstance(piece, bytes))


def test_what_is_recorded_can_be_fetched_and_read(begin: Callable[..., Bench], tmp_path: Path) -> None:
    bench = begin()
    with bench.connect() as client:
        page = Asker(client)
        assert page.ask("stop_recording") == (False, "nothing is being recorded")
        done, text = page.ask("record")
        assert (done, text.startswith("recording /plate to ")) == (True, True)
        done, text = page.ask("record")
        assert done is False
        assert "is being recorded already" in text
        page.recording(lambda state: state.get("messages", 0) > 20)
        done, text = page.ask("stop_recording")
        assert done
        assert "messages in" in text
        state = page.recording(lambda state: not state.get("on", True) and bool(state["files"]))
    ((name, size),) = state["files"]
    data = fetched(bench, name)
    (original,) = (tmp_path / "recordings").glob("*/*.mcap")
    assert (original.name, len(data)) == (name, size)
    assert data == original.read_bytes()
    copy = tmp_path / name
    copy.write_bytes(data)
    found = sequences(copy)
    # All that came, in the order in which it came.
    assert len(found) > 5
    assert found == list(range(found[0], found[0] + len(found)))
    assert sequences(original.parent) == found


def test_files_are_for_this_page_only_and_only_recordings(begin: Callable[..., Bench], tmp_path: Path) -> None:
    bench = begin()
    (tmp_path / "recordings").mkdir()
    (tmp_path / "recordings" / "secret.mcap").write_bytes(b"not from here")
    for path, origin, status in [
        ("/recordings/secret.mcap", None, 404),
        ("/recordings/../secret.mcap", None, 404),
        ("/recordings/secret.mcap", "http://example.org", 403),
    ]:
        with pytest.raises(InvalidStatus) as refused:
            bench.connect(path, origin)
        assert refused.value.response.status_code == status


def test_a_page_that_only_shows_records_nothing(begin: Callable[..., Bench], tmp_path: Path) -> None:
    bench = begin(control=False)
    with bench.connect() as client:
        page = Asker(client)
        done, text = page.ask("record")
        assert done is False
        assert "--control" in text
        assert "recording" not in page.until(lambda header: header["type"] == "status")
    with pytest.raises(InvalidStatus):
        bench.connect("/recordings/any.mcap")
    assert not (tmp_path / "recordings").exists()


def test_a_recording_ends_at_its_size_and_with_the_program(begin: Callable[..., Bench], tmp_path: Path) -> None:
    bench = begin(record_max_mb=0.002)
    with bench.connect() as client:
        page = Asker(client)
        assert page.ask("record")[0]
        state = page.recording(lambda state: not state.get("on", True) and bool(state["note"]))
        assert "0.002 MB that are allowed" in state["note"]
        (full,) = (tmp_path / "recordings").iterdir()
        assert sequences(full)
        page.until(lambda header: header["type"] == "status" and time.time() > full.stat().st_ctime + 1.0)
        assert page.ask("record")[0]
    bench.close()
    (last,) = set((tmp_path / "recordings").iterdir()) - {full}
    assert (last / "metadata.yaml").is_file()
    with open_bag(last) as bag:
        assert bag.note is None


def test_a_skin_that_appears_during_a_recording_is_in_it(begin: Callable[..., Bench], tmp_path: Path) -> None:
    bench = begin()
    with bench.connect() as client:
        page = Asker(client)
        assert page.ask("record")[0]
    # Nobody watches.
    bench.add_skin("/late")
    wait_for(lambda: bench.late.get_subscription_count() > 0, timeout_s=DEADLINE_S)
    with bench.connect() as client:
        page = Asker(client, ["/late", "/plate"])
        before = page.recording(lambda state: state.get("messages", 0) > 0)["messages"]
        page.recording(lambda state: state.get("messages", 0) > before)
        assert page.ask("stop_recording")[0]
    (path,) = (tmp_path / "recordings").iterdir()
    with open_bag(path) as bag:
        assert {"/late/samples", "/plate/samples"} <= {topic for topic, _, _ in bag.messages(list(bag.topics()))}


def test_as_many_messages_are_told_of_as_are_in_the_bag(begin: Callable[..., Bench], tmp_path: Path) -> None:
    bench = begin(record_max_mb=0.002)
    with bench.connect() as client:
        page = Asker(client)
        assert page.ask("record")[0]
        # It is full long before it ends.
        state = page.recording(lambda state: not state.get("on", True) and bool(state["note"]))
    (path,) = (tmp_path / "recordings").iterdir()
    with open_bag(path) as bag:
        count = len(list(bag.messages(list(bag.topics()))))
    assert f"; {count} messages in " in state["note"]


def test_a_message_that_comes_after_the_end_is_left_out(tmp_path: Path) -> None:
    bag = BoundedBag(tmp_path / "bag", 1000)
    topic = bag.add_topic("/a", "std_msgs/msg/String", *Definitions().describe("std_msgs/msg/String"), [])
    bag.write(topic, b"one")
    bag.close()
    # An executor that had taken it before the subscription was destroyed hands it over still.
    bag.write(topic, b"two")
    with open_bag(tmp_path / "bag") as found:
        assert [data for _, _, data in found.messages(["/a"])] == [b"one"]


def test_frames_that_a_recording_lacks_by_their_numbers_are_lost(begin: Callable[..., Bench]) -> None:
    bench = begin()
    with bench.connect() as client:
        page = Asker(client)
        assert page.ask("record")[0]
        page.recording(lambda state: state.get("messages", 0) > 20)
        # As out of a queue that is full while a disk is slow.
        bench.skip(5)
        # Of samples and of contacts.
        page.recording(lambda state: state.get("lost", 0) >= 10)
        assert ", 0 lost, " not in page.ask("stop_recording")[1]


@needs_browser
def test_a_person_records_and_downloads(
    begin: Callable[..., Bench], open_page: Callable[..., Page], tmp_path: Path
) -> None:
    page = open_page(begin())
    section = page.locator("#recording")
    button, line = section.locator(".group button"), section.locator(".answer")
    button.click()
    expect(button).to_have_text("Stop recording")
    expect(line).to_contain_text(SOME_MESSAGES)
    button.click()
    expect(button).to_have_text("Record")
    expect(line).to_contain_text("messages in")
    with page.expect_download() as downloading:
        section.get_by_text("Download").click()
    name = downloading.value.suggested_filename
    assert name.startswith("touch_")
    downloading.value.save_as(tmp_path / name)
    assert sequences(tmp_path / name)


@needs_browser
def test_a_person_records_and_downloads_by_keys(begin: Callable[..., Bench], open_page: Callable[..., Page]) -> None:
    page = open_page(begin())
    section = page.locator("#recording")
    button, line = section.locator(".group button"), section.locator(".answer")
    button.focus()
    page.keyboard.press(" ")
    expect(line).to_contain_text(SOME_MESSAGES)
    page.keyboard.press(" ")
    expect(button).to_have_text("Record")
    expect(line).to_contain_text("messages in")
    expect(button).to_be_focused()
    expect(page.locator("#pause")).to_have_text("Pause")
    download = section.get_by_text("Download")
    download.focus()
    with page.expect_download():
        page.keyboard.press("Enter")
    expect(download).to_be_focused()
    expect(download).to_have_attribute("aria-disabled", "false")


class NoFeed:
    """Fills a bag with nothing."""

    messages = lost = 0

    def step(self) -> None:
        """See `Feed`."""

    def close(self) -> None:
        """See `Feed`."""


def recording_to(folder: Path) -> Recording:
    return Recording(folder, 1_000_000, lambda: ("/foot",), lambda _skins, _bag: NoFeed(), lambda *_: None)


def test_recordings_that_begin_in_one_second_have_names_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Stopped(datetime):
        @classmethod
        def now(cls, _zone: tzinfo | None = None) -> Stopped:
            return cls(2026, 11, 1, 2, 30, 0)

    monkeypatch.setattr(acts_view.recording.recording, "datetime", Stopped)
    recording = recording_to(tmp_path)
    for _ in range(3):
        recording.start()
        recording.stop()
    second = "touch_2026-11-01_02-30-00"
    assert sorted(path.name for path in tmp_path.iterdir()) == [second, f"{second}_2", f"{second}_3"]


def test_a_recording_whose_folder_is_removed_ends_and_says_so(tmp_path: Path) -> None:
    folder = tmp_path / "recordings"
    recording = recording_to(folder)
    recording.start()
    shutil.rmtree(folder)
    recording.step()
    state = recording.state()
    assert not state["on"]
    assert "ended: " in state["note"]
    assert str(folder) in state["note"]
    # It is made again.
    recording.start()
    recording.close()


def test_of_a_board_no_messages_are_made_after_a_recording(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    feeds: list[BoardFeed] = []

    def feed(_skins: Sequence[str], bag: BoundedBag) -> BoardFeed:
        feeds.append(BoardFeed("/plate", None, lambda: 0, bag))
        return feeds[-1]

    made: list[object] = []
    monkeypatch.setattr(board_feed, "serialize_message", lambda message: made.append(message) or b"")  # type: ignore[func-returns-value]
    recording = Recording(tmp_path, 1_000_000, lambda: ["/plate"], feed, lambda *_: None)
    recording.start()
    indices = np.zeros(1, np.uint16)
    frame = SampleFrame(0, 0, 0, Scheme.RASTER, 2, 2, 0, indices, indices)
    baseline = Baseline(
        np.zeros((2, 2), np.float32), np.ones((2, 2), np.float32), np.ones((2, 2), bool), BaselineSource.TARE, 0
    )
    feeds[0].take([(frame, 1000)])
    feeds[0].set_baseline(baseline)
    assert len(made) == 2
    recording.stop()
    feeds[0].take([(frame, 2000)])
    feeds[0].set_baseline(baseline)
    assert len(made) == 2


def test_a_skin_in_the_root_namespace_is_named(tmp_path: Path) -> None:
    recording = Recording(tmp_path, 1_000_000, lambda: ("", "/foot"), lambda _skins, _bag: NoFeed(), lambda *_: None)
    assert recording.start().startswith("recording /, /foot to ")
    recording.close()
