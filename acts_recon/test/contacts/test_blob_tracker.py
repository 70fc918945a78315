# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Whether contacts keep their numbers: sliding, away for a moment, joined, parted, crossing, too many."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as st_numpy
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.skin import ForceResponse
from acts_recon.contacts import MAX_BLOBS, BlobConfig, BlobTracker, TrackedBlob

pytestmark = pytest.mark.slow

GEOMETRY = ArrayGeometry()
PITCH_M = GEOMETRY.pitch_m
RESPONSE = ForceResponse()
ROW, COL = np.indices((32, 32))
FRAME_S = 1e-3

Press = tuple[float, float, float, float]
"""Row, column, width [taxels], and force on the taxel in the middle [N]."""


def picture(presses: Sequence[Press]) -> NDArray[np.float32]:
    """An image of round presses whose forces add."""
    force = np.zeros((32, 32))
    for row, col, width, newtons in presses:
        force += newtons * np.exp(-((ROW - row) ** 2 + (COL - col) ** 2) / (2 * width**2))
    return np.rint(RESPONSE.counts(force)).astype(np.float32)


@pytest.fixture(scope="module")
def shared_tracker() -> BlobTracker:
    return BlobTracker(GEOMETRY, RESPONSE)


@pytest.fixture
def tracker(shared_tracker: BlobTracker) -> BlobTracker:
    """Without contacts; numbers go on from test to test."""
    shared_tracker.reset()
    return shared_tracker


def run(
    tracker: BlobTracker, presses: Callable[[int], Sequence[Press]], frames: int, *, begin: int = 0
) -> list[tuple[TrackedBlob, ...]]:
    return [tracker.step(picture(presses(begin + k)), (begin + k) * FRAME_S) for k in range(frames)]


def numbers(found: Sequence[TrackedBlob]) -> list[int]:
    return [blob.number for blob in found]


def nearest(found: Sequence[TrackedBlob], row: float, col: float) -> int:
    """Number of the contact at a place."""
    x_m, y_m = float(GEOMETRY.x_m(col)), float(GEOMETRY.y_m(row))
    return min(found, key=lambda blob: (blob.x_m - x_m) ** 2 + (blob.y_m - y_m) ** 2).number


def test_a_contact_has_position_velocity_force_and_shape(tracker: BlobTracker) -> None:
    image = np.zeros((32, 32), dtype=np.float32)
    image[10, 20:24] = 300
    tracker.step(image, 0.0)
    (blob,) = tracker.step(np.roll(image, 0, axis=0), 0.001, np.full((32, 32), 4, dtype=np.float32))
    assert (blob.x_m, blob.y_m) == pytest.approx((6 * PITCH_M, 5.5 * PITCH_M))
    assert blob.force_n == pytest.approx(4 * float(RESPONSE.force_n(300)))
    assert (blob.peak_counts, blob.active_taxels, blob.merged) == (300, 4, 0)
    assert blob.area_m2 == pytest.approx(4 * PITCH_M**2)
    assert blob.spread_m == pytest.approx(PITCH_M * np.sqrt(1.25))
    assert blob.angle_rad == 0
    assert blob.age_s == pytest.approx(0.001)
    assert min(blob.x_sd_m, blob.vx_sd_m_s, blob.vy_sd_m_s, blob.force_sd_n, blob.spread_sd_m) > 0
    # All taxels lie on one row, so that noise cannot shift the centre across it, but for taxels that were not noticed.
    assert blob.y_sd_m < 1e-6
    (upright,) = tracker.step(np.ascontiguousarray(image.T), 0.002)
    assert upright.angle_rad == pytest.approx(np.pi / 2)
    deviations = (upright.x_sd_m, upright.y_sd_m, upright.vx_sd_m_s, upright.vy_sd_m_s)
    assert (*deviations, upright.force_sd_n, upright.area_sd_m2, upright.spread_sd_m) == (0.0,) * 7


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 31), st.integers(0, 31), st.lists(st.floats(61, 1023, width=32), min_size=1, max_size=8))
def test_rounding_gives_no_direction(shared_tracker: BlobTracker, row: int, col: int, counts: list[np.float32]) -> None:
    """A single taxel has none, taxels in a column have that of y, never its opposite."""
    image = np.zeros((32, 32), dtype=np.float32)
    image[row : row + len(counts), col] = counts[: 32 - row]
    shared_tracker.reset()
    (blob,) = shared_tracker.step(image, 0.0)
    assert blob.angle_rad == (0 if blob.active_taxels == 1 else pytest.approx(np.pi / 2))
    assert blob.active_taxels > 1 or blob.spread_m == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(("pitch_m", "row_pitch_m"), [(0.005, 0.005), (0.002, 0.008), (0.012, 0.003)])
@pytest.mark.parametrize(("down", "right"), [(0, 1), (1, 0), (1, 1), (-1, 1)])
def test_a_tip_goes_on_to_the_next_taxel_however_far_rows_and_columns_are_apart(
    pitch_m: float, row_pitch_m: float, down: int, right: int
) -> None:
    """Where columns lay four times as far apart as rows it had a new number at each of them."""
    tracker = BlobTracker(ArrayGeometry(32, 32, pitch_m, row_pitch_m), RESPONSE)
    found = []
    for frame in range(100):
        image = np.zeros((32, 32), dtype=np.float32)
        image[16 + down * (frame // 20), 8 + right * (frame // 20)] = 500
        found.append(numbers(tracker.step(image, frame * FRAME_S, np.full_like(image, 2))))
    assert found == [[1]] * 100
    # Two taxels farther along each axis it is another one.
    image = np.zeros((32, 32), dtype=np.float32)
    image[16 + 7 * down, 8 + 7 * right] = 500
    assert numbers(tracker.step(image, 100 * FRAME_S, np.full_like(image, 2))) == [2]


@settings(max_examples=40, deadline=None)
@given(
    st.floats(0, 2),
    st.floats(0, 2 * np.pi),
    st.lists(st.tuples(st.floats(0.4, 1.2), st.floats(0.3, 2)), min_size=1, max_size=3),
)
def test_sliding_contacts_keep_their_numbers(
    shared_tracker: BlobTracker, speed_m_s: float, angle: float, kinds: list[tuple[float, float]]
) -> None:
    """Up to 2 m/s at once, abreast or one behind the other, in any direction, without leaving the skin."""
    shared_tracker.reset()
    step = speed_m_s * FRAME_S / PITCH_M
    frames = 20

    def presses(k: int) -> list[Press]:
        along = step * (k - frames / 2)
        return [
            (
                15.5 + 9 * (i - (len(kinds) - 1) / 2) - along * np.sin(angle),
                15.5 + along * np.cos(angle),
                width,
                newtons,
            )
            for i, (width, newtons) in enumerate(kinds)
        ]

    history = run(shared_tracker, presses, frames)
    first = sorted(numbers(history[0]))
    assert len(first) == len(kinds)
    assert all(sorted(numbers(found)) == first for found in history)
    for i in range(len(kinds)):
        rows_cols = [presses(k)[i][:2] for k in (0, frames - 1)]
        assert nearest(history[0], *rows_cols[0]) == nearest(history[-1], *rows_cols[1])


@pytest.mark.parametrize("speed_m_s", [0.1, 0.5, 2.0])
def test_the_velocity_is_that_of_the_contact(tracker: BlobTracker, speed_m_s: float) -> None:
    step = speed_m_s * FRAME_S / PITCH_M
    history = run(tracker, lambda k: [(12.0 + 0.5 * step * k, 4.0 + step * k, 1.5, 2.0)], 50)
    velocity = np.array([(blob.vx_m_s, blob.vy_m_s) for (blob,) in history[15:]])
    assert velocity[:, 0] == pytest.approx(speed_m_s, abs=0.05)
    assert velocity[:, 1] == pytest.approx(-0.5 * speed_m_s, abs=0.05)


@pytest.mark.parametrize("rate_hz", [9, 24, 55, 250])
def test_a_contact_that_begins_to_move_has_its_velocity_at_any_frame_rate(tracker: BlobTracker, rate_hz: int) -> None:
    """From the third frame on, and where frames are faster than that, after a tenth of a second."""
    speed_m_s, rest = 0.1, 20
    step = speed_m_s / rate_hz / PITCH_M
    for k in range(-rest, max(7, rate_hz // 4)):
        image = 600 * np.exp(-((ROW - 16) ** 2 + (COL - 8 - step * max(k, 0)) ** 2) / 8)
        (blob,) = tracker.step(image.astype(np.float32), (rest + k) / rate_hz)
        assert blob.vy_m_s == pytest.approx(0, abs=0.01)
        if k >= max(3, 0.1 * rate_hz):
            assert blob.vx_m_s == pytest.approx(speed_m_s, rel=0.3)


@pytest.mark.parametrize("away", [1, 5, 15])
def test_a_contact_that_is_away_for_a_moment_keeps_its_number(tracker: BlobTracker, away: int) -> None:
    def presses(k: int) -> list[Press]:
        return [] if 30 <= k < 30 + away else [(16.0, 4.0 + 0.2 * k, 0.8, 1.0)]

    history = run(tracker, presses, 70)
    assert all(found == () for found in history[30 : 30 + away])
    assert {number for found in history for number in numbers(found)} == {history[0][0].number}


def test_a_number_does_not_come_again(tracker: BlobTracker) -> None:
    history = run(tracker, lambda k: [(16.0, 16.0, 1.0, 1.0)] if k % 40 < 10 else [], 400)
    assert sorted({number for found in history for number in numbers(found)}) == list(
        range(history[0][0].number, history[0][0].number + 10)
    )


def test_a_contact_far_away_is_another(tracker: BlobTracker) -> None:
    history = run(tracker, lambda k: [(5.0, 5.0 if k < 10 else 20.0, 1.0, 1.0)], 12)
    assert numbers(history[9]) != numbers(history[10])


def joined_and_parted(k: int) -> list[Press]:
    """Two that come near one another, stay, and go back to where they came from; the stronger moves the less."""
    distance = 3.5 + 0.05 * max(abs(k - 250) - 100, 0)
    return [(16.0, 14.0, 1.3, 2.0), (16.0, 14.0 + distance, 1.3, 1.0)]


def test_joined_contacts_have_the_number_of_the_stronger_and_part_with_their_own(tracker: BlobTracker) -> None:
    history = run(tracker, joined_and_parted, 500)
    strong, weak = nearest(history[0], 16, 14), nearest(history[0], 16, 25)
    joined = [found for found in history if len(found) == 1]
    assert len(joined) > 150
    assert {(blob.number, blob.merged) for (blob,) in joined} == {(strong, 1)}
    assert {tuple(sorted(numbers(found))) for found in history if len(found) == 2} == {tuple(sorted((strong, weak)))}
    assert (nearest(history[-1], 16, 14), nearest(history[-1], 16, 25)) == (strong, weak)


@pytest.mark.parametrize("speed_m_s", [0.2, 0.5, 1.0])
@pytest.mark.parametrize("lane", [0.0, 1.5, 3.0])
@pytest.mark.parametrize("newtons", [(2.0, 1.0), (1.0, 1.0), (1.0, 1.6)])
def test_crossing_contacts_keep_their_numbers(
    tracker: BlobTracker, speed_m_s: float, lane: float, newtons: tuple[float, float]
) -> None:
    """Two that pass through one another, or by one another so near that they look like one."""
    step = speed_m_s * FRAME_S / PITCH_M
    frames = round(20 / step)

    def presses(k: int) -> list[Press]:
        return [(15.0, 6.0 + step * k, 1.2, newtons[0]), (15.0 + lane, 26.0 - step * k, 1.2, newtons[1])]

    history = run(tracker, presses, frames)
    left, right = nearest(history[0], 15, 6), nearest(history[0], 15, 26)
    assert min(len(found) for found in history) == 1
    assert {number for found in history for number in numbers(found)} == {left, right}
    assert (nearest(history[-1], 15, 26), nearest(history[-1], 15, 6)) == (left, right)


def test_three_contacts_join_and_part_with_their_numbers(tracker: BlobTracker) -> None:
    def presses(k: int) -> list[Press]:
        away = 0.05 * max(abs(k - 150) - 30, 0)
        return [(16.0, 15.0, 1.2, 2.0), (16.0, 19.0 + away, 1.2, 1.5), (20.0 + away, 15.0, 1.2, 1.0)]

    history = run(tracker, presses, 300)
    places = [(16, 15), (16, 25), (26, 15)]
    first = [nearest(history[0], *place) for place in places]
    assert len(set(first)) == 3
    assert numbers(history[150]) == [first[0]]
    assert history[150][0].merged == 2
    assert [nearest(history[-1], *place) for place in places] == first
    assert {number for found in history for number in numbers(found)} == set(first)


def test_of_a_contact_that_parts_the_stronger_keeps_the_number(tracker: BlobTracker) -> None:
    def presses(k: int) -> list[Press]:
        return [(16.0, 16.0, 1.2, 1.0), (16.0, 19.0 + 0.05 * k, 1.2, 1.5)]

    history = run(tracker, presses, 150)
    assert len(history[0]) == 1
    assert len(history[-1]) == 2
    assert nearest(history[-1], 16, 26) == history[0][0].number


def test_what_joined_long_ago_is_forgotten() -> None:
    tracker = BlobTracker(GEOMETRY, RESPONSE, BlobConfig(memory_s=0.05))

    history = run(tracker, joined_and_parted, 500)
    assert sorted(numbers(history[0])) == [1, 2]
    assert history[250][0].merged == 0
    assert sorted(numbers(history[-1])) == [nearest(history[0], 16, 14), 3]


def test_of_too_many_contacts_the_weakest_are_left_out_and_the_others_keep_their_numbers(tracker: BlobTracker) -> None:
    image = np.zeros((32, 32), dtype=np.float32)
    image[::4, ::4] = 100 + 5 * np.arange(64).reshape(8, 8)
    first = tracker.step(image, 0.0)
    assert (len(first), tracker.dropped) == (MAX_BLOBS, 48)
    assert sorted(blob.peak_counts for blob in first) == sorted(image.ravel())[-MAX_BLOBS:]
    assert numbers(tracker.step(image, 0.001)) == numbers(first)
    assert tracker.step(np.zeros_like(image), 0.002) == ()
    assert tracker.dropped == 0


def test_a_contact_that_comes_back_among_many_new_ones_keeps_its_number(tracker: BlobTracker) -> None:
    def among(places: Iterable[int]) -> NDArray[np.float32]:
        """Contacts at these places of 64."""
        grid = np.zeros(64)
        grid[list(places)] = 500
        image = np.zeros((32, 32), dtype=np.float32)
        image[::4, ::4] = grid.reshape(8, 8)
        return image

    first = numbers(tracker.step(among(range(16)), 0.0))
    # Now as many are away as active.
    second = numbers(tracker.step(among(range(32, 48)), 0.001))
    found = numbers(tracker.step(among([*range(8), *range(48, 56)]), 0.002))
    assert found[:8] == first[:8]
    assert min(found[8:]) > max(second)
    assert len(set(found)) == MAX_BLOBS


def test_time_that_goes_back_makes_everything_new(tracker: BlobTracker) -> None:
    image = picture([(16, 16, 1.5, 1.0)])
    (before,) = tracker.step(image, 5.0)
    (same,) = tracker.step(image, 5.5)
    (after,) = tracker.step(image, 4.0)
    assert same.number == before.number
    assert after.number == before.number + 1
    assert after.age_s == 0


_ANY = st.floats(0, 1023, width=32) | st.sampled_from([np.nan, np.inf, -np.inf, -5.0, 1e30, 1023.0])


@settings(max_examples=40, deadline=None)
@given(
    st.lists(
        st.tuples(
            st_numpy.arrays(np.float32, (8, 9), elements=_ANY, fill=st.sampled_from([0.0, 100.0])),
            st.none() | st_numpy.arrays(np.float32, (8, 9), elements=_ANY),
            st.sampled_from([0.0, 1e-4, 1e-3, 0.03, 0.5, 5.0, -1.0]),
        ),
        min_size=1,
        max_size=8,
    )
)
def test_numbers_are_unique_and_all_is_finite_whatever_comes(
    small_tracker: BlobTracker, frames: list[tuple[NDArray[np.float32], NDArray[np.float32] | None, float]]
) -> None:
    small_tracker.reset()
    time_s = 0.0
    youngest = 0
    for image, sigma, dt_s in frames:
        time_s += dt_s
        found = small_tracker.step(image, time_s, sigma)
        assert np.isfinite(np.array(found)).all()
        assert len(set(numbers(found))) == len(found) <= MAX_BLOBS
        assert all(blob.number > 0 and blob.force_n > 0 and blob.active_taxels > 0 for blob in found)
        assert [blob.age_s for blob in found] == sorted((blob.age_s for blob in found), reverse=True)
        # A number that is not above all before is one of a contact that was there before.
        assert all(blob.number > youngest or blob.age_s > 0 or dt_s == 0 for blob in found)
        youngest = max([youngest, *numbers(found)])


@pytest.fixture(scope="module")
def small_tracker() -> BlobTracker:
    return BlobTracker(ArrayGeometry(rows=8, cols=9), RESPONSE)


@pytest.mark.parametrize(
    "image",
    [
        np.zeros((32, 31), np.float32),
        np.zeros((32, 32)),
        np.zeros((64, 32), np.float32)[::2],
        np.zeros(1024, np.float32),
    ],
)
def test_images_of_another_kind_are_refused(tracker: BlobTracker, image: NDArray) -> None:
    with pytest.raises(ArrayError, match="needed is"):
        tracker.step(image, 0.0)
    with pytest.raises(ArrayError, match="sigma of shape"):
        tracker.step(np.zeros((32, 32), dtype=np.float32), 0.0, image)
