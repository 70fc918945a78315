# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Commands to a board, its replies, and the images and objects that it recovers itself.

In come the driver's parameters and the board's replies; out go commands. `BoardSession` keeps the board's settings
equal to the parameters.
"""

from acts_driver.board.dialogue import BoardLink, NoAnswerError, NotHeardError, RefusedError, UnknownAnswerError
from acts_driver.board.parameters import BOARD_PARAMETERS, BoardParameters
from acts_driver.board.results import BoardResult, BoardResults
from acts_driver.board.session import BoardSession
from acts_driver.board.status import BoardStatus
from acts_driver.board.words import settings_in_words, version_in_words

__all__ = [
    "BOARD_PARAMETERS",
    "BoardLink",
    "BoardParameters",
    "BoardResult",
    "BoardResults",
    "BoardSession",
    "BoardStatus",
    "NoAnswerError",
    "NotHeardError",
    "RefusedError",
    "UnknownAnswerError",
    "settings_in_words",
    "version_in_words",
]
