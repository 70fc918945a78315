# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.array import TOUCH_COUNTS, ArrayGeometry
from acts_core.errors import SettingsError
from acts_sim.pressing import OBJECTS, ContactModel, ContactObject, FoamConfig, object_named
from acts_sim.pressing.contact_model import Press
from acts_sim.pressing.objects import register
from acts_sim.pressing.outlines import box, disc, prism

GEOMETRY = ArrayGeometry()
DISC = ContactObject("disc", "test", (0.0003, 0.0015), lambda x, y: prism(disc(x, y, 0.012)))


def centre_m(forces: NDArray[np.float64]) -> tuple[float, float]:
    x, y = np.meshgrid(GEOMETRY.x_m(np.arange(32)), GEOMETRY.y_m(np.arange(32)))
    return float((forces * x).sum() / forces.sum()), float((forces * y).sum() / forces.sum())


def test_the_register_holds_the_papers_list_in_its_order() -> None:
    printed = [item.name for item in OBJECTS.values() if item.group == "printed"]
    daily = [item.name for item in OBJECTS.values() if item.group == "daily"]
    assert list(OBJECTS) == [*printed, *daily]
    assert printed == [
        "two_cylinders",
        "three_lines",
        "diagonal_line",
        "three_rings",
        "triangle",
        "circle",
        "square",
        "x",
    ]
    assert daily == [
        "computer_mouse",
        "art_scissors",
        "pliers",
        "wristwatch",
        "fidget_spinner",
        "rubber_ball",
        "hex_bar",
        "aaa_battery",
        "wrench",
        "bolt_and_nut",
        "spoon",
        "soft_brain",
        "tennis_ball",
        "glass_mug",
        "multitool",
        "cologne",
        "glue_bottle",
        "nine_volt_battery",
        "eraser",
        "power_adapter",
        "screwdriver",
        "tweezers",
    ]


@pytest.mark.parametrize("item", OBJECTS.values(), ids=list(OBJECTS))
def test_every_object_touches_with_its_lowest_point_and_fits_on_the_pad(item: ContactObject) -> None:
    x, y = np.meshgrid(np.linspace(-0.07, 0.07, 281), np.linspace(-0.07, 0.07, 281))
    gap = item.gap_m(x, y)
    assert gap.shape == x.shape
    assert np.isfinite(gap).all()
    assert 0 <= gap.min() < 2e-4
    shallow, deep = item.depth_m
    assert 0 < shallow < deep < 0.01
    touching = gap < deep
    assert 20e-6 < touching.sum() * 0.0005**2 < 0.004
    edge = np.ones_like(touching)
    edge[1:-1, 1:-1] = False
    assert not (touching & edge).any()


def test_the_force_is_where_the_object_is() -> None:
    model = ContactModel()
    forces = model.forces_n(object_named("circle"), Press(x_m=0.021, y_m=-0.013))
    assert centre_m(forces) == pytest.approx((0.021, -0.013), abs=2e-4)


def test_the_total_force_is_stiffness_times_area_times_depth() -> None:
    model = ContactModel(config=FoamConfig(stiffness_n_per_m3=1e7))
    block = ContactObject("block", "test", (0.001, 0.002), lambda x, y: prism(box(x, y, 0.035, 0.035)))
    forces = model.forces_n(block, Press(depth_m=0.001))
    # The rounded edge adds a little.
    assert forces.sum() == pytest.approx(1e7 * 0.035**2 * 0.001, rel=0.03)
    assert model.forces_n(block, Press(depth_m=0.002)).sum() > 1.9 * forces.sum()


def test_turning_counter_clockwise_and_scaling() -> None:
    model = ContactModel()
    hex_bar = object_named("hex_bar")
    flat = model.forces_n(hex_bar, Press())
    assert np.ptp(np.nonzero(flat > 0.02)[1]) > 2 * np.ptp(np.nonzero(flat > 0.02)[0])
    row, col = np.nonzero(model.forces_n(hex_bar, Press(angle_rad=math.pi / 4)) > 0.02)
    # Counter-clockwise: the right end is further up, and up is towards row 0.
    assert np.corrcoef(row, col)[0, 1] < -0.9
    assert model.forces_n(hex_bar, Press(scale=0.5)).sum() < 0.5 * flat.sum()


def test_a_tilted_object_presses_harder_on_one_side() -> None:
    forces = ContactModel().forces_n(object_named("square"), Press(tilt_x=0.02))
    assert centre_m(forces)[0] < -0.002
    assert abs(centre_m(forces)[1]) < 1e-6


def test_foam_spreads_the_force_without_losing_any() -> None:
    narrow = ContactModel(config=FoamConfig(spread_m=0.0003))
    wide = ContactModel(config=FoamConfig(spread_m=0.006))
    sharp, soft = narrow.forces_n(DISC, Press()), wide.forces_n(DISC, Press())
    assert soft.sum() == pytest.approx(sharp.sum(), rel=1e-3)
    assert soft.max() < 0.9 * sharp.max()
    assert np.count_nonzero(soft > 1e-3) > 1.5 * np.count_nonzero(sharp > 1e-3)


def test_an_object_beside_the_pad_and_one_above_it_leave_no_force() -> None:
    model = ContactModel()
    assert not (model.forces_n(DISC, Press(x_m=0.2)) > 1e-9).any()
    assert not model.forces_n(DISC, Press(depth_m=0.0)).any()


def test_counts_are_seeded_noisy_and_in_range() -> None:
    forces = ContactModel().forces_n(object_named("square"), Press(depth_m=0.002))
    first, again, other = (ContactModel(seed=seed).counts(forces) for seed in (4, 4, 5))
    assert first.dtype == np.uint16
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)
    assert 500 < first.max() <= 1023
    model = ContactModel(config=FoamConfig(noise_counts=0, gain_spread=0))
    assert np.array_equal(model.counts(forces), np.rint(model.response.counts(forces)))


def test_noise_has_the_stated_size() -> None:
    model = ContactModel(config=FoamConfig(noise_counts=5))
    forces = np.full((32, 32), 0.3)
    difference = model.counts(forces).astype(float) - model.counts(forces)
    assert difference.std() == pytest.approx(5 * math.sqrt(2), rel=0.1)


def test_random_presses_reach_all_of_the_pad() -> None:
    model = ContactModel(seed=3)
    presses = [model.random_press(DISC) for _ in range(300)]
    for values in ([press.x_m for press in presses], [press.y_m for press in presses]):
        assert min(values) < -0.06
        assert max(values) > 0.06
        assert max(np.abs(values)) <= 0.07
    assert all(0.0003 <= press.depth_m <= 0.0015 for press in presses)


def test_an_array_of_another_size() -> None:
    model = ContactModel(ArrayGeometry(rows=33, cols=15, pitch_m=0.006))
    frame = model.random_frame(object_named("tennis_ball"))
    assert frame.shape == (33, 15)


def test_unknown_and_repeated_names_are_refused() -> None:
    with pytest.raises(SettingsError, match="'cube' does not exist; known are two_cylinders"):
        object_named("cube")
    with pytest.raises(SettingsError, match="'spoon' is registered twice"):
        register("spoon", "daily")(lambda x, y: x)


def test_a_centre_weighted_by_counts_is_pulled_to_where_less_presses() -> None:
    """The figures of docs/reconstruction.md: 20 random presses of each object, taxels above the touch threshold."""
    model = ContactModel(seed=1)
    by_counts_m, by_force_m = [], []
    for item in OBJECTS.values():
        for _ in range(20):
            forces = model.forces_n(item, model.random_press(item))
            counts = model.counts(forces)
            pressed = counts > TOUCH_COUNTS
            if not pressed.any():
                continue
            truth = centre_m(forces * pressed)
            by_counts_m.append(math.dist(centre_m(counts.astype(float) * pressed), truth))
            by_force_m.append(math.dist(centre_m(model.response.force_n(counts) * pressed), truth))
    assert len(by_counts_m) > 500
    assert np.median(by_counts_m) == pytest.approx(1.0e-3, abs=0.05e-3)
    assert np.median(by_force_m) == pytest.approx(0.07e-3, abs=0.005e-3)
