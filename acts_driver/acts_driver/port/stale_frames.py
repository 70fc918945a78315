"""What a board's USB side still held of the session before comes first when the port is opened again."""

from __future__ import annotations

from acts_core.frames import SampleFrame
from acts_core.wire import BoardMessage, DelimitedDecoder, Reply


class StaleFrames:
    """Drops the frames that came before a board's first answer: they may be as old as the last session.

    A Teensy's USB side keeps up to 8 KB that a host left unread, and sends them to the next one.

    Parameters
    ----------
    decoder : DelimitedDecoder
        Decodes the stream.
    """

    def __init__(self, decoder: DelimitedDecoder) -> None:
        self._decoder = decoder
        self._before_answer: int | None = None
        self._is_over = False

    def receive(self, message: BoardMessage) -> None:
        """Take what the board said; called while its bytes are decoded."""
        if isinstance(message, Reply) and self._before_answer is None:
            self._before_answer = self._decoder.frames

    def new(self, frames: list[SampleFrame], *, is_known: bool) -> list[SampleFrame]:
        """Those frames that are of this session.

        Parameters
        ----------
        frames : list of SampleFrame
            All that were just decoded.
        is_known : bool
            Whether the board has answered or turned out not to.
        """
        if self._is_over:
            return frames
        if not is_known:
            return []
        self._is_over = True
        first = self._decoder.frames - len(frames)
        return frames[max((self._before_answer or 0) - first, 0) :]
