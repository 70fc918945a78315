# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The closed loop while clocks are set and messages are wrong or forged: the ball stays where it is led."""

import itertools
from collections.abc import Callable

import pytest
from rolling_plant import run

from acts_control.ball import ContactMeasurement, Phase, ReferenceReport, TrajectoryConfig

pytestmark = pytest.mark.slow

HOUR_S = 3600
HOUR_NS = HOUR_S * 1_000_000_000
# In the middle of a stroke of I, with speed and acceleration.
WHEN_S = 2.0
STROKE = TrajectoryConfig(trajectory="hold,I", hold_s=1.0)
# Undisturbed it is 3.3 mm.
WORST_MM = 8.0


def assert_led(**meddling: object) -> None:
    result = run(seconds=3.6, trajectory_config=STROKE, **meddling)  # type: ignore[arg-type]
    assert result.error_mm[result.time_s > WHEN_S - 0.1].max() < WORST_MM
    assert result.phases[-1] is Phase.BALANCING


@pytest.mark.parametrize("step_s", [-HOUR_S, -0.5, HOUR_S])
def test_the_clock_is_set_in_the_middle_of_a_stroke(step_s: float) -> None:
    assert_led(clock_off_s=lambda time_s: step_s if time_s > WHEN_S else 0.0)


@pytest.mark.parametrize("ahead_ns", [100_000_000, HOUR_NS])
def test_a_source_whose_clock_is_ahead_leads_the_ball_as_well_as_any(ahead_ns: int) -> None:
    # Messages take their time, and not each the same.
    late_ns = itertools.cycle([0, 12_000_000, 3_000_000])
    assert_led(refer=lambda _time_s, good: good._replace(stamp_ns=good.stamp_ns + ahead_ns - next(late_ns)))


@pytest.mark.parametrize(
    "forge",
    [
        lambda good: good._replace(stamp_ns=good.stamp_ns + HOUR_NS),
        lambda good: good._replace(stamp_ns=good.stamp_ns + HOUR_NS, reference=good.reference._replace(ay_m_s2=9.0)),
        lambda good: good._replace(reference=good.reference._replace(ax_m_s2=1e6)),
        lambda good: good._replace(reference=good.reference._replace(x_m=1000.0)),
    ],
    ids=["future", "future and hard", "acceleration", "position"],
)
def test_forged_references_in_the_middle_of_a_stroke(forge: Callable[[ReferenceReport], ReferenceReport]) -> None:
    assert_led(refer=lambda time_s, good: forge(good) if WHEN_S < time_s < WHEN_S + 0.02 else good)


@pytest.mark.parametrize(
    "forge",
    [
        lambda good: good._replace(stamp_ns=good.stamp_ns + 900_000_000),
        lambda good: good._replace(stamp_ns=good.stamp_ns + HOUR_NS),
        lambda good: good._replace(stamp_ns=good.stamp_ns - HOUR_NS),
        lambda good: good._replace(force_n=1e6),
        lambda good: good._replace(x_m=1000.0),
    ],
    ids=["near future", "future", "past", "force", "position"],
)
def test_every_twentieth_contact_is_forged(forge: Callable[[ContactMeasurement], ContactMeasurement]) -> None:
    assert_led(touch=lambda time_s, good: forge(good) if time_s > 1.5 and round(time_s * 1e3) % 20 == 0 else good)
