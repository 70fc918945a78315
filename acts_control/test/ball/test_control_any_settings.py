# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Any settings that are allowed, ends of their ranges included: control goes on, and the tilt keeps its limits."""

from __future__ import annotations

from math import hypot, isfinite
from typing import Any

import pytest
from hypothesis import HealthCheck, given, reject, settings
from hypothesis import strategies as st

from acts_control.ball import (
    Ball,
    BallEstimator,
    BallReport,
    ContactMeasurement,
    EstimatorConfig,
    Reference,
    ReferenceReport,
)
from acts_control.ball.controller import BallController, ControlInput, ControllerConfig
from acts_control.ball.nodes.ball_balancing import SETTINGS
from acts_control.robots.base import TiltGate
from acts_core.errors import SettingsError
from acts_core.settings import Changeable, default_of, describe

DT = 0.008
DT_NS = 8_000_000
START_NS = 1_700_000_000_000_000_000
EPSILON = 1e-9


@pytest.mark.parametrize("node", SETTINGS)
def test_numbers_that_may_change_in_motion_have_a_smallest_and_a_largest_value(node: str) -> None:
    for name, info in describe(SETTINGS[node]).items():
        if info.changeable is Changeable.RUNNING and isinstance(default_of(SETTINGS[node], name), (int, float)):
            is_bounded = info.minimum is not None and info.maximum is not None
            assert is_bounded or isinstance(default_of(SETTINGS[node], name), bool), name


def changed(settings_class: type) -> st.SearchStrategy[Any]:
    """Settings of which some are anywhere in their ranges, most often at an end."""
    values = {}
    for name, info in describe(settings_class).items():
        default = default_of(settings_class, name)
        if isinstance(default, bool) or not isinstance(default, (int, float)):
            continue
        assert info.minimum is not None
        assert info.maximum is not None
        ends = st.sampled_from([type(default)(info.minimum), type(default)(info.maximum)])
        if isinstance(default, int):
            values[name] = ends | st.integers(int(info.minimum), int(info.maximum))
        else:
            values[name] = ends | st.floats(info.minimum, info.maximum)
    return st.fixed_dictionaries({}, optional=values)


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(changed(EstimatorConfig), changed(ControllerConfig), st.lists(st.floats(-0.5, 0.5), min_size=8, max_size=8))
def test_with_any_settings_the_tilt_keeps_its_limits(
    of_estimator: dict[str, float], of_controller: dict[str, float], places_m: list[float]
) -> None:
    try:
        estimator = BallEstimator(EstimatorConfig(**of_estimator))
        config = ControllerConfig(**of_controller)
    except SettingsError:
        reject()
    controller, gate = BallController(config), TiltGate(config)
    now_ns, last = START_NS, (0.0, 0.0)
    for step in range(120):
        now_ns += DT_NS
        place_m = places_m[step // 15]
        for part in range(4):
            estimator.step(ContactMeasurement(now_ns - (3 - part) * DT_NS // 4, True, place_m, -place_m / 2, 8.0))
        state = estimator.state
        ball = BallReport(state.stamp_ns, state.valid, Ball(state.x_m, state.y_m, state.vx_m_s, state.vy_m_s))
        tilt = controller.step(ControlInput(now_ns, ball, ReferenceReport(now_ns, Reference(0.0, 0.0)), last), DT)
        estimator.set_tilt(now_ns, *tilt)
        assert all(map(isfinite, tilt))
        assert hypot(*tilt) <= config.max_tilt_rad + EPSILON
        assert gate.fault(tilt, DT) == ""
        gate.sent(tilt)
        last = tilt
