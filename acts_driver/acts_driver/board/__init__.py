"""The dialogue with a board: what it is, what it is told, and what it made of its frames by itself.

In come the driver's parameters and the board's replies; out go commands. `BoardSession` keeps a board as the parameters
want it.
"""

from acts_driver.board.dialogue import BoardLink, NoAnswerError, RefusedError
from acts_driver.board.parameters import BOARD_PARAMETERS, BoardParameters
from acts_driver.board.results import BoardResult, BoardResults
from acts_driver.board.session import BoardSession, BoardStatus, settings_in_words, version_in_words

__all__ = [
    "BOARD_PARAMETERS",
    "BoardLink",
    "BoardParameters",
    "BoardResult",
    "BoardResults",
    "BoardSession",
    "BoardStatus",
    "NoAnswerError",
    "RefusedError",
    "settings_in_words",
    "version_in_words",
]
