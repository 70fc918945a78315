# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""From frame to image and contact: what happens to every frame, in the node reconstruction and without it."""

from __future__ import annotations

import threading
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from acts_core.array import check_untouched
from acts_core.errors import ArrayError
from acts_core.frames import SampleFrame
from acts_core.runtime import SequenceNumbers
from acts_recon.contacts import Contact
from acts_recon.frame_order import FrameOrder
from acts_recon.images import BaselineSubtraction
from acts_recon.settings import ReconstructionConfig

# A change of the baseline by no more is drift: it is published from half a count on, once a second at most.
_DRIFT_COUNTS = 2.0


class ArraySizeError(ArrayError):
    """A frame is of another array than the one it was given for."""


class RepeatedFrameError(ArrayError):
    """A frame came a second time: its samples are known already, and would count as two measurements."""


class FramePipeline:
    """Checks, counts and recovers frame after frame; everything is compiled when the constructor is through.

    Parameters
    ----------
    settings : ReconstructionConfig
        Size, layout and method, as the node's parameters.
    forget : callable
        Called when all frames are forgotten: whoever keeps something of them forgets it, too.

    Attributes
    ----------
    size : (int, int)
        Rows and columns of the array.
    recovery : Recovery
        With the image of the newest frame.
    every : SampleFrame or None
        The newest, with all samples of live taxels, and counts less the baseline; the next one overwrites them.
    frame : SampleFrame or None
        The same with each taxel once.
    contact : Contact
        All that presses, as one.

    Raises
    ------
    ArrayError, SettingsError
        As of `ReconstructionConfig.recovery`.
    """

    def __init__(self, settings: ReconstructionConfig, forget: Callable[[], None]) -> None:
        self.recovery = settings.recovery()
        self.size = (settings.rows, settings.cols)
        self._forget_more = forget
        self._samples = self.recovery.skin.placed_samples()
        self._baseline = BaselineSubtraction(settings.rows * settings.cols)
        self._numbers = SequenceNumbers()
        self._order = FrameOrder()
        self._last = (-1, -1)
        self._touch_counts = settings.touch_counts
        # Baselines come on another thread than frames.
        self._lock = threading.Lock()
        self._is_other_zero = False
        # Last measurement of each taxel, with the baseline; 0: none since frames were forgotten.
        self._raw = np.zeros(settings.rows * settings.cols, dtype=np.uint16)
        self._noise: tuple[NDArray[np.float32], NDArray[np.bool_]] | None = None
        self.every: SampleFrame | None = None
        self.frame: SampleFrame | None = None
        self.contact = Contact()

    @property
    def lost(self) -> int:
        """Frames missing so far; see `SequenceNumbers`."""
        return self._numbers.lost

    @property
    def source_changes(self) -> int:
        """How often frames of two sources came in turn; see `FrameOrder`."""
        return self._order.changes

    @property
    def restarts(self) -> int:
        """How often a board began anew, as far as the numbers of its frames say; see `FrameOrder`."""
        return self._order.restarts

    @property
    def subtracts(self) -> bool:
        """Whether there is a baseline."""
        return self._baseline.is_set

    def set_baseline(
        self, counts: NDArray[np.float32], noise_counts: NDArray[np.float32], valid: NDArray[np.bool_]
    ) -> None:
        """Use from the next frame on what the taxels read untouched.

        See `BaselineSubtraction.set` and `Method.set_noise`. It may be called on another thread than `step`.

        Where a taxel's last measurement is a touch by the one baseline and none by the other, as after a tare, all
        frames are forgotten with the next one: what differs then has not happened on the skin. So they are where the
        baseline of a taxel changes by more than `touch_counts`, and they are not where it drifts, by 2 counts at most.

        Raises
        ------
        ArrayError
            One of the two cannot be; nothing is changed then.
        """
        check_untouched("noise", noise_counts, valid, self.size[0] * self.size[1])
        dead = self.recovery.skin.dead_taxels
        # What a dead taxel reads untouched says nothing either: it may jump from one calibration to the next.
        used = valid if dead is None else valid & ~dead.ravel()
        with self._lock:
            raw = self._raw.copy()  # a frame may come meanwhile
            was_touched = self._baseline.are_above(raw, self._touch_counts)
            change = np.abs(self._baseline.set(counts, used))
            has_turned = was_touched != self._baseline.are_above(raw, self._touch_counts)
            # What drifts is asked first: `touch_counts` may be less.
            if ((change > _DRIFT_COUNTS) & (has_turned | (change > self._touch_counts))).any():
                self._is_other_zero = True
            self._noise = noise_counts.copy(), valid.copy()

    def reset(self) -> None:
        """Forget all frames: the next one is long after or before, or of another board."""
        self._forget()
        self._numbers = SequenceNumbers()
        self._order = FrameOrder()
        self._last = (-1, -1)

    def step(self, frame: SampleFrame, stamp_ns: int) -> int:
        """Recover one frame. A board that counts from the start again is another board.

        Parameters
        ----------
        frame : SampleFrame
        stamp_ns : int
            Time of its last measurement [ns].

        Returns
        -------
        int
            Frames that are missing between the last one and this.

        Raises
        ------
        ArraySizeError
            The frame is of another size; it is not counted.
        RepeatedFrameError
            The frame is the last one once more; it is not counted.
        ArrayError
            Its samples are not of this matrix, or its times are none. It has come, so it is not missing.
        """
        lost = self.count(frame)
        every = frame
        with self._lock:
            if self._is_other_zero:
                self._is_other_zero = False
                self._forget()
            # Here, because a method is in use on this thread while it recovers a frame.
            noise, self._noise = self._noise, None
            if noise is not None:
                self.recovery.set_noise(*noise)
            if self._baseline.is_set:
                every = frame._replace(counts=self._baseline.apply(frame.indices, frame.counts))
        if every.repeats:
            # Recovery takes the last sample of each taxel, but `every` is for those that take all.
            self._samples.of(every.indices, every.counts, may_repeat=True)
        if self.recovery.dead is not None:
            live_indices, live_counts = self.recovery.dead.left_out(every.indices, every.counts)
            every = every._replace(indices=live_indices, counts=live_counts)
        once = every.once()
        self.contact = self.recovery.step(once.indices, once.counts, stamp_ns * 1e-9, once.duration_us * 1e-6)
        # Not before: only now it is known that they are of this matrix.
        self._raw[frame.indices] = frame.counts
        self.every, self.frame = every, once
        return lost

    def count(self, frame: SampleFrame) -> int:
        """Check and count one frame without recovering it; parameters, result and errors as of `step`."""
        if frame.rows != self.size[0] or frame.cols != self.size[1]:
            raise ArraySizeError(
                f"frame of {frame.rows} x {frame.cols} taxels, expected are {self.size[0]} x {self.size[1]}"
            )
        # A board that begins anew may come to the number of the last frame, but not at the same time.
        this = (frame.sequence, frame.board_us)
        if this == self._last:
            raise RepeatedFrameError(
                f"frame {frame.sequence} came a second time with the same stamp; needed is each frame once, with a "
                "number and a stamp of its own: is its topic published twice?"
            )
        self._last = this
        if self._order.step(frame.sequence, frame.board_us):
            self._forget()
        return self._numbers.step(frame.sequence)

    def _forget(self) -> None:
        self._raw.fill(0)
        self.recovery.reset()
        self._forget_more()
