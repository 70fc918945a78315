# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Messages in another frame than the skin's: a plate tilted by places in other coordinates might throw the ball off."""

from __future__ import annotations

from acts_core.words import counted

# A name that somebody else has sent is shown no further.
_LONGEST_NAME = 64


class OtherFrames:
    """Counts the messages of one kind that are left out for their frame.

    Parameters
    ----------
    single, several : str
        What one of them is, and some of them are.
    frame_id : str
        Frame of the skin.

    Attributes
    ----------
    count : int
        Left out so far.
    """

    def __init__(self, single: str, several: str, frame_id: str) -> None:
        self.count = 0
        self._kinds = single, several
        self._frame_id = frame_id
        self._newest = ""
        self._told = 0

    def has(self, frame_id: str) -> bool:
        """Whether a message is in another frame, and to be left out. One that names no frame is in the skin's."""
        if frame_id in ("", self._frame_id):
            return False
        self.note(frame_id)
        return True

    def note(self, frame_id: str) -> None:
        """Count a message that is left out."""
        self._newest = frame_id[:_LONGEST_NAME]
        self.count += 1

    def newly(self) -> str:
        """That messages were left out since the last call, in words; empty where none was."""
        before, self._told = self._told, self.count
        if self.count == before:
            return ""
        single, several = (f"{kind} in the frame {self._newest!r}" for kind in self._kinds)
        but = f"left out: that of the skin is {self._frame_id!r} (parameter frame_id)"
        return counted(self.count, f"{single} was {but}", f"{several} were {but}")
