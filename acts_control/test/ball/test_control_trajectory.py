# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Trajectories: smooth, within reach and speed, and shaped like the letters."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_control.ball import Trajectory, TrajectoryConfig
from acts_control.ball.strokes import Arc, Line, circle, letter
from acts_control.ball.trajectory import SEGMENTS, parse
from acts_core.errors import SettingsError

pytestmark = pytest.mark.slow

STEP_S = 0.001


def sampled(config: TrajectoryConfig) -> tuple[NDArray[np.float64], NDArray[np.float64], list[str]]:
    """Times, references (n, 6) and segments, every millisecond."""
    trajectory = Trajectory(config)
    times = np.arange(-0.1, trajectory.duration_s + 0.2, STEP_S)
    points = [trajectory.at(float(time)) for time in times]
    return times, np.array([point.reference[:6] for point in points]), [point.segment for point in points]


def test_the_default_takes_about_30_seconds_and_names_its_segments() -> None:
    trajectory = Trajectory(TrajectoryConfig())
    assert 28.0 < trajectory.duration_s < 31.0
    _, _, segments = sampled(TrajectoryConfig())
    order = [name for k, name in enumerate(segments) if k == 0 or segments[k - 1] != name]
    assert order == ["hold", "move", "N", "move", "B", "move", "I"]


@pytest.mark.parametrize("text", ["hold,N,B,I", "circle", "B,hold,circle,N", "I,I"])
def test_position_velocity_and_acceleration_are_continuous_and_belong_together(text: str) -> None:
    config = TrajectoryConfig(trajectory=text)
    times, reference, _ = sampled(config)
    position, velocity, acceleration = reference[:, 0:2], reference[:, 2:4], reference[:, 4:6]
    # A jump of the acceleration would show as a difference over a step that does not shrink with it: bound the jerk.
    assert np.abs(np.diff(acceleration, axis=0)).max() < 3.0 * STEP_S
    assert np.abs(np.gradient(position, times, axis=0) - velocity).max() < 1e-4
    assert np.abs(np.gradient(velocity, times, axis=0) - acceleration).max() < 5e-3
    assert np.hypot(*velocity.T).max() <= config.speed_m_s * 1.001
    assert np.hypot(*acceleration.T).max() <= 1.5 * config.acceleration_m_s2
    assert np.abs(position).max() <= 0.045


@pytest.mark.parametrize("name", ["N", "B", "I"])
def test_letters_have_their_size_and_are_centred(name: str) -> None:
    points = np.array(
        [stroke.at(s)[:2] for stroke in letter(name, 0.064, 0.04) for s in np.linspace(0, stroke.length_m)]
    )
    low, high = points.min(axis=0), points.max(axis=0)
    assert high[1] - low[1] == pytest.approx(0.064, abs=1e-5)
    assert high + low == pytest.approx(np.zeros(2), abs=1e-4)
    assert high[0] - low[0] == pytest.approx({"N": 0.04, "B": 0.026, "I": 0.0}[name], abs=1e-4)


def test_strokes_of_a_letter_join_and_those_of_n_go_up_down_up() -> None:
    for name in ("N", "B"):
        strokes = letter(name, 0.064, 0.04)
        for one, other in pairwise(strokes):
            assert one.at(one.length_m)[:2] == pytest.approx(other.at(0.0)[:2], abs=1e-9)
    up, down, up_again = letter("N", 0.064, 0.04)
    assert up.at(0.01).tangent_y == 1.0
    assert down.at(0.01).tangent_y < 0.0 < down.at(0.01).tangent_x
    assert up_again.at(0.01).tangent_y == 1.0


def test_the_bows_of_b_bulge_to_the_right() -> None:
    _, upper, lower = letter("B", 0.064, 0.04)
    for bow in (upper, lower):
        start, middle, end = (bow.at(share * bow.length_m) for share in (0.0, 0.5, 1.0))
        assert middle.x_m > start.x_m == pytest.approx(end.x_m)
        assert start.y_m > middle.y_m > end.y_m


@pytest.mark.parametrize(
    "stroke", [Arc((0.01, 0.02), 0.03, 0.01, 0.3, 2.5), Arc((0.0, 0.0), 0.02, 0.03, 2.0, -1.0), circle(0.03)[0]]
)
def test_an_arc_is_parametrised_by_its_length(stroke: Arc) -> None:
    s = np.linspace(0, stroke.length_m, 400)
    points = np.array([stroke.at(float(each)) for each in s])
    assert np.gradient(points[:, 0:2], s, axis=0)[1:-1] == pytest.approx(points[1:-1, 2:4], abs=2e-3)
    curvature = np.hypot(*points[1:-1, 4:6].T)
    assert (
        np.hypot(*(np.gradient(points[:, 2:4], s, axis=0)[1:-1] - points[1:-1, 4:6]).T).max() < 0.02 * curvature.max()
    )


def test_a_circle_goes_once_round() -> None:
    assert circle(0.03)[0].length_m == pytest.approx(2 * np.pi * 0.03, rel=1e-6)
    assert Line((0.0, 0.0), (0.0, 0.0)).at(0.0)[2:] == (0.0, 0.0, 0.0, 0.0)


def test_before_the_start_and_after_the_end_it_rests() -> None:
    trajectory = Trajectory(TrajectoryConfig(trajectory="I"))
    before, after = trajectory.at(-1.0), trajectory.at(trajectory.duration_s + 1.0)
    assert before.reference[2:] == after.reference[2:] == (0.0,) * 6
    assert before.reference[:2] == pytest.approx((0.0, -0.032))
    assert after.reference[:2] == pytest.approx((0.0, 0.032))
    assert (before.finished, after.finished, after.segment) == (False, True, "I")
    assert after.segment_time_s == pytest.approx(trajectory.duration_s)


def test_hold_alone_stays_where_it_is_told() -> None:
    trajectory = Trajectory(TrajectoryConfig(trajectory="hold", hold_s=2.0, hold_x_m=0.01, hold_y_m=-0.02))
    assert trajectory.duration_s == 2.0
    assert trajectory.at(1.0).reference[:4] == (0.01, -0.02, 0.0, 0.0)


def test_the_list_of_words() -> None:
    assert parse("hold, N,B , I") == ["hold", "N", "B", "I"]
    assert parse("N,") == ["N"]
    assert parse(",".join(SEGMENTS)) == list(SEGMENTS)


@pytest.mark.parametrize("text", ["", ",", "hold,,N", "X", "n", "hold N", "N,move"])
def test_what_is_no_word_is_refused(text: str) -> None:
    with pytest.raises(SettingsError, match="is not one of hold, N, B, I, circle"):
        Trajectory(TrajectoryConfig(trajectory=text))


@pytest.mark.parametrize(
    "config",
    [
        TrajectoryConfig(letter_height_m=0.1),
        TrajectoryConfig(trajectory="hold", hold_x_m=0.05),
        TrajectoryConfig(trajectory="circle", circle_radius_m=0.046),
    ],
)
def test_what_is_beyond_reach_is_refused(config: TrajectoryConfig) -> None:
    with pytest.raises(SettingsError, match=r"beyond reach_m = 0.045"):
        Trajectory(config)
