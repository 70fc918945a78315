# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A model on its way to the board: frames and reports go on, wishes are heard, an unplugged board begins again.

ROS_DOMAIN_ID 116.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from driver_rig import Rig
from lifecycle_msgs.msg import Transition
from pty_board import wait_for
from virtual_board import VirtualBoard

from acts_core.wire.board_models import MODEL_CAPACITY, ModelKind
from acts_driver.board import BoardStatus
from acts_driver.board.model_file import load_model

pytestmark = pytest.mark.slow

# As large as a board can hold, 256 pieces with a reply each, and one that takes slow boards no more than some seconds.
LARGEST = MODEL_CAPACITY // 4 // 64
SMALLER = 240


@pytest.fixture
def rig() -> Iterator[Rig]:
    rig = Rig(116)
    yield rig
    rig.close()


def dictionaries(folder: Path, n_atoms: int = SMALLER) -> list[Path]:
    paths = [folder / "first.npz", folder / "second.npz"]
    for seed, path in enumerate(paths):
        np.savez(path, atoms=np.random.default_rng(seed).normal(size=(64, n_atoms)))
    return paths


def status_of(rig: Rig) -> BoardStatus:
    assert rig.driver is not None
    assert rig.driver.intake is not None
    assert rig.driver.intake.session is not None
    return rig.driver.intake.session.status


def held(rig: Rig) -> int:
    """Checksum of the model that the board said it holds."""
    state = status_of(rig).state
    return 0 if state is None else state.model.crc32


def holds(rig: Rig, crc32: int) -> bool:
    return held(rig) == crc32


def test_frames_and_reports_go_on_during_an_upload(tmp_path: Path, rig: Rig, capfd: pytest.CaptureFixture[str]) -> None:
    models = dictionaries(tmp_path)
    # A slow board answers slowly: the upload takes seconds.
    with VirtualBoard(tmp_path / "board", "--rate-hz", "20") as board:
        rig.start_driver(port=board.link)
        rig.wait_until_active()
        rig.spin_until(lambda: rig.samples, "a frame")
        assert rig.set_parameters(model=str(models[0]), output="image", m=64) == (True, "")
        state = status_of(rig).state
        assert state is not None
        assert (state.settings.m, state.model.kind) == (64, ModelKind.NONE), "settings at once, the model on its way"
        rig.statuses.clear()
        n_before = len(rig.samples)
        wanted = load_model(models[0]).crc32
        rig.spin_until(lambda: held(rig) == wanted, "the model")
        assert [status["level"] for status in rig.statuses], "reports came meanwhile"
        assert all("holds no model" not in status["message"] for status in rig.statuses)
        assert len(rig.samples) > n_before + 5
        numbers = np.array([message.sequence for message in rig.samples])
        assert (np.diff(numbers) >= 1).all()
        missing = int((np.diff(numbers) - 1).sum())
        # A machine that stands still makes the board drop frames, and the driver throw old ones away; both say so.
        rig.status_until(
            lambda status: int(status.get("overruns", "0")) + int(status.get("discarded", "0")) >= missing,
            f"the reason of {missing} lost",
        )
        assert status_of(rig).problem == ""
        assert "holds no model" not in capfd.readouterr().err, "a model on its way is none that is missing"


def test_nothing_is_lost_at_1_khz_during_an_upload(tmp_path: Path, rig: Rig) -> None:
    models = dictionaries(tmp_path, LARGEST)
    with VirtualBoard(tmp_path / "board") as board:
        rig.start_driver(port=board.link)
        rig.wait_until_active()
        rig.spin_until(lambda: rig.samples, "a frame")
        for path in models:
            assert rig.set_parameters(model=str(path)) == (True, "")
            wanted = load_model(path).crc32
            rig.spin_until(partial(holds, rig, wanted), "the model")
        status = rig.status_until(lambda status: True, "a report")
        # A busy machine may make the board drop frames, and the driver throw old ones away; both say so.
        lost, discarded, overruns = (int(status[name]) for name in ("lost", "discarded", "overruns"))
        assert lost - discarded <= overruns <= lost
        assert (status["crc_errors"], status["malformed"], status["repeated"]) == ("0", "0", "0")


def test_another_wish_replaces_a_model_on_its_way(tmp_path: Path, rig: Rig) -> None:
    models = dictionaries(tmp_path)
    with VirtualBoard(tmp_path / "board", "--rate-hz", "50") as board:
        rig.start_driver(port=board.link)
        rig.wait_until_active()
        assert rig.set_parameters(model=str(models[0]))[0]
        assert rig.set_parameters(model=str(models[1]), m=100)[0]
        # One that cannot be leaves the wish before it.
        succeeded, reason = rig.set_parameters(model=str(tmp_path / "missing.npz"))
        assert not succeeded
        assert "cannot be read" in reason
        wanted = load_model(models[1]).crc32
        rig.spin_until(lambda: held(rig) == wanted, "the second model")
        state = status_of(rig).state
        assert state is not None
        assert state.settings.m == 100


def test_a_board_unplugged_during_an_upload_gets_it_when_it_is_back(tmp_path: Path, rig: Rig) -> None:
    models = dictionaries(tmp_path)
    control = tmp_path / "control"
    with VirtualBoard(tmp_path / "board", "--rate-hz", "50", "--control", str(control)) as board:
        rig.start_driver(port=board.link, reconnect_s=0.05)
        rig.wait_until_active()
        assert rig.set_parameters(model=str(models[0]), m=100)[0]
        assert held(rig) == 0
        control.write_text("reset:0.2\n")
        intake = rig.driver.intake if rig.driver is not None else None
        assert intake is not None
        rig.spin_until(lambda: intake.reader.reconnects == 1, "the reconnection")
        wanted = load_model(models[0]).crc32
        rig.spin_until(lambda: held(rig) == wanted, "the model")
        rig.spin_until(lambda: rig.samples and len(rig.samples[-1].indices) == 100, "frames as they were asked for")
        assert status_of(rig).problem == ""


def test_the_driver_ends_during_an_upload(tmp_path: Path, rig: Rig) -> None:
    models = dictionaries(tmp_path)
    with VirtualBoard(tmp_path / "board", "--rate-hz", "20") as board:
        driver = rig.start_driver(port=board.link)
        rig.wait_until_active()
        assert rig.set_parameters(model=str(models[0]))[0]
        session = driver.intake.session if driver.intake is not None else None
        assert session is not None
        assert rig.change_state(Transition.TRANSITION_ACTIVE_SHUTDOWN)
        wait_for(lambda: not session._thread.is_alive(), "the end of the upload", timeout_s=2.0)
        assert session.status.state is not None
        assert session.status.state.model.kind is ModelKind.NONE
