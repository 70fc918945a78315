# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What each reader gets of the newest states, and how old it is told that they are."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from view_messages import decode

from acts_view.skin.snapshot import Frame, Sample, SkinShape
from acts_view.web import display as view_display
from acts_view.web.display import Display, Reader

Message = tuple[dict[str, Any], dict[str, NDArray[Any]]]


class Clock:
    def __init__(self) -> None:
        self.now_s = 500.0


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(view_display, "time", SimpleNamespace(monotonic=lambda: clock.now_s))
    return clock


def frame(value: int = 1, rows: int = 8, cols: int = 6) -> Frame:
    return Frame(image=np.full((rows, cols), value, np.uint16))


def sample(time_s: float) -> Sample:
    return Sample(time_s, 1.0, 0.5, 0)


def news(reader: Reader) -> list[Message]:
    return [decode(message) for message in reader.news()]


def kinds(reader: Reader) -> list[str]:
    return [header["type"] for header, _ in news(reader)]


def silent_s(display: Display) -> float | None:
    """As somebody is told who comes now."""
    [header] = [header for header, _ in news(display.reader()) if header["type"] == "frame"]
    told: float | None = header["silent_s"]
    return told


def test_each_reader_gets_once_what_is_newest() -> None:
    display = Display()
    early = display.reader()
    assert kinds(early) == []
    display.show_shape("/plate", SkinShape(rows=8, cols=6))
    for value in (1, 2):
        display.show_frame("/plate", frame(value), [])
    display.show_status({"level": 0})
    late = display.reader()
    for reader in (early, late):
        (status, _), (skin, _), (_, arrays) = news(reader)
        assert (status["type"], status["level"]) == ("status", 0)
        assert (skin["type"], skin["rows"], skin["cols"], skin["told"]) == ("skin", 8, 6, True)
        assert (arrays["image"] == 2).all()
        assert kinds(reader) == []
    display.show_frame("/plate", frame(3), [])
    assert kinds(early) == ["frame"]
    # Also where it says what was said before: by it a page knows that we live.
    display.show_status({"level": 0})
    assert kinds(early) == ["status"]
    assert kinds(late) == ["status", "frame"]


def test_a_status_carries_the_clock_of_when_it_is_read(clock: Clock) -> None:
    display = Display()
    display.show_status({"level": 1})
    clock.now_s += 7.0
    [(header, _)] = news(display.reader())
    assert header["clock_s"] == 507.0


def test_a_skin_is_silent_since_something_of_it_has_come(clock: Clock) -> None:
    display = Display()
    display.show_frame("/plate", Frame(), [])
    assert silent_s(display) is None, "nothing has come"
    shown = frame()
    display.show_frame("/plate", shown, [])
    clock.now_s += 2.34
    assert silent_s(display) == pytest.approx(2.3)
    # Only what controls the skin has said something.
    display.show_frame("/plate", Frame(image=shown.image, hand={"state": "holding"}), [])
    assert silent_s(display) == pytest.approx(2.3)
    display.show_frame("/plate", shown, [sample(1000.0)])
    assert silent_s(display) == 0.0
    # A picture that is taken away.
    clock.now_s += 1.0
    display.show_frame("/plate", Frame(), [])
    assert silent_s(display) is None
    display.show_frame("/plate", Frame(), [sample(1000.1)])
    clock.now_s += 0.5
    assert silent_s(display) == pytest.approx(0.5)


def test_who_reads_again_gets_the_history_since_then() -> None:
    display = Display()
    reader = display.reader()

    def times_s() -> NDArray[Any]:
        [(header, arrays)] = [message for message in news(reader) if message[0]["type"] == "frame"]
        found: NDArray[Any] = header["base_s"] + arrays["history"][:, 0]
        return found

    display.show_frame("/plate", frame(), [sample(1000.0 + 0.1 * k) for k in range(5)])
    first = times_s()
    display.show_frame("/plate", frame(), [sample(1000.5 + 0.1 * k) for k in range(5)])
    second = times_s()
    # The newest interval is not over.
    assert (first.max(), second.min()) == pytest.approx((1000.3, 1000.4), abs=0.01)
    # What comes from elsewhere does not follow on it.
    display.forget("/plate")
    display.show_frame("/plate", frame(), [sample(2000.0 + 0.1 * k) for k in range(5)])
    assert times_s().min() == pytest.approx(2000.0, abs=0.01)


def test_who_comes_later_gets_all_of_the_history_and_how_old_it_is_then(clock: Clock) -> None:
    display = Display()
    early = display.reader()
    display.show_frame("/plate", frame(), [sample(1000.0 + 0.1 * k) for k in range(5)])
    news(early)
    display.show_frame("/plate", frame(), [sample(1000.5 + 0.1 * k) for k in range(5)])
    for reader, after_s, intervals in ((early, 0.0, 5), (display.reader(), 0.0, 9), (display.reader(), 2.0, 9)):
        clock.now_s += after_s
        (header, arrays) = news(reader)[-1]
        assert header["silent_s"] == after_s
        assert np.count_nonzero(arrays["history"][:, 1]) == intervals


def test_a_description_is_sent_again_only_where_it_has_changed() -> None:
    display = Display()
    reader = display.reader()
    shape = SkinShape(rows=8, cols=6)
    display.show_shape("/plate", shape)
    assert kinds(reader) == ["skin"]
    display.show_shape("/plate", shape)
    display.show_shape("/plate", shape, is_begun_anew=True)
    assert kinds(reader) == []
    display.show_shape("/plate", SkinShape(rows=8, cols=6, touch_counts=77))
    [(header, _)] = news(reader)
    assert header["touch_counts"] == 77


def test_an_image_that_is_no_skin_leaves_the_description_as_it_was() -> None:
    """Any program can publish one."""
    display = Display()
    display.show_frame("/plate", frame(rows=1, cols=100_000), [])
    (described, _), _ = news(display.reader())
    assert (described["rows"], described["cols"], described["told"]) == (32, 32, False)


def test_of_a_skin_that_nobody_describes_the_size_is_that_of_its_newest_image() -> None:
    display = Display()
    reader = display.reader()
    for rows, cols in ((8, 6), (64, 3)):
        display.show_frame("/plate", frame(rows=rows, cols=cols), [])
        (described, _), _ = news(reader)
        assert (described["rows"], described["cols"], described["told"]) == (rows, cols, False)
    # Then somebody says that it is so.
    display.show_shape("/plate", SkinShape(rows=64, cols=3))
    [(described, _)] = news(reader)
    assert (described["rows"], described["cols"], described["told"]) == (64, 3, True)
    # From now on that counts.
    display.show_frame("/plate", frame(rows=8, cols=6), [])
    assert kinds(reader) == ["frame"]


def test_a_skin_that_is_begun_anew_is_described_as_its_files_are_now(tmp_path: Path) -> None:
    layout = tmp_path / "sole.yaml"
    patch = "{at: [%d, 0], wires: {down: rows %s, across: cols}}"

    def write(**patches: tuple[int, str]) -> None:
        lines = [f"  {name}: {patch % one}" for name, one in patches.items()]
        layout.write_text("\n".join(["matrix: [8, 8]", "patches:", *lines, ""]))

    display = Display()
    reader = display.reader()
    shape = SkinShape(rows=8, cols=8, layout=str(layout))
    write(whole=(0, "0 to 7"))
    display.show_shape("/sole", shape)
    [(described, _)] = news(reader)
    assert [one["name"] for one in described["patches"]] == ["whole"]
    write(heel=(0, "0 to 3"), toes=(4, "4 to 7"))
    display.show_shape("/sole", shape)
    assert kinds(reader) == []
    display.show_shape("/sole", shape, is_begun_anew=True)
    [(described, _)] = news(reader)
    assert [one["name"] for one in described["patches"]] == ["heel", "toes"]


@pytest.mark.usefixtures("clock")
def test_readers_share_a_message_until_there_is_a_newer_one() -> None:
    display = Display()
    display.show_frame("/plate", frame(1), [])
    [_, first], [_, same] = display.reader().news(), display.reader().news()
    assert first is same
    display.show_frame("/plate", frame(2), [])
    (_, arrays) = news(display.reader())[-1]
    assert (arrays["image"] == 2).all()


def test_what_is_forgotten_is_told_by_another_life_of_the_history() -> None:
    display = Display()
    lives = []
    for _ in range(2):
        for _ in range(2):
            display.show_frame("/plate", frame(), [sample(1000.0)])
            lives.append(news(display.reader())[-1][0]["life"])
        display.forget("/plate")
    assert lives[0] == lives[1] != lives[2] == lives[3]


def test_a_skin_that_comes_while_somebody_reads_is_news_of_the_next_time() -> None:
    display = Display()
    display.show_frame("/left", frame(), [])
    reader = display.reader()
    reading = reader.news()
    next(reading)
    display.show_frame("/right", frame(), [])
    names = [decode(message)[0]["skin"] for message in reading]
    assert names == ["/left"]
    assert [header["skin"] for header, _ in news(reader)] == ["/right", "/right"]
