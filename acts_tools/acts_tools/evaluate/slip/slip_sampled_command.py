# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate slip-sampled`: delay of slip detection on a skin whose taxels are measured in turn.

All patches of a layout are pressed by simulated contacts. The contact on one patch begins to move, and the time from
0.2 mm of motion to the detection of slip is measured. Detections without motion are counted in a steady hold and while
all contacts close. The whole chain is used: the board's sampler, fusion over time, regions.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import SettingsError
from acts_core.sampling import SamplingConfig, SkinMap
from acts_core.skin import Layout, SkinPatch, layout
from acts_recon.fusion import known_noise
from acts_recon.settings import ReconstructionSettings
from acts_recon.slip import SlipConfig
from acts_tools.arguments import add_settings, at_least_one, given_settings, real
from acts_tools.evaluate import report
from acts_tools.evaluate.broken_taxels import BrokenTaxels
from acts_tools.evaluate.options import add_json, add_m
from acts_tools.firmware.board_sampler import BoardSampler

_NOTICED_M = 0.0002
_NOISE_COUNTS = 2.0
_SPEEDS_M_S = (0.01, 0.03, 0.1)
_ACCELERATIONS_M_S2 = (1.0, 5.0)
_FRAME_S = 0.001
_CLOSING_FRAMES = 200
_SHAPES = ("soft", "sharp", "edge")

Array = NDArray[np.float64]


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate slip-sampled``."""
    parser = commands.add_parser(
        "slip-sampled",
        help="measure the delay of slip detection where few taxels are measured per frame",
        description="Press all patches of a layout by simulated contacts, sample them by tracking at 1 kHz, fuse the "
        "samples, and detect slip: measure its delay after 0.2 mm of motion on one patch, and count detections "
        "without motion.",
    )
    parser.add_argument("--layout", default="leap_right", metavar="L", help="name or file (default: %(default)s)")
    add_m(parser, (55, 128))
    parser.add_argument(
        "--seeds",
        type=at_least_one,
        default=6,
        metavar="N",
        help="seeds for each of 3 kinds of contact (default: %(default)s)",
    )
    parser.add_argument(
        "--hold-s", type=real(0.0, 1e6), default=60.0, metavar="T", help="time of the hold (default: %(default)s)"
    )
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="set a limit of slip (docs/reference.md, reconstruction: slip_...)",
    )
    add_settings(parser, BrokenTaxels)
    add_json(parser)
    parser.set_defaults(evaluate=_run)


class Skin:
    """A contact on every patch, at a random position near its centre."""

    def __init__(self, skin: Layout, shape: str, seed: int) -> None:
        rng = np.random.default_rng(seed)
        self.layout, self.shape = skin, shape
        self._contacts = [
            (rng.uniform(-0.45, 0.45, 2), rng.uniform(0.004, 0.009), rng.uniform(250, 800)) for _ in skin.patches
        ]
        self._pictures: dict[int, Array] = {}
        self.moving = int(rng.integers(len(skin.patches)))
        # Motion of an edge along itself is not visible.
        self.angle = math.pi / 2 if shape == "edge" else float(rng.uniform(0, 2 * math.pi))

    def at(self, time_s: float, moved_m: float = 0.0) -> Array:
        """Counts of all taxels while all contacts close and then hold; the contact on one patch has moved."""
        frame = min(round(time_s / _FRAME_S), _CLOSING_FRAMES)
        if frame not in self._pictures:
            force = frame / _CLOSING_FRAMES
            self._pictures[frame] = np.zeros((self.layout.rows, self.layout.cols))
            for k, patch in enumerate(self.layout.patches):
                patch.of(self._pictures[frame])[:] = self._counts(k, force, np.zeros(2))
        if not moved_m:
            return self._pictures[frame]
        moved = self._pictures[frame].copy()
        way_m = moved_m * np.array([math.cos(self.angle), math.sin(self.angle)])
        self.layout.patches[self.moving].of(moved)[:] = self._counts(self.moving, frame / _CLOSING_FRAMES, way_m)
        return moved

    def _counts(self, patch: int, force: float, way_m: Array) -> Array:
        at, radius_m, peak = self._contacts[patch]
        return force * peak * _press(self.shape, self.layout.patches[patch], at, way_m, radius_m * (0.6 + 0.4 * force))


def _press(shape: str, patch: SkinPatch, at: Array, move: Array, radius_m: float) -> Array:
    """Relative pressure of a contact at `at` [half sizes of the patch], moved by `move` [m]."""
    parts = np.linspace(-0.4, 0.4, 5)  # a taxel reads the mean over its area
    x = patch.geometry.x_m(np.add.outer(np.arange(patch.cols), parts).ravel())
    y = patch.geometry.y_m(np.add.outer(np.arange(patch.rows), parts).ravel())
    x = x - at[0] * patch.cols * patch.pitch_m / 2 - move[0]
    y = (y - at[1] * patch.rows * patch.row_pitch_m / 2 - move[1])[:, None]
    if shape == "soft":
        fine = np.exp(-2.0 * (x**2 + y**2) / radius_m**2)
    elif shape == "sharp":
        fine = np.sqrt(np.maximum(1.0 - (x**2 + y**2) / radius_m**2, 0.0))
    else:
        fine = np.exp(-2.0 * y**2 / radius_m**2) / (1.0 + np.exp((np.abs(x) - 0.007) / 0.0008))
    mean: Array = fine.reshape(patch.rows, 5, patch.cols, 5).mean(axis=(1, 3))
    return mean


def told(
    skin: Layout,
    m: int,
    seed: int,
    seconds: float,
    picture_at: Callable[[float], Array],
    slip: SlipConfig,
    broken: BrokenTaxels,
) -> list[tuple[float, int]]:
    """Time [s] and patch of every start of slip."""
    sound = ~broken.are_broken(skin.matrix_rows, skin.matrix_cols)

    def matrix_at(time_s: float) -> NDArray[np.uint16]:
        return np.rint(skin.matrix(picture_at(time_s)) * sound).astype(np.uint16)

    config = SamplingConfig(scheme="tracking", m=m, threshold_counts=50, seed=seed + 1)
    # A driver tells its board how the taxels lie on the skin.
    dead = broken.are_dead(skin.matrix_rows, skin.matrix_cols)
    sampler = BoardSampler(config, _NOISE_COUNTS, skin_map=None if skin.is_matrix else SkinMap.of(skin, dead))
    settings = ReconstructionSettings(
        layout=skin.name,
        noise_counts=known_noise(_NOISE_COUNTS),
        dead_taxels=broken.dead_taxels,
        **asdict(slip),
    )
    recovery = settings.recovery()
    regions = settings.regions(recovery)
    if regions is None:
        raise SettingsError(f"--layout {skin.name}: the reconstruction tells no slip of a skin of one patch on no link")
    found: list[tuple[float, int]] = []
    slipping = [False] * len(skin.patches)
    before = matrix_at(0.0)
    for k in range(1, round(seconds / _FRAME_S)):
        time_s = k * _FRAME_S
        after = matrix_at(time_s)
        indices, counts = sampler.frame(np.stack((before, after)), 1.0 / m, 1.0 / m)
        if recovery.dead is not None:
            indices, counts = recovery.dead.left_out(indices, counts)
        recovery.step(indices, counts, time_s, 0.95 * _FRAME_S)
        before = after
        for p, region in enumerate(regions.step(time_s, recovery.image, recovery.measured, recovery.age_s)):
            if region.slipping and not slipping[p]:
                found.append((time_s, p))
            slipping[p] = region.slipping
    return found


def _delay_ms(
    skin: Skin,
    m: int,
    seed: int,
    way_m: Callable[[float], float],
    noticed_s: float,
    slip: SlipConfig,
    broken: BrokenTaxels,
) -> tuple[float, int]:
    """Delay after 0.2 mm [ms], inf for never; and number of detections without motion."""
    begin_s = 0.3 + seed * _FRAME_S

    def picture_at(time_s: float) -> Array:
        return skin.at(time_s, way_m(max(time_s - begin_s, 0.0)))

    found = told(skin.layout, m, seed, begin_s + noticed_s + 0.05, picture_at, slip, broken)
    times_s = [time_s for time_s, patch in found if patch == skin.moving and time_s > begin_s]
    delay_s = times_s[0] - begin_s - noticed_s if times_s else math.inf
    return 1e3 * delay_s, len(found) - len(times_s)


def _in_words(delay_ms: float) -> str:
    return f"{delay_ms:.0f}" if math.isfinite(delay_ms) else "never"


def _run(arguments: argparse.Namespace) -> int:
    slip = SlipConfig(**given_settings(SlipConfig, arguments.set, "limits of slip"))
    broken = BrokenTaxels(broken_taxels=arguments.broken_taxels, dead_taxels=arguments.dead_taxels)
    about = {"layout": arguments.layout, "hold_s": arguments.hold_s, "slip": asdict(slip), **asdict(broken)}
    results = report.Results(arguments.json, about)
    skin = layout(arguments.layout, 32, 32)
    print(
        "| M | detected after 0.2 mm: median, last [ms] | false slips while closing | in the hold |\n|---|---|---|---|"
    )
    motions: list[tuple[Callable[[float], float], float]] = [
        *((lambda t, v=v: v * t, _NOTICED_M / v) for v in _SPEEDS_M_S),
        *((lambda t, a=a: 0.5 * a * t * t, math.sqrt(2 * _NOTICED_M / a)) for a in _ACCELERATIONS_M_S2),
    ]
    for m in arguments.m:
        delays_ms, closing = [], 0
        for seed in range(arguments.seeds):
            for shape in _SHAPES:
                pressed = Skin(skin, shape, seed)
                for way_m, noticed_s in motions:
                    delay_ms, wrong = _delay_ms(pressed, m, seed, way_m, noticed_s, slip, broken)
                    delays_ms.append(delay_ms)
                    closing += wrong
        found = told(skin, m, 0, 0.5 + arguments.hold_s, Skin(skin, "soft", 0).at, slip, broken)
        holding = sum(time_s > 0.5 for time_s, _ in found)
        delay = ", ".join(_in_words(delay_ms) for delay_ms in (float(np.median(delays_ms)), max(delays_ms)))
        # JSON knows no infinity: null where slip was never reported.
        known_ms = [delay_ms if math.isfinite(delay_ms) else None for delay_ms in delays_ms]
        results.add(
            {"m": m, "delay_ms": known_ms, "false_closing": closing, "false_holding": holding},
            f"| {m} | {delay} of {len(delays_ms)} | {closing} | {holding} |",
        )
    return 0
