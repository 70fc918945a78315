# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Keeps a board's settings equal to the parameters: identifies it and sends its settings, again after every reset."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from acts_core.errors import ActsError, ArrayError, BoardError, PortError, SettingsError
from acts_core.runtime import LogCallback
from acts_core.settings import is_given
from acts_core.wire import BoardModel, BoardSettings, BoardState, ReplyStatus
from acts_driver.board.dialogue import BoardLink, NoAnswerError, NotHeardError, RefusedError, UnknownAnswerError
from acts_driver.board.layout import BoardLayout
from acts_driver.board.model_file import BoardModelFile
from acts_driver.board.parameters import BoardParameters
from acts_driver.board.status import BoardStatus
from acts_driver.board.words import another_board, other_size, other_version, settings_in_words

FIRMWARE = (0, 1)
"""Major and minor version of the firmware that this driver belongs to; any patch version will do."""

_ASK_EVERY_S = 1.0
_STOP_S = 5.0
# A reply tells the time of the last frame, and frames may be a second apart.
_SAME_START_S = 2.0
_DRIFT_MAX = 1e-3


class BoardSession:
    """The dialogue of one driver with whatever board is plugged in, on a thread of its own.

    The board is asked every second, at once after `wake`, and brought to what the parameters want wherever it is not.
    What it had by itself when it was first seen after its start counts as its own. Models are uploaded on this thread
    alone, and read on another one, so that nobody else waits for as long as that takes.

    Parameters
    ----------
    link : BoardLink
        To the board.
    parameters : BoardParameters
        What is wanted.
    size : tuple of int
        Rows and columns that the driver expects.
    log : callable
        See `acts_core.runtime.LogCallback`.
    on_change : callable
        Called with the status when anything but times and counters in it has changed; from any thread.

    Attributes
    ----------
    status : BoardStatus
    replacements : int
        How often another board answered than the one before.
    """

    def __init__(
        self,
        link: BoardLink,
        parameters: BoardParameters,
        *,
        size: tuple[int, int],
        log: LogCallback,
        on_change: Callable[[BoardStatus], None] = lambda status: None,
    ) -> None:
        self._link = link
        self._parameters = parameters
        self._size = size
        self._log = log
        self._on_change = on_change
        self._own: BoardSettings | None = None
        self._seen: BoardState | None = None
        self._seen_s = 0.0
        # How often the port was opened, and at which of these the board's answer, or its silence, was heard last.
        self._opening = 0
        self._heard = -1
        self._settled: tuple[BoardSettings, BoardSettings] | None = None
        # What was refused last, and the words it was refused with.
        self._refused: object = None
        self._refusal = ""
        self._layout = BoardLayout(link, log)
        self._model = self._file_of(parameters)
        self._due: BoardModel | None = None
        self._uploading: BoardModel | None = None
        self._turn = threading.Lock()
        self._wake = threading.Event()
        self._verdict = threading.Event()
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name="acts_board", daemon=True)
        self._told = ""
        self.status = BoardStatus()
        self.replacements = 0

    def start(self) -> None:
        """Begin the dialogue; the source is open."""
        self._thread.start()

    def stop(self) -> None:
        """End the dialogue. May be called again."""
        self._stop.set()
        self._wake.set()
        if self._thread.is_alive():
            self._thread.join(_STOP_S)

    def wake(self) -> None:
        """Note that the board may have been reset: its state is queried at once."""
        self._wake.set()

    def reconnected(self) -> None:
        """Tell that the port was lost and is open again, perhaps with another board."""
        self._opening += 1
        self.wake()

    def wait_for_verdict(self, timeout_s: float) -> bool:
        """Wait until the first board has answered or turned out not to; False where that takes longer."""
        return self._verdict.wait(timeout_s)

    @property
    def has_verdict(self) -> bool:
        """Whether the first board has answered or turned out not to. Cheap."""
        return self._verdict.is_set()

    @property
    def may_publish(self) -> bool:
        """Whether frames of this board may be used: it is compatible, or is known not to reply. Cheap."""
        return self._heard == self._opening and not self.status.is_wrong_version

    @property
    def asks_for_something(self) -> bool:
        """Whether any parameter sets something on the board."""
        return bool(self._parameters.given())

    def ask(self) -> BoardState:
        """Ask the board now.

        Raises
        ------
        BoardError, PortError
            As `BoardLink.query`.
        """
        with self._turn:
            return self._query()

    def change(self, parameters: BoardParameters) -> None:
        """Change the parameters, and send the difference to the board.

        While no board is connected the wish is only noted. A model is announced, which tells whether the board can hold
        it; `status` tells when it is there. One whose file cannot be read at once counts as wanted: `status` tells what
        becomes of it.

        Raises
        ------
        BoardError, SettingsError
            It cannot be; the settings are as they were and the old wish stays.
        """
        model = self._model
        if parameters.model != self._parameters.model or (model is not None and model.has_changed()):
            model = self._file_of(parameters)
        if model is not None:
            # The board may be asked meanwhile.
            model.wait()
        with self._turn:
            self._change(parameters, model)
        self.wake()

    def _change(self, parameters: BoardParameters, model: BoardModelFile | None) -> None:
        before = self._parameters, self._model
        try:
            self._check_that_it_listens()
            self._parameters, self._model = parameters, model
            self._refused = None
            self._layout.read_again()
            self._wanted_model()
            if self.status.state is not None:
                state = self._query()
                self._check_that_it_listens()
                self._bring(state)
            if self._due is not None and self._due is not self._uploading:
                self._link.announce(self._due)
        except PortError as error:
            # Just lost: told to the board when it is back.
            self._set(BoardStatus(problem=str(error)))
        except ActsError:
            self._parameters, self._model = before
            # Part of it may have been done.
            self.wake()
            raise

    def _check_that_it_listens(self) -> None:
        if self.status.is_silent or self.status.is_wrong_version:
            raise BoardError(f"the board cannot be told settings: {self.status.problem}")

    def _run(self) -> None:
        while not self._stop.is_set():
            self._wake.clear()
            opening = self._opening
            with self._turn:
                if not self._round():
                    self._due = None
                due = self._due
            self._heard = opening
            self._verdict.set()
            # With a port opened meanwhile: first who this is.
            if due is not None and opening == self._opening:
                self._upload(due, opening)
            self._wake.wait(_ASK_EVERY_S)

    def _round(self) -> bool:
        """Query the board and send what differs; whether that succeeded, so that a model may be uploaded."""
        state = self._query_or_note()
        wanted = (self._parameters, self._own)
        if state is None or self.status.is_wrong_version or wanted == self._refused:
            return False
        try:
            self._bring(state)
        except PortError:
            return False
        except NoAnswerError:
            self.wake()
            return False
        except ActsError as error:
            # Not told again until something has changed.
            self._refused, self._refusal = wanted, str(error)
            self._set(replace(self.status, problem=str(error)))
            return False
        return True

    def _query_or_note(self) -> BoardState | None:
        """Like `_query`; None where the board does not answer as it should, which the status tells then."""
        try:
            return self._query()
        except PortError as error:
            self._set(BoardStatus(problem=str(error)))
        except NotHeardError as error:
            # What was known of the board still is.
            if self.status.state is None and not self.status.is_silent:
                self._set(BoardStatus(problem=str(error)))
        except UnknownAnswerError as error:
            version = error.reply.firmware_version
            is_other = version[:2] != FIRMWARE
            # Of this version but not known, as with a scheme of somebody's own, its frames are read all the same.
            problem = other_version(version, FIRMWARE) if is_other else str(error)
            self._set(BoardStatus(problem=problem, is_wrong_version=is_other, is_silent=not is_other))
        except NoAnswerError as error:
            self._set(BoardStatus(problem=str(error), is_silent=True))
        except BoardError as error:
            self._set(BoardStatus(problem=str(error), is_wrong_version=True))
        return None

    def _query(self) -> BoardState:
        asked_s = time.monotonic()
        state = self._link.query().state
        self._see(state, asked_s)
        return state

    def _see(self, state: BoardState, asked_s: float) -> None:
        """Update the status by a state that the board has told since it was asked, at `asked_s` [s]."""
        if self._has_begun_anew(state, asked_s):
            self._own = state.settings
            self._begin_anew(state)
        self._seen, self._seen_s = state, time.monotonic()
        if state.firmware_version[:2] != FIRMWARE:
            self._set(
                BoardStatus(state, is_wrong_version=True, problem=other_version(state.firmware_version, FIRMWARE))
            )
            return
        problem = self._refusal if self._refused is not None else self._mismatch(state)
        self._set(BoardStatus(state, problem=problem))

    def _begin_anew(self, state: BoardState) -> None:
        """Note that the board was replaced or reset, and so has lost what it was told."""
        seen, self._seen, self._seen_s = self._seen, state, time.monotonic()
        if seen is not None and seen.board_id != state.board_id:
            self.replacements += 1
            self._log("warning", another_board(seen, state))
        self._layout.begin_anew()
        self._settled = None
        self._refused = None

    def _has_begun_anew(self, state: BoardState, asked_s: float) -> bool:
        """Whether the board was replaced or reset since the last state, and so has lost its settings."""
        seen = self._seen
        # Nobody tells a board its size.
        if seen is None or seen.board_id != state.board_id or not _are_of_one_size(seen, state):
            return True
        # At least: a busy machine reads answers late.
        passed_s, later_s = asked_s - self._seen_s, (state.uptime_us - seen.uptime_us) * 1e-6
        return later_s < 0 or passed_s - later_s > _SAME_START_S + _DRIFT_MAX * passed_s

    def _bring(self, state: BoardState) -> None:
        """Send what differs between a state of the board and the parameters."""
        try:
            self._send(state)
        except (SettingsError, ArrayError) as error:
            # What is made for the size of the parameters fits no board of another one, which is to be told then.
            problem = other_size(state.settings, self._size)
            if problem:
                raise BoardError(problem) from error
            raise

    def _send(self, state: BoardState) -> None:
        assert self._own is not None
        wanted = self._parameters.wanted(self._own)
        if state.settings != wanted and self._settled != (wanted, state.settings):
            asked_s = time.monotonic()
            state = self._link.configure(wanted).state
            if self._has_begun_anew(state, asked_s):
                # Reset between question and command: what it has by itself is not what it was told just now.
                self._begin_anew(state)
            # A board may round a setting; it is not sent again and again then.
            self._settled = (wanted, state.settings)
            self._log("info", f"the board has taken its settings: {settings_in_words(state.settings)}")
        state = self._layout.bring(self._parameters, state)
        model = self._wanted_model()
        self._due = model if model is not None and state.model.crc32 != model.crc32 else None
        self._set(BoardStatus(state, problem=self._mismatch(state)))

    def _upload(self, model: BoardModel, opening: int) -> None:
        """Upload the wanted model. Queries and settings may come between two pieces."""

        def is_wanted() -> bool:
            return self._due is model and self._opening == opening and not self._stop.is_set()

        parameters = self._parameters
        wanted = (parameters, self._own)
        self._uploading = model
        try:
            reply = self._link.upload(model, is_wanted)
        except (NoAnswerError, UnknownAnswerError, PortError):
            # The next round tells what has become of the board.
            return
        except RefusedError as error:
            with self._turn:
                if not is_wanted():
                    return
                self._set(replace(self.status, problem=str(error)))
                # Anything else was a fault in transport, or a restart of the board.
                if error.reply.status is ReplyStatus.MODEL_IMPOSSIBLE:
                    self._refused, self._refusal = wanted, str(error)
            return
        finally:
            self._uploading = None
        if reply is not None:
            self._log("info", f"the board has taken the model {parameters.model}")
            with self._turn:
                self._due = None
                # Not by this reply: one that the board gave later may have been heard meanwhile.
                self._query_or_note()

    def _wanted_model(self) -> BoardModel | None:
        """The model that the parameters ask for, where there is one and it has been read."""
        return None if self._model is None else self._model.model()

    def _file_of(self, parameters: BoardParameters) -> BoardModelFile | None:
        return BoardModelFile(Path(parameters.model), self.wake) if is_given(parameters.model) else None

    def _mismatch(self, state: BoardState) -> str:
        wrong_size, output = other_size(state.settings, self._size), state.settings.output
        if wrong_size:
            return wrong_size
        if self._model is not None and self._model.problem:
            return self._model.problem
        # One that is being read, or is another than the board's, is on its way, also while the board is not heard.
        if state.samples_only and (self._model is None or self._model.is_read_as(state.model.crc32)):
            return f"the board holds no model for output {output}, it sends samples only: set the parameter model"
        return ""

    def _set(self, status: BoardStatus) -> None:
        before, self.status = self.status, status
        # A silent board of which nothing is asked may be as it should be, and a lost port is told by the reader.
        if status.state is not None or status.is_wrong_version:
            self._tell("error", status.problem)
        elif status.is_silent and self.asks_for_something:
            self._tell("warning", f"{status.problem}: the parameters about the board are not in force")
        if before.lasting != status.lasting:
            self._on_change(status)

    def _tell(self, level: str, problem: str) -> None:
        """Log a problem, once for as long as it lasts; empty where there is none any more."""
        if problem and problem != self._told:
            self._log(level, problem)
        self._told = problem


def _are_of_one_size(one: BoardState, other: BoardState) -> bool:
    return (one.settings.rows, one.settings.cols) == (other.settings.rows, other.settings.cols)
