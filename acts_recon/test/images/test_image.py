# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

import numpy as np

from acts_recon.images import mono16, rgb8
from acts_recon.images.image import colour_table


def test_mono16_holds_rounded_counts() -> None:
    image = np.array([[0, 0.4, 0.6], [511.5, 1022.9, 1023]], dtype=np.float32)
    pixels = np.frombuffer(mono16(image), dtype="<u2")
    assert pixels.tolist() == [0, 0, 1, 512, 1023, 1023]


def test_colours_grow_lighter_evenly_from_black_to_white() -> None:
    table = colour_table().astype(float)
    assert table[0].tolist() == [0, 0, 0]
    assert table[-1].tolist() == [255, 255, 255]
    lightness = table @ [0.30, 0.59, 0.11]
    assert np.abs(lightness - np.arange(256)).max() < 6


def test_a_taxel_is_a_square_of_its_colour() -> None:
    image = np.array([[0, 1023], [300, 2000]], dtype=np.float32)
    pixels = np.frombuffer(rgb8(image, scale=3), dtype=np.uint8).reshape(6, 6, 3)
    assert (pixels[:3, :3] == 0).all()
    assert (pixels[:3, 3:] == 255).all()
    assert (pixels[3:, 3:] == 255).all()
    assert (pixels[3:, :3] == colour_table()[round(300 * 255 / 1023)]).all()


def test_the_scale_is_absolute() -> None:
    weak, strong = np.full((1, 2), 100, dtype=np.float32), np.array([[100, 1000]], dtype=np.float32)
    assert rgb8(weak, scale=1)[:3] == rgb8(strong, scale=1)[:3]
    assert rgb8(weak, scale=1, full_scale_counts=100) == b"\xff" * 6
