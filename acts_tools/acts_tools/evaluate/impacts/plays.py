# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A scene as a board samples it, as the paper's method sees it and as ours does."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from acts_recon.fusion import known_noise
from acts_recon.impacts import Impact
from acts_recon.settings import ReconstructionSettings
from acts_sim.impacts import SCENE_RATE_HZ, Scene
from acts_tools.evaluate.estimators.methods import PAPER_TOUCH_COUNTS
from acts_tools.evaluate.scene_frames import DETECTOR_TOUCH_COUNTS, FOLLOW_COUNTS, Frame, frames_of


def frames_of_paper(scene: Scene, m: int, noise_counts: float, seed: int) -> Iterator[Frame]:
    """Frames as in the paper: adaptive sampling, and a raster of the whole array."""
    scheme = "raster" if m >= scene.frames[0].size else "adaptive"
    return frames_of(scene.frames, SCENE_RATE_HZ, scheme, m, PAPER_TOUCH_COUNTS, noise_counts, seed)


def strongest_over(told: Sequence[tuple[float, Impact]]) -> Impact | None:
    """The touch with the largest peak of those that are over, chosen without the truth; None where none is.

    Parameters
    ----------
    told : sequence of (float, Impact)
        What `Ours.play` returns.
    """
    return max((impact for _, impact in told if impact.is_over), key=lambda impact: impact.peak_n, default=None)


class Ours:
    """Fusion of all samples, and the detector of impacts.

    Parameters
    ----------
    scheme : str
    m : int
        Taxels per frame.
    noise_counts : float
        Of a reading.
    """

    def __init__(self, scheme: str, m: int, noise_counts: float) -> None:
        self.scheme = scheme
        self._m, self._noise_counts = m, noise_counts
        settings = ReconstructionSettings(touch_counts=DETECTOR_TOUCH_COUNTS, noise_counts=known_noise(noise_counts))
        self._recovery = settings.recovery()
        self._detector = settings.impact_detector(self._recovery)

    def play(self, scene: Scene, seed: int) -> list[tuple[float, Impact]]:
        """What is told of a scene, each with the end of the frame that told it [s]."""
        recovery = self._recovery
        recovery.reset()
        self._detector.reset()
        told: list[tuple[float, Impact]] = []
        for frame in frames_of(
            scene.frames, SCENE_RATE_HZ, self.scheme, self._m, FOLLOW_COUNTS, self._noise_counts, seed
        ):
            recovery.step(frame.indices, frame.counts, frame.end_s, frame.duration_s)
            found = self._detector.step(
                frame.end_s, frame.duration_s, recovery.image, recovery.sigma, recovery.age_s, recovery.measured
            )
            told += [(frame.end_s, impact) for impact in found]
        return told
