# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Files that take long, or for ever, to be read: services answer meanwhile, frames come. ROS_DOMAIN_ID 225."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from driver_rig import Rig
from lifecycle_msgs.msg import Transition
from virtual_board import VirtualBoard

from acts_driver import settings as driver_settings
from acts_driver.board import model_file
from acts_driver.nodes import baseline_services

pytestmark = pytest.mark.slow

# Where somebody waits for the file after all, the test goes on after this, and fails.
AT_MOST_S = 10.0


class SlowFile:
    """Stands before the functions that read files: they begin, and go on when `is_there` is set."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self._monkeypatch = monkeypatch
        self.begun = threading.Event()
        self.is_there = threading.Event()

    def before(self, owner: object, name: str) -> None:
        read: Callable[..., Any] = getattr(owner, name)

        def slowly(*arguments: Any, **named: Any) -> Any:
            self.begun.set()
            self.is_there.wait(AT_MOST_S)
            return read(*arguments, **named)

        self._monkeypatch.setattr(owner, name, slowly)


@pytest.fixture
def slow_file(monkeypatch: pytest.MonkeyPatch) -> Iterator[SlowFile]:
    slow_file = SlowFile(monkeypatch)
    yield slow_file
    slow_file.is_there.set()


@pytest.fixture
def rig() -> Iterator[Rig]:
    rig = Rig(225)
    yield rig
    rig.close()


def test_a_model_is_uploaded_when_its_file_has_been_read_at_last(rig: Rig, slow_file: SlowFile, tmp_path: Path) -> None:
    np.savez(tmp_path / "model.npz", atoms=np.eye(64))
    slow_file.before(model_file, "load_model")
    with VirtualBoard(tmp_path / "board") as board:
        driver = rig.start_driver(port=board.link)
        rig.wait_until_active()
        assert rig.set_parameters(model=str(tmp_path / "model.npz")) == (True, "")
        assert slow_file.begun.wait(AT_MOST_S)
        n_before = len(rig.samples)
        assert "model none" in rig.query()[1]
        rig.spin_until(lambda: len(rig.samples) > n_before + 100, "frames meanwhile")
        rig.status_until(lambda status: "is still being read" in status["message"], "the report")
        assert not slow_file.is_there.is_set()
        slow_file.is_there.set()
        rig.spin_until(lambda: "model patch_dictionary" in rig.query()[1], "the model")
        driver.close()


def test_a_model_that_could_not_be_read_is_read_again_when_it_is_asked_for_again(rig: Rig, tmp_path: Path) -> None:
    path = tmp_path / "model.npz"
    with VirtualBoard(tmp_path / "board") as board:
        driver = rig.start_driver(port=board.link, model=path)
        rig.wait_until_active()
        rig.status_until(lambda status: f"{path}: cannot be read" in status["message"], "the report")
        np.savez(path, atoms=np.eye(64))
        assert rig.set_parameters(model=str(path)) == (True, "")
        rig.spin_until(lambda: "model patch_dictionary" in rig.query()[1], "the model")
        driver.close()


def test_a_recording_begins_when_it_has_been_read_at_last(rig: Rig, slow_file: SlowFile, tmp_path: Path) -> None:
    path = tmp_path / "samples.npz"
    np.savez(path, indices=np.tile(np.arange(8), (50, 1)), counts=np.ones((50, 8), int), rate_hz=100.0)
    slow_file.before(driver_settings, "open_recording")
    driver = rig.start_driver(replay=path, replay_delay_s=0.0, autostart=False)
    assert not rig.change_state(Transition.TRANSITION_CONFIGURE)
    assert rig.state() == "unconfigured"
    assert not slow_file.is_there.is_set()
    rig.status_until(lambda status: "is still being read" in status["message"], "the report")
    slow_file.is_there.set()
    rig.spin_until(lambda: rig.change_state(Transition.TRANSITION_CONFIGURE), "the recording")
    assert rig.change_state(Transition.TRANSITION_ACTIVATE)
    rig.spin_until(lambda: rig.samples, "frames")
    driver.close()


def test_a_baseline_that_takes_too_long_is_not_taken_over(rig: Rig, slow_file: SlowFile, tmp_path: Path) -> None:
    driver = rig.start_driver(port=tmp_path / "nothing", autostart=False)
    slow_file.before(baseline_services, "is_there")
    succeeded, reason = rig.set_parameters(calibration_file=str(tmp_path / "skin.npz"))
    assert not slow_file.is_there.is_set()
    assert (succeeded, "takes longer than 0.5 s" in reason) == (False, True), reason
    assert driver.get_parameter("calibration_file").value == ""
