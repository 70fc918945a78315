# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate ricochet`: from which direction a thrown ball came, at eight angles. The paper's figure 5G.

The paper's estimate is the total displacement of the centre of pressure, from the first frame that shows the ball to
the last. What the numbers mean is told in docs/impacts.md.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from acts_core.array import ArrayGeometry
from acts_core.skin import ForceResponse
from acts_recon.contacts import ContactFinder
from acts_recon.impacts import UNKNOWN_DIRECTION_SD_RAD
from acts_sim.impacts import SCENE_RATE_HZ, Scene, ball_named, scene, thrown
from acts_sim.pressing import skin_of
from acts_tools.arguments import real, simulated_taxels
from acts_tools.evaluate import report
from acts_tools.evaluate.estimators.methods import PAPER_TOUCH_COUNTS, paper_method
from acts_tools.evaluate.impacts import plays
from acts_tools.evaluate.options import add_scene_arguments
from acts_tools.evaluate.scene_recordings import add_recordings_argument, scene_results, write_recording
from acts_tools.evaluate.statistics import distribution_with_max, wilson
from acts_tools.progress import Progress

ANGLES_DEG = (0, 45, 90, 135, 180, -135, -90, -45)
SPEEDS_M_S = (1.0, 2.0, 3.0)
_DESCENT_DEG = (25.0, 35.0)
_TOUCH_S = 0.008
_MIDDLE_M = 0.02
SCHEME = "tracking"
_TITLE = (
    f"{'m/s':>4} {'angle':>5} {'throws':>6} {'paper deg':>9} {'none':>4} {'ours deg':>8} {'none':>4} "
    f"{'within 1 sigma':>14}"
)
_GUESS_DEG = 90.0
"""Mean error of a direction that is guessed."""


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate ricochet``."""
    parser = commands.add_parser(
        "ricochet",
        help="estimate the direction of rubber balls thrown at the simulated skin",
        description="Throw rubber balls at the simulated skin at a shallow angle, from eight directions and with three "
        "speeds, and estimate the direction. docs/impacts.md explains the numbers.",
    )
    parser.add_argument("--m", type=simulated_taxels, default=64, help="taxels per frame (default: %(default)s)")
    parser.add_argument(
        "--speeds",
        type=real(0.1, 20.0),
        nargs="+",
        default=list(SPEEDS_M_S),
        metavar="V",
        help="[m/s] (default: 1 2 3)",
    )
    add_scene_arguments(parser, 25, "throws of each angle and speed")
    add_recordings_argument(parser, "the first throw of each angle and speed")
    parser.set_defaults(evaluate=_run)


def numbered_throw(speed_m_s: float, angle_deg: int, seed: int, number: int) -> Scene:
    """A throw with a speed from an angle, by its number."""
    return throw_of(
        speed_m_s, angle_deg, np.random.default_rng([seed, round(1000 * speed_m_s), angle_deg % 360, number])
    )


def throw_of(speed_m_s: float, angle_deg: int, rng: np.random.Generator) -> Scene:
    """A rubber ball off a ramp: it comes down at about 30 degrees and rolls by a random share."""
    ball = ball_named("rubber")
    direction_rad, descent_rad = math.radians(angle_deg), math.radians(rng.uniform(*_DESCENT_DEG))
    speed = speed_m_s * rng.uniform(0.95, 1.05)
    # It passes the middle of the array, give or take 20 mm.
    back_m = speed * math.cos(descent_rad) * _TOUCH_S / 2
    x_m, y_m = rng.uniform(-_MIDDLE_M, _MIDDLE_M, 2) - back_m * np.array(
        [math.cos(direction_rad), math.sin(direction_rad)]
    )
    throw = thrown(
        speed,
        direction_rad,
        descent_rad,
        float(x_m),
        float(y_m),
        rolling=rng.uniform(0.0, 1.0),
        radius_m=ball.radius_m,
    )
    return scene(skin_of(rng), ball, throw, rng=rng)


class PaperDirections:
    """Adaptive sampling, recovery of each frame by itself, and the way of the centre of pressure."""

    def __init__(self, m: int, noise_counts: float) -> None:
        self._m, self._noise_counts = m, noise_counts
        self._recovery = paper_method()
        self._finder = ContactFinder(ArrayGeometry(), ForceResponse(), float(PAPER_TOUCH_COUNTS))

    def direction_rad(self, shown: Scene, seed: int) -> float | None:
        """None where fewer than two frames show the ball."""
        centres = self.path_m(shown, seed)
        if len(centres) < 2:
            return None
        return math.atan2(centres[-1][1] - centres[0][1], centres[-1][0] - centres[0][0])

    def path_m(self, shown: Scene, seed: int) -> list[tuple[float, float]]:
        """Centre of pressure in each frame that shows the ball [m]."""
        centres = []
        for frame in plays.frames_of_paper(shown, self._m, self._noise_counts, seed):
            image = self._recovery.step(frame.indices, frame.counts, frame.end_s, frame.duration_s)
            contact = self._finder.find(image.ravel())
            if contact.in_contact:
                centres.append((contact.x_m, contact.y_m))
        return centres


def _run(arguments: argparse.Namespace) -> int:
    # A speed that is named twice is one: its throws would count twice.
    speeds = list(dict.fromkeys(arguments.speeds))
    about = {name: getattr(arguments, name) for name in ("m", "noise_counts", "seed", "seeds")}
    results = scene_results(arguments, {"speeds": speeds, **about})
    paper = PaperDirections(arguments.m, arguments.noise_counts)
    ours = plays.Ours(SCHEME, arguments.m, arguments.noise_counts)
    all_paper: list[float | None] = []
    all_ours: list[tuple[float, float] | None] = []
    print(_TITLE, flush=True)
    with Progress("ricochet", len(speeds) * len(ANGLES_DEG) * arguments.seeds) as progress:
        done = 0
        for speed_m_s in speeds:
            for angle_deg in ANGLES_DEG:
                of_paper: list[float | None] = []
                of_ours: list[tuple[float, float] | None] = []
                for number in range(arguments.seeds):
                    shown = numbered_throw(speed_m_s, angle_deg, arguments.seed, number)
                    if arguments.recordings is not None and number == 0:
                        name = f"throw_{speed_m_s:g}_m_s_{angle_deg % 360}_deg"
                        write_recording(arguments.recordings, name, shown.frames, SCENE_RATE_HZ)
                    of_paper.append(error_deg(paper.direction_rad(shown, number + 1), angle_deg))
                    of_ours.append(told_by_us(ours, shown, number + 1, angle_deg))
                    progress.show(done := done + 1)
                all_paper += of_paper
                all_ours += of_ours
                entry = {"speed_m_s": speed_m_s, "angle_deg": angle_deg, **scores_of(of_paper, of_ours)}
                results.add(entry, _line(entry))
    entry = {"speed_m_s": None, "angle_deg": None, **scores_of(all_paper, all_ours)}
    results.add(entry, _line(entry))
    return 0


def error_deg(direction_rad: float | None, angle_deg: int) -> float | None:
    """Error of a direction [deg]; None where none is told."""
    if direction_rad is None:
        return None
    return abs(math.remainder(math.degrees(direction_rad) - angle_deg, 360.0))


def told_by_us(ours: plays.Ours, shown: Scene, seed: int, angle_deg: int) -> tuple[float, float] | None:
    """Error and standard deviation [deg] of the strongest touch; None where no direction of it is told."""
    impact = plays.strongest_over(ours.play(shown, seed))
    if impact is None or impact.direction_sd_rad >= UNKNOWN_DIRECTION_SD_RAD:
        return None
    error = error_deg(impact.direction_rad, angle_deg)
    return None if error is None else (error, math.degrees(impact.direction_sd_rad))


def scores_of(paper: Sequence[float | None], ours: Sequence[tuple[float, float] | None]) -> dict[str, Any]:
    """An entry of the report, from the errors of throws; ours with their standard deviations."""
    told = [one for one in ours if one is not None]
    within = sum(error <= sd for error, sd in told)
    return {
        "throws": len(paper),
        "paper": _errors([error for error in paper if error is not None], len(paper)),
        "acts": {
            **_errors([error for error, _ in told], len(ours)),
            "within_1_sigma": within / len(told) if told else None,
            "within_1_sigma_95": wilson(within, len(told)),
            "within_2_sigma": sum(error <= 2 * sd for error, sd in told) / len(told) if told else None,
        },
    }


def _errors(errors_deg: Sequence[float], throws: int) -> dict[str, Any]:
    """Errors where a direction is told, and of all where one that is not told counts as guessed."""
    unknown = throws - len(errors_deg)
    return {
        "unknown": unknown,
        **{f"{name}_deg": value for name, value in distribution_with_max(errors_deg).items()},
        "mean_with_guesses_deg": (sum(errors_deg) + unknown * _GUESS_DEG) / throws,
    }


def _line(entry: dict[str, Any]) -> str:
    paper, ours = entry["paper"], entry["acts"]
    return (
        f"{report.number(entry['speed_m_s'], 4, 1)} {report.number(entry['angle_deg'], 5, 0)} {entry['throws']:6} "
        f"{report.number(paper['mean_deg'], 9, 2)} {paper['unknown']:4} {report.number(ours['mean_deg'], 8, 2)} "
        f"{ours['unknown']:4} {report.number(ours['within_1_sigma'], 14, 2)}"
    )
