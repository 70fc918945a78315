# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Fast events: what they promise."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import ndimage

from acts_core.errors import SettingsError
from acts_sim.pressing import (
    EVENT_RATE_HZ,
    EVENTS,
    PRESS_RATE_HZ,
    ContactModel,
    FoamConfig,
    event_recordings,
    press_over_time,
)
from acts_sim.pressing.event_contacts import GOLF_BALL
from acts_sim.pressing.events import register

pytestmark = pytest.mark.slow


def centres(frames: NDArray[np.uint16]) -> NDArray[np.float64]:
    row, col = np.indices(frames.shape[1:])
    weight = frames.sum(axis=(1, 2)).astype(float)
    return np.stack(((frames * row).sum(axis=(1, 2)) / weight, (frames * col).sum(axis=(1, 2)) / weight), axis=1)


@pytest.mark.parametrize("name", EVENTS)
def test_events_are_repeatable_and_begin_untouched(name: str) -> None:
    (frames,) = event_recordings(name, 1, seed=4)
    assert frames.dtype == np.uint16
    assert frames.shape[1:] == (32, 32)
    assert frames.max() <= 1023
    assert frames.max() > 100
    assert not frames[: int(0.010 * EVENT_RATE_HZ)].any()
    if not name.startswith("slide"):
        np.testing.assert_array_equal(frames, event_recordings(name, 2, seed=4)[0])


def test_a_slide_has_its_speed() -> None:
    for frames in event_recordings("slide_2_m_s", 3, seed=1):
        place = centres(frames[frames.any(axis=(1, 2))][100:280])
        moved_m = np.linalg.norm(place[120] - place[0]) * 140e-3 / 32
        assert moved_m * EVENT_RATE_HZ / 120 == pytest.approx(2.0, rel=0.15)


def test_a_bounce_lasts_as_long_as_the_paper_saw() -> None:
    (frames,) = event_recordings("bounce", 1, seed=1)
    _, bounces = ndimage.label(frames.any(axis=(1, 2)))
    assert bounces == 3
    touched_s = frames.any(axis=(1, 2)).sum() / bounces / EVENT_RATE_HZ
    assert 0.006 < touched_s <= 0.0087


@pytest.mark.parametrize("side", [2, 4])
def test_taps_have_their_size_anywhere(side: int) -> None:
    places = set()
    for frames in event_recordings(f"tap_{side}x{side}", 20, seed=2):
        pressed = np.argwhere(frames.any(axis=0))
        assert len(pressed) == side**2
        assert np.ptp(pressed, axis=0).max() == side - 1
        places.add(tuple(pressed[0]))
    assert len(places) > 15


def test_two_taps_are_apart_and_the_second_comes_later() -> None:
    for frames in event_recordings("two_taps", 5, seed=3):
        contacts = [ndimage.label(frame, structure=np.ones((3, 3)))[1] for frame in frames]
        assert max(contacts) == 2
        assert contacts.index(2) - contacts.index(1) >= 0.030 * EVENT_RATE_HZ


def test_an_unknown_event_is_refused() -> None:
    with pytest.raises(SettingsError, match="tap_2x2"):
        event_recordings("earthquake", 1, seed=1)


def test_an_event_of_a_taken_name_is_refused() -> None:
    with pytest.raises(SettingsError, match="'two_taps' is registered twice"):
        register("two_taps", 1)(lambda rng: event_recordings("bounce", 1, seed=1)[0])


def test_a_press_goes_down_and_up_again() -> None:
    model = ContactModel(config=FoamConfig(noise_counts=0.0), seed=8)
    frames = press_over_time(model, GOLF_BALL)
    total = frames.sum(axis=(1, 2), dtype=int)
    assert len(frames) == 0.3 * PRESS_RATE_HZ + 1
    assert total[0] == total[-1] == 0
    assert total[20:60].min() > 0.7 * total.max()
