# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The session that uploads models, with imagined boards that refuse them, are replaced or are told something else."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from board_host import SIZE, OtherLink
from pty_board import wait_for
from waiting import pause

from acts_core.wire import BoardModel, Reply, ReplyStatus
from acts_core.wire.commands import NO_MODEL, HeldModel
from acts_driver.board import BoardParameters, BoardSession
from acts_driver.board.dialogue import NoAnswerError, RefusedError
from acts_driver.board.model_file import load_model
from acts_driver.board.session import FIRMWARE


class UploadingLink(OtherLink):
    """A way to an imagined board that is told something else just when it has said that it has all of a model."""

    def __init__(self) -> None:
        super().__init__()
        self.held = NO_MODEL
        self.meanwhile = threading.Event()
        self.tell: Callable[[], None] = lambda: None

    def query(self) -> Reply:
        reply = super().query()
        return replace(reply, state=replace(reply.state, model=self.held))

    def announce(self, model: BoardModel) -> Reply:
        return self.query()

    def upload(self, model: BoardModel, is_wanted: Callable[[], bool] = lambda: True) -> Reply:
        self.held = HeldModel.of(model)
        reply = self.query()
        self.tell()
        self.meanwhile.set()
        return reply


def test_the_end_of_an_upload_that_is_read_after_a_later_answer_is_of_no_restarted_board(tmp_path: Path) -> None:
    path = tmp_path / "model.npz"
    np.savez(path, atoms=np.random.default_rng(5).normal(size=(64, 100)).astype(np.float32))
    link, log = UploadingLink(), []
    session = BoardSession(link, BoardParameters(), size=SIZE, log=lambda level, words: log.append(words))
    link.tell = lambda: session.change(BoardParameters(m=32, model=str(path)))
    session.start()
    assert session.wait_for_verdict(20.0)
    session.change(BoardParameters(m=64, model=str(path)))
    assert link.meanwhile.wait(20.0)
    wait_for(lambda: any("has taken the model" in line for line in log), "the model")
    session.stop()
    assert session.status.state is not None
    assert session.status.state.settings.m == link.settings.m == 32
    assert session.status.state.model.crc32 == link.held.crc32
    session.change(BoardParameters())
    assert link.settings.m == 55, "its own settings were not mistaken"


class FullLink(OtherLink):
    """A way to an imagined board that has no room for models."""

    def announce(self, model: BoardModel) -> Reply:
        raise RefusedError(replace(self.query(), status=ReplyStatus.MODEL_IMPOSSIBLE))


def test_a_model_that_the_board_cannot_hold_leaves_the_old_wish(tmp_path: Path) -> None:
    path = tmp_path / "model.npz"
    np.savez(path, atoms=np.eye(64))
    link = FullLink()
    session = BoardSession(link, BoardParameters(m=64), size=SIZE, log=lambda level, words: None)
    session.start()
    wait_for(lambda: link.settings.m == 64, "the settings")
    with pytest.raises(RefusedError):
        session.change(BoardParameters(m=32, model=str(path)))
    wait_for(lambda: link.settings.m == 64, "the settings of before")
    session.stop()
    assert session.status.problem == ""


class ReplacedLink(OtherLink):
    """A way to an imagined board that is replaced by one with other firmware during an upload."""

    def __init__(self) -> None:
        super().__init__()
        self.version = (*FIRMWARE, 0)
        self.asked = self.uploads = 0

    def query(self) -> Reply:
        self.asked += 1
        reply = super().query()
        return replace(reply, state=replace(reply.state, firmware_version=self.version))

    def announce(self, model: BoardModel) -> Reply:
        return self.query()

    def upload(self, model: BoardModel, is_wanted: Callable[[], bool] = lambda: True) -> Reply:
        self.uploads += 1
        self.board_id, self.version = 8, (9, 0, 0)
        raise NoAnswerError("unplugged")


def test_no_model_is_uploaded_to_a_board_with_other_firmware_in_the_place_of_the_one_that_was_to_get_it(
    tmp_path: Path,
) -> None:
    path = tmp_path / "model.npz"
    np.savez(path, atoms=np.eye(64))
    link = ReplacedLink()
    session = BoardSession(link, BoardParameters(), size=SIZE, log=lambda level, words: None)
    session.start()
    assert session.wait_for_verdict(20.0)
    session.change(BoardParameters(model=str(path)))
    wait_for(lambda: session.status.is_wrong_version, "the other firmware")
    n_before = link.asked

    def ask() -> None:
        session.wake()
        pause()

    wait_for(lambda: link.asked > n_before + 3, "questions", meanwhile=ask)
    session.stop()
    assert link.uploads == 1


class PickyLink(UploadingLink):
    """A way to an imagined board that cannot use the first model that it gets."""

    def __init__(self) -> None:
        super().__init__()
        self.refuses = True

    def upload(self, model: BoardModel, is_wanted: Callable[[], bool] = lambda: True) -> Reply:
        if self.refuses:
            self.refuses = False
            raise RefusedError(replace(self.query(), status=ReplyStatus.MODEL_IMPOSSIBLE))
        return super().upload(model, is_wanted)


def test_a_model_that_was_refused_is_uploaded_when_its_file_was_rewritten_and_it_is_asked_for_again(
    tmp_path: Path,
) -> None:
    path = tmp_path / "model.npz"
    np.savez(path, atoms=np.eye(64))
    link = PickyLink()
    session = BoardSession(link, BoardParameters(), size=SIZE, log=lambda level, words: None)
    session.start()
    assert session.wait_for_verdict(20.0)
    session.change(BoardParameters(model=str(path)))
    wait_for(lambda: session.status.problem, "the refusal")
    # A file of another length, in case that the clock of the disk is coarse.
    np.savez(path, atoms=np.eye(64)[:, :32])
    session.change(BoardParameters(model=str(path)))
    wait_for(lambda: link.held.crc32 == load_model(path).crc32, "the new model")
    wait_for(lambda: not session.status.problem, "no problem")
    session.stop()
