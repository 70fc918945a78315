# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The footprint that explains an impact: its derivatives, and that it finds again what the samples were made of."""

from __future__ import annotations

import math

import numpy as np
import pytest

from acts_recon.impacts.footprint_model import VOLUME, FootprintModel, minimise, spread_points

NODES = 5


def samples(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """When [ms] and where [mm] taxels of 4 mm are measured in 8 ms: each of 24 x 24 is, in random order."""
    row, col = np.divmod(rng.permutation(24 * 24), 24)
    return np.linspace(0.0, 8.0, row.size), 4.0 * (col - 11.5), 4.0 * (row - 11.5)


@pytest.mark.parametrize("is_long", [False, True])
@pytest.mark.parametrize("stretch", [0.0, 1e-4, 0.3, 1.5])
def test_derivatives_are_those_of_the_residuals(is_long: bool, stretch: float) -> None:
    rng = np.random.default_rng(3)
    time_ms, x_mm, y_mm = samples(rng)
    force_n = np.exp(-(x_mm**2 + y_mm**2) / 200.0)
    model = FootprintModel(time_ms, x_mm, y_mm, force_n, np.full(x_mm.size, 0.05), NODES, is_long=is_long)
    state = model.start() + 0.1 * rng.standard_normal(4 + 2 * NODES + 2 * is_long)
    if is_long:
        state[-2:] = stretch * math.cos(0.7), stretch * math.sin(0.7)
    step = 1e-6
    each = step * np.eye(state.size)
    numeric = np.column_stack(
        [(model.residuals(state + one) - model.residuals(state - one)) / (2 * step) for one in each]
    )
    np.testing.assert_allclose(model.jacobian(state), numeric, rtol=0, atol=1e-6)


@pytest.mark.parametrize("angle_rad", [0.0, 0.6, 1.4, 2.6])
@pytest.mark.parametrize(("length_mm", "width_mm"), [(24.0, 6.0), (12.0, 6.0)])
def test_a_long_footprint_is_found_again(angle_rad: float, length_mm: float, width_mm: float) -> None:
    time_ms, x_mm, y_mm = samples(np.random.default_rng(4))
    dx, dy = x_mm - 5.0 - 0.5 * (time_ms - 4.0), y_mm + 3.0 - 1.0 * (time_ms - 4.0)
    along = dx * math.cos(angle_rad) + dy * math.sin(angle_rad)
    across = dy * math.cos(angle_rad) - dx * math.sin(angle_rad)
    force_n = np.exp(-(((along / length_mm) ** 2 + (across / width_mm) ** 2) ** 1.5) / 2)
    model = FootprintModel(time_ms, x_mm, y_mm, force_n, np.full(x_mm.size, 0.01), NODES, is_long=True)
    state = minimise(model, model.start())
    p, q = state[-2:].tolist()
    since_ms = model.middle - 4.0
    np.testing.assert_allclose(state[:4], [5.0 + 0.5 * since_ms, -3.0 + since_ms, 0.5, 1.0], atol=0.02)
    assert math.exp(math.hypot(p, q)) == pytest.approx(length_mm / width_mm, rel=0.02)
    assert math.cos(math.atan2(q, p) - 2 * angle_rad) == pytest.approx(1.0, abs=1e-3)
    volume = VOLUME * np.exp(state[model.amplitudes]) * np.exp(state[model.widths]) ** 2
    np.testing.assert_allclose(volume, VOLUME * length_mm * width_mm, rtol=0.03)


def test_of_a_round_footprint_the_long_one_is_round() -> None:
    time_ms, x_mm, y_mm = samples(np.random.default_rng(5))
    force_n = np.exp(-((x_mm**2 + y_mm**2) ** 1.5) / 2 / 10.0**3)
    model = FootprintModel(time_ms, x_mm, y_mm, force_n, np.full(x_mm.size, 0.01), NODES, is_long=True)
    assert math.hypot(*minimise(model, model.start())[-2:]) < 1e-3


@pytest.mark.parametrize("angle_rad", [0.0, 0.6, 1.4, 2.6])
@pytest.mark.parametrize(("length", "width"), [(2.0, 0.5), (1.0, 1.0)])
def test_points_all_over_a_footprint_hold_its_force(angle_rad: float, length: float, width: float) -> None:
    s = math.log(length / width)
    dx, dy, share = spread_points(s * np.array([math.cos(2 * angle_rad), math.sin(2 * angle_rad)]))
    y, x = 0.05 * (np.indices((241, 241)) - 120.0)
    along, across = x * math.cos(angle_rad) + y * math.sin(angle_rad), y * math.cos(angle_rad) - x * math.sin(angle_rad)
    force = np.exp(-(((along / length) ** 2 + (across / width) ** 2) ** 1.5) / 2)
    assert share.sum() == pytest.approx(1.0)
    for of_points, of_force in ((dx * dx, x * x), (dx * dy, x * y), (dy * dy, y * y)):
        assert share @ of_points == pytest.approx((force * of_force).sum() / force.sum(), abs=0.01)
