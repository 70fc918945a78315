# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Pictures of the simulated hand, with and without a graphics library."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from acts_core.errors import ActsError
from acts_sim.hand import HandWorld, HandWorldConfig, held_object
from acts_sim.hand.objects import OBJECTS
from acts_sim.hand.pictures import HandPicture, draw_hand
from acts_sim.hand.pictures.picture import VIEWS

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def world() -> HandWorld:
    world = HandWorld(HandWorldConfig(object="cylinder"))
    for _ in range(100):
        world.step()
    return world


def test_the_rendered_hand_holds_something_orange_and_is_pressed_by_it(world: HandWorld) -> None:
    try:
        picture = HandPicture(world, 320, 240)
    except ActsError as error:
        pytest.skip(str(error))
    for view in VIEWS:
        pixels = picture.take(view).astype(int)
        assert pixels.shape == (240, 320, 3)
        orange = (pixels[..., 0] > 100) & (pixels[..., 0] > 1.4 * pixels[..., 2])
        grey = (pixels.max(axis=2) > 60) & (pixels.max(axis=2) < 200) & (np.ptp(pixels, axis=2) < 30)
        assert orange.mean() > 0.01
        assert grey.mean() > 0.02
    picture.close()


@pytest.mark.parametrize("name", OBJECTS)
def test_the_drawing_shows_hand_object_and_pressed_taxels(world: HandWorld, name: str) -> None:
    figure = Figure(figsize=(3, 3))
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_subplot(projection="3d")
    draw_hand(axes, world.truth, world.layout, held_object(name), world.counts)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())[..., :3].astype(int)
    assert ((pixels[..., 0] > 180) & (pixels[..., 2] < 120)).mean() > 0.0005
