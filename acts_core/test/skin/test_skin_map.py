# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Sampling on a skin: neighbours are those of the layout, and none is on another patch."""

import dataclasses

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.errors import ArrayError
from acts_core.sampling import Sampler, SamplingConfig, SkinMap, measure_in
from acts_core.skin import NO_PATCH, Layout, SkinPatch, layout

GLOVE, INSOLE = layout("glove"), layout("insole")


def places(shape: Layout, scheme: str, picture: NDArray[np.integer], frames: int, **config: object) -> list[list[int]]:
    """Places of the picture that frames measure, in order."""
    settings = SamplingConfig(scheme, threshold_counts=60, **config)  # type: ignore[arg-type]
    sampler = Sampler(settings, SkinMap.of(shape))
    measure = measure_in(shape.matrix(picture))
    return [shape.places[sampler.frame(measure)[0]].tolist() for _ in range(frames)]


def pressed(shape: Layout, *where: tuple[int, int]) -> NDArray[np.integer]:
    picture = np.zeros((shape.rows, shape.cols), dtype=int)
    for row, col in where:
        picture[row, col] = 500
    return picture


def test_tracking_follows_a_finger_to_its_edge_and_not_the_one_beside_it() -> None:
    # The last column of the index finger; the next one is the middle's.
    picture = pressed(GLOVE, (5, 7))
    last = places(GLOVE, "tracking", picture, 200, m=55, search_share=0.2)[-1]
    followed = {32 * row + col for row in (4, 5, 6) for col in (6, 7)}
    assert set(last[-6:]) == followed
    whole = dataclasses.replace(GLOVE, patch_of=np.zeros((32, 32), dtype=np.uint8), patches=GLOVE.patches[:1])
    last = places(whole, "tracking", picture, 200, m=55, search_share=0.2)[-1]
    assert set(last[-9:]) == followed | {32 * row + 8 for row in (4, 5, 6)}


def test_adaptive_sampling_searches_one_finger() -> None:
    picture = np.where(GLOVE.patch_of == 2, 500, 0)
    (frame,) = places(GLOVE, "adaptive", picture, 1, m=700)
    of = GLOVE.patch_of.ravel()[frame]
    first = int(np.argmax(of == 2))
    # The whole finger, from the first taxel that was found pressed on, and nothing else meanwhile.
    assert (of[first : first + 128] == 2).all()


def test_both_halves_of_an_insole_are_found_at_once() -> None:
    for row in (10, 50):
        picture = pressed(INSOLE, *((r, c) for r in range(row, row + 6) for c in range(6, 12)))
        (frame,) = places(INSOLE, "adaptive", picture, 1, m=120)
        assert set(np.flatnonzero(picture)) <= set(frame)


def test_what_is_no_skin_is_never_pressed() -> None:
    patch_of = np.zeros((32, 32), dtype=np.uint8)
    patch_of[:, 16:] = NO_PATCH
    half = dataclasses.replace(layout("square"), patch_of=patch_of, patches=(SkinPatch("half", 0, 32, 0, 16),))
    everywhere = np.full((32, 32), 900)
    columns = np.array(places(half, "tracking", everywhere, 100, m=64)[-1]) % 32
    assert (columns[-50:] < 16).all()
    assert (columns >= 16).any(), "the search goes on everywhere"


def test_the_matrix_as_a_map_changes_nothing() -> None:
    rng = np.random.default_rng(1)
    field = rng.integers(0, 300, (20, 13))
    config = SamplingConfig("tracking", 20, 13, 40, threshold_counts=200)
    plain, mapped = Sampler(config), Sampler(config, SkinMap.of(layout("square", 20, 13)))
    for _ in range(20):
        assert np.array_equal(plain.frame(measure_in(field)), mapped.frame(measure_in(field)))
    assert SkinMap.of(layout("square", 20, 13)) == SkinMap.of_matrix(20, 13)


def test_maps_that_do_not_fit_are_refused() -> None:
    with pytest.raises(ArrayError, match="map of 1024 taxels: the matrix is 20 x 13"):
        Sampler(SamplingConfig(rows=20, cols=13), SkinMap.of(GLOVE))
    with pytest.raises(ArrayError, match="matrix of 65 x 1"):
        SkinMap.of_matrix(65, 1)
    many = dataclasses.replace(GLOVE, patches=GLOVE.patches * 3)
    with pytest.raises(ArrayError, match=r"18 patches.*a board takes 16"):
        SkinMap.of(many)


@pytest.mark.parametrize("shape", [layout("square"), GLOVE])
def test_tracking_does_not_follow_dead_taxels_whatever_they_read(shape: Layout) -> None:
    dead = np.zeros((32, 32), dtype=bool)
    dead[3] = True
    skin = np.asarray(shape.matrix(pressed(shape, (20, 20))))
    skin[dead] = 900

    def share(skin_map: SkinMap) -> tuple[float, bool]:
        """Of the samples, those of dead taxels; and whether the press is followed."""
        sampler = Sampler(SamplingConfig("tracking", threshold_counts=60, m=55), skin_map)
        frames = [sampler.frame(measure_in(skin))[0] for _ in range(100)][50:]
        at = int(shape.taxels[20, 20])
        return float(np.mean([dead.ravel()[frame].mean() for frame in frames])), all(at in frame for frame in frames)

    assert share(SkinMap.of(shape))[0] > 0.2
    found, is_followed = share(SkinMap.of(shape, dead))
    assert found < 0.05
    assert is_followed
