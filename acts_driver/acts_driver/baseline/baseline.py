# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What each taxel reads untouched: the baseline, and its file."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, MAX_SIDE
from acts_core.errors import ArrayError, SettingsError
from acts_core.files import read_npz, write_whole

_FORMAT = "acts_baseline"
_VERSION = 1
# Of the largest array 50 kB are needed.
_BYTES_MAX = 1 << 24
# Later times fit into no stamp of a message.
_TIME_MAX_NS = 2**31 * 10**9 - 1


class BaselineSource(IntEnum):
    """How a baseline was determined; the numbers are those of acts_msgs/Baseline."""

    NONE = 0
    FILE = 1
    CALIBRATION = 2
    TARE = 3


@dataclass(frozen=True, eq=False)
class Baseline:
    """Reading and noise of every untouched taxel.

    Attributes
    ----------
    counts : np.ndarray [shape=(rows, cols), dtype=float32]
        Mean reading [counts]; 0 where it is not known.
    noise_counts : np.ndarray [shape=(rows, cols), dtype=float32]
        Standard deviation of one reading about it [counts].
    valid : np.ndarray [shape=(rows, cols), dtype=bool]
        Whether the baseline of the taxel is known.
    source : BaselineSource
        How it was determined.
    time_ns : int
        When, in ROS time [ns].
    board_id : int
        Serial number of the board on whose skin it was determined; 0 where that is not known.
    """

    counts: NDArray[np.float32]
    noise_counts: NDArray[np.float32]
    valid: NDArray[np.bool_]
    source: BaselineSource
    time_ns: int
    board_id: int = 0

    def __post_init__(self) -> None:
        shape = self.counts.shape
        if len(shape) != 2 or not all(1 <= side <= MAX_SIDE for side in shape):
            raise ArrayError(f"a baseline of shape {shape}: needed are rows and columns, 1 to {MAX_SIDE}")
        if self.noise_counts.shape != shape or self.valid.shape != shape:
            raise ArrayError(
                f"baseline {shape}, noise {self.noise_counts.shape}, valid {self.valid.shape}: needed are equal shapes"
            )
        for name, values in (("baseline", self.counts), ("noise", self.noise_counts)):
            # Written so that NaN fails too.
            if not (np.all(values >= 0) and np.all(values <= COUNT_MAX)):
                raise ArrayError(f"{name} must lie between 0 and {COUNT_MAX} counts, without NaN")

    @classmethod
    def none(cls, rows: int, cols: int) -> Baseline:
        """What tells that no taxel has a baseline."""
        nothing = np.zeros((rows, cols), dtype=np.float32)
        return cls(nothing, nothing, np.zeros((rows, cols), dtype=np.bool_), BaselineSource.NONE, 0)

    def save(self, path: Path) -> None:
        """Write the file of a calibration; an older one is replaced only by a whole new one.

        Raises
        ------
        SettingsError
            When it cannot be written.
        """
        self.write(path, "the baseline cannot be saved there: set calibration_file to a path that can be written")

    def write(self, path: Path, hint: str) -> None:
        """Write an npz file, as `save` does; where it cannot be written, `hint` tells what to do."""
        with write_whole(path, error=SettingsError, hint=hint, makes_folder=True) as file:
            np.savez(
                file,
                format=_FORMAT,
                version=_VERSION,
                baseline=self.counts,
                noise=self.noise_counts,
                valid=self.valid,
                source=int(self.source),
                time_ns=self.time_ns,
                board_id=np.uint64(self.board_id),
            )

    @classmethod
    def load(cls, path: Path, rows: int, cols: int, *, keeps_source: bool = False) -> Baseline:
        """Read what `save` wrote.

        Parameters
        ----------
        path : Path
            The file.
        rows, cols : int
            Size of the array.
        keeps_source : bool
            Whether the source is the one it had when it was saved; otherwise it is the file.

        Raises
        ------
        SettingsError
            When the file cannot be read, is no baseline, or one of another array.
        """
        again = "calibrate again, or remove the file"
        content = read_npz(path, error=SettingsError, hint=again, limit_bytes=_BYTES_MAX)
        try:
            # What does not fit into 32 bits is refused with the rest, not told on the screen.
            with np.errstate(over="ignore", invalid="ignore"):
                counts, noise = (
                    content[name].astype(np.float32, casting="same_kind") for name in ("baseline", "noise")
                )
            if str(content["format"]) != _FORMAT or int(content["version"]) != _VERSION:
                raise SettingsError(f"{path}: no baseline of this release; {again}")
            time_ns = int(content["time_ns"])
            if not 0 <= time_ns <= _TIME_MAX_NS:
                raise ArrayError(f"time_ns = {time_ns}: a time lies between 0 and {_TIME_MAX_NS} ns")
            # Older files have none.
            board_id = int(content.get("board_id", 0))
            if not 0 <= board_id < 2**64:
                raise ArrayError(f"board_id = {board_id}: a serial number lies between 0 and 2**64 - 1")
            baseline = cls(
                counts=counts,
                noise_counts=noise,
                # NaN, and any number, would be true.
                valid=content["valid"].astype(np.bool_, casting="same_kind"),
                source=BaselineSource(int(content["source"])) if keeps_source else BaselineSource.FILE,
                time_ns=time_ns,
                board_id=board_id,
            )
        except KeyError as error:
            raise SettingsError(f"{path}: no baseline, or a damaged one, it lacks {error.args[0]}; {again}") from error
        except (ValueError, OverflowError, TypeError, ArrayError) as error:
            raise SettingsError(f"{path}: no baseline, or a damaged one ({error}); {again}") from error
        if baseline.counts.shape != (rows, cols):
            given = " x ".join(map(str, baseline.counts.shape))
            raise SettingsError(f"{path}: a baseline of {given} taxels, the array has {rows} x {cols}; {again}")
        return baseline
