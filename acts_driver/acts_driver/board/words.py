# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is told of a board, in words."""

from __future__ import annotations

from acts_core.wire import BoardSettings, BoardState


def settings_in_words(settings: BoardSettings) -> str:
    """Settings for a person, in one line."""
    rate = f"at most {1e6 / settings.frame_period_us:g} Hz" if settings.frame_period_us else "as fast as it can"
    return (
        f"{settings.rows} x {settings.cols}, {settings.scheme}, M = {settings.frame_size}, {rate}, threshold "
        f"{settings.threshold_counts}, output {settings.output}, LED {settings.led}"
    )


def version_in_words(state: BoardState) -> str:
    """A firmware version for a person."""
    return _with_dots(state.firmware_version)


def _with_dots(version: tuple[int, int, int]) -> str:
    return ".".join(map(str, version))


def other_version(version: tuple[int, int, int], needed: tuple[int, int]) -> str:
    """That the firmware is of another version than the driver needs, major and minor."""
    return (
        f"the board's firmware is {_with_dots(version)}, this driver needs {needed[0]}.{needed[1]}.x: load the "
        "firmware of the driver's release onto the board; its frames are not published"
    )


def other_size(settings: BoardSettings, expected: tuple[int, int]) -> str:
    """That the board has another size than expected, rows and cols; empty where it has not."""
    if (settings.rows, settings.cols) == expected:
        return ""
    rows, cols = expected
    return (
        f"the board measures {settings.rows} x {settings.cols} taxels, the parameters rows and cols say "
        f"{rows} x {cols}: set them alike"
    )


def another_board(before: BoardState, now: BoardState) -> str:
    """That the port leads to another board than before."""
    return (
        f"the port leads to board {now.board_id} now, it was board {before.board_id} before: the port "
        f"serial:{before.board_id} would take that board alone"
    )
