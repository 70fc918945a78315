# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A pseudo-terminal in the part of a board, behind a stable link that survives unplugging."""

from __future__ import annotations

import os
import select
import tty
from functools import partial
from pathlib import Path

import numpy as np
import waiting

from acts_core.frames import SampleFrame, Scheme
from acts_core.wire import encode_frame

DEADLINE_S = 20.0
wait_for = partial(waiting.wait_for, timeout_s=DEADLINE_S)


def frame(sequence: int, *, rows: int = 32, cols: int = 32, m: int = 5, board_us: int | None = None) -> SampleFrame:
    """A frame whose samples are a function of its number."""
    random = np.random.default_rng(sequence)
    return SampleFrame(
        sequence=sequence & 0xFFFFFFFF,
        board_us=1_000_000 + 1000 * sequence if board_us is None else board_us,
        duration_us=973,
        scheme=Scheme.ADAPTIVE,
        rows=rows,
        cols=cols,
        overruns=0,
        indices=random.permutation(rows * cols)[:m].astype(np.uint16),
        counts=random.integers(0, 1024, m).astype(np.uint16),
    )


class PtyBoard:
    """Writes what it is told to a pseudo-terminal that `path` points to."""

    def __init__(self, folder: Path) -> None:
        self.path = folder / "board"
        self._master = -1
        self._slave = -1

    @property
    def master(self) -> int:
        """The board's end."""
        return self._master

    def plug_in(self) -> None:
        """Open a new pseudo-terminal and set the link."""
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        link = self.path.with_suffix(".new")
        link.symlink_to(os.ttyname(self._slave))
        link.replace(self.path)

    def write(self, data: bytes) -> None:
        """Write all of it, however little the reader takes at a time; fail when nobody reads."""
        while data:
            _, writable, _ = select.select([], [self._master], [], DEADLINE_S)
            assert writable, "nobody reads the pseudo-terminal"
            data = data[os.write(self._master, data) :]

    def write_frames(self, *frames: SampleFrame) -> None:
        """Write frames as the binary protocol has them."""
        self.write(b"".join(map(encode_frame, frames)))

    def unplug(self) -> None:
        """Close the pseudo-terminal and remove the link, as udev does."""
        self.path.unlink(missing_ok=True)
        for descriptor in (self._slave, self._master):
            if descriptor >= 0:
                os.close(descriptor)
        self._master = self._slave = -1

    def __enter__(self) -> PtyBoard:
        self.plug_in()
        return self

    def __exit__(self, *_: object) -> None:
        self.unplug()
