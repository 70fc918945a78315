"""Whether what touches a patch of skin slips: it moves along the skin, and more than noise and grip can explain."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.settings import setting, validate
from acts_recon.slip.motion import Motion, MotionEstimator


@dataclass(frozen=True)
class SlipConfig:
    """When motion counts as slip."""

    slip_window_s: float = setting(
        0.05, "motion is looked for between now and so long ago [s]", minimum=0.002, maximum=1.0
    )
    slip_distance_m: float = setting(
        0.00015, "motion of less within the window is none [m]", minimum=1e-6, maximum=0.02
    )
    slip_distance_taxels: float = setting(
        0.08, "nor is that of less than this part of a taxel", minimum=0.001, maximum=5.0
    )
    slip_sigmas: float = setting(5.0, "nor is that of fewer standard deviations", minimum=1.0, maximum=100.0)
    slip_max_gain: float = setting(
        1.6,
        "nothing is told while the force changes by a larger factor within the window",
        minimum=1.01,
        maximum=100.0,
    )
    slip_min_counts: float = setting(
        300.0, "nothing is told of a patch with fewer counts in all", minimum=1.0, maximum=1e6
    )
    slip_hold_s: float = setting(0.03, "slip is over when none was told for longer [s]", minimum=0.0, maximum=1.0)

    def __post_init__(self) -> None:
        validate(self)


class Slip(NamedTuple):
    """What one patch feels of motion.

    Attributes
    ----------
    slipping : bool
    motion : Motion or None
        Within the window; None where nothing presses, or the window is not full yet.
    distance_taxels : float
        Distance within the window where that counts as motion; else 0.
    """

    slipping: bool
    motion: Motion | None
    distance_taxels: float


class SlipDetector:
    """Watches one patch.

    Parameters
    ----------
    rows, cols : int
        Size of the patch.
    pitch_m : float
        Distance of neighbouring taxels [m].
    config : SlipConfig, optional
    noise_counts : float
        Standard deviation of a taxel of the images [counts].
    """

    def __init__(
        self, rows: int, cols: int, pitch_m: float, config: SlipConfig | None = None, noise_counts: float = 1.5
    ) -> None:
        self.config = SlipConfig() if config is None else config
        self._estimator = MotionEstimator(rows, cols, noise_counts)
        self._pitch_m = pitch_m
        self._past: deque[tuple[float, NDArray[np.float32]]] = deque()
        self._told_s = -float("inf")

    def reset(self) -> None:
        """Forget what was, for instance after a pause."""
        self._past.clear()
        self._told_s = -float("inf")

    def step(self, time_s: float, image: NDArray[np.float32]) -> Slip:
        """Take the next image.

        Parameters
        ----------
        time_s : float
            Its time, later than that of the one before; after one that is not, everything begins anew [s].
        image : np.ndarray [shape=(rows, cols), dtype=float32]
            Counts above the baseline, finite; not kept.

        Raises
        ------
        ArrayError
            When it has another shape or type.
        """
        config, past = self.config, self._past
        if past and not time_s > past[-1][0]:
            self.reset()
        # The youngest of those that are old enough; until there is one, the contact has just begun.
        while len(past) > 1 and time_s - past[1][0] >= config.slip_window_s:
            past.popleft()
        motion = None
        if past and time_s - past[0][0] >= config.slip_window_s:
            reference = past[0][1]
            if min(float(reference.sum()), float(image.sum())) >= config.slip_min_counts:
                motion = self._estimator.between(reference, image)
        past.append((time_s, image.copy()))
        distance = 0.0
        if motion is not None and self._counts(motion):
            distance = motion.distance_taxels
            self._told_s = time_s
        return Slip(time_s - self._told_s <= config.slip_hold_s, motion, distance)

    def _counts(self, motion: Motion) -> bool:
        config, distance = self.config, motion.distance_taxels
        return (
            distance >= max(config.slip_distance_taxels, config.slip_distance_m / self._pitch_m)
            and distance >= config.slip_sigmas * motion.sd_taxels
            and 1.0 / config.slip_max_gain <= motion.gain <= config.slip_max_gain
        )
