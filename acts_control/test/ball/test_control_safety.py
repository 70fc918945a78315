# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What ends motion: the controller's ways from one phase to another, and the prediction on which it acts."""

import math

import pytest

from acts_control.ball import Ball, BallReport, Phase, Reference, ReferenceReport
from acts_control.ball.controller import BallController, ControlInput, ControllerConfig
from acts_control.ball.plate import acceleration_of
from acts_control.ball.prediction import TiltHistory
from acts_core.errors import SettingsError

NOW_NS = 1_700_000_000_000_000_000
MS = 1_000_000
DT = 0.004
NAN = float("nan")
LEVEL = (0.0, 0.0)


# --- prediction


def test_an_estimate_is_carried_on_with_the_tilts_the_plate_had() -> None:
    history = TiltHistory(0.0, 0.2)
    for k in range(101):
        history.add(NOW_NS + k * MS, 0.0, 0.05 if k >= 50 else 0.0)
    ax, _ = acceleration_of(0.0, 0.05)
    x, y, vx, vy = history.predict(Ball(0.01, 0.02, 0.1, -0.1), NOW_NS)
    assert (x, y) == pytest.approx((0.01 + 0.1 * 0.1 + ax * 0.05**2 / 2, 0.02 - 0.1 * 0.1))
    assert (vx, vy) == pytest.approx((0.1 + ax * 0.05, -0.1))
    # From between two tilts, from before the first, and from now.
    assert history.predict(Ball(0.0, 0.0, 0.1, 0.0), NOW_NS + 500_000).x_m == pytest.approx(
        0.1 * 0.0995 + ax * 0.05**2 / 2
    )
    assert history.predict(Ball(0.0, 0.0, 0.1, 0.0), NOW_NS - 20 * MS).x_m == pytest.approx(0.012 + ax * 0.05**2 / 2)
    assert history.predict(Ball(0.3, 0.0, 0.1, 0.0), NOW_NS + 100 * MS) == pytest.approx((0.3, 0.0, 0.1, 0.0))


def test_tilts_about_both_axes_move_the_ball_alike() -> None:
    about_x, about_y = TiltHistory(0.14, 0.2), TiltHistory(0.14, 0.2)
    for k, tilt in enumerate((0.0, 0.03, 0.05, 0.05)):
        about_x.add(NOW_NS + k * 50 * MS, tilt, 0.0)
        about_y.add(NOW_NS + k * 50 * MS, 0.0, tilt)
    x, y, vx, vy = about_y.predict(Ball(0.01, 0.0, 0.1, 0.0), NOW_NS)
    assert x > 0.01 + 0.1 * 0.15 - 0.1 * 0.05
    # Turned by a right angle: what was along x is along -y.
    assert about_x.predict(Ball(0.0, -0.01, 0.0, -0.1), NOW_NS) == pytest.approx((y, -x, vy, -vx))


def test_what_the_plate_turned_meanwhile_moves_the_ball_against_it() -> None:
    history = TiltHistory(0.14, 1.0)
    assert history.predict(Ball(0.3, 0.0, 0.0, 0.0), NOW_NS) == Ball(0.3, 0.0, 0.0, 0.0)
    history.add(NOW_NS, 0.02, 0.0)
    history.add(NOW_NS + 1, 0.0, 0.05)
    ball = history.predict(Ball(0.0, 0.0, 0.0, 0.0), NOW_NS)
    assert (ball.x_m, ball.y_m) == pytest.approx((-0.1 * 0.05, -0.1 * 0.02), abs=1e-9)


def test_a_clock_that_is_set_back_does_no_harm() -> None:
    history = TiltHistory(0.0, 0.2)
    history.add(NOW_NS, 0.0, 0.0)
    history.add(NOW_NS - 10**9, 0.0, 0.1)
    assert history.predict(Ball(0.0, 0.0, 1.0, 0.0), NOW_NS - 10**9) == Ball(0.0, 0.0, 1.0, 0.0)
    # The tilt from before the clock was set is forgotten, also for an estimate from before the first tilt after it.
    history.add(NOW_NS, 0.0, 0.2)
    history.add(NOW_NS - 5 * MS, 0.0, 0.0)
    history.add(NOW_NS + 95 * MS, 0.0, 0.0)
    assert history.predict(Ball(0.0, 0.0, 1.0, 0.0), NOW_NS - 55 * MS) == pytest.approx((0.15, 0.0, 1.0, 0.0))


# --- the controller


class Scene:
    """A controller with everything fresh; `step` lets time pass."""

    def __init__(self, config: ControllerConfig | None = None) -> None:
        self.controller = BallController(config or ControllerConfig(touch_stale_after_s=0.1, touch_stop_after_s=0.3))
        self.now_ns = NOW_NS
        self.ball = Ball(0.02, 0.0, 0.0, 0.0)
        self.valid = True
        self.touch_age_ms: float | None = 5.0
        self.reference = Reference(0.0, 0.0)
        self.reference_age_ms: float | None = 5.0
        self.largest_tilt = 0.0

    @property
    def phase(self) -> Phase:
        return self.controller.state.phase

    @property
    def reason(self) -> str:
        return self.controller.state.reason

    def step(self, seconds: float = DT) -> tuple[float, float]:
        tilt = LEVEL
        for _ in range(max(round(seconds / DT), 1)):
            self.now_ns += round(DT * 1e9)
            ball = reference = None
            if self.touch_age_ms is not None:
                ball = BallReport(self.now_ns - round(self.touch_age_ms * MS), self.valid, self.ball)
            if self.reference_age_ms is not None:
                reference = ReferenceReport(self.now_ns - round(self.reference_age_ms * MS), self.reference)
            tilt = self.controller.step(ControlInput(self.now_ns, ball, reference, LEVEL), DT)
            assert all(map(math.isfinite, tilt))
            self.largest_tilt = max(self.largest_tilt, math.hypot(*tilt))
        return tilt

    def go_silent(self, seconds: float, *, clock_runs: bool = True) -> None:
        """No new message for a while: the last one grows old. A clock that does not run is set back at every step."""
        for _ in range(round(seconds / DT)):
            assert self.touch_age_ms is not None
            if clock_runs:
                self.touch_age_ms += DT * 1e3
            else:
                self.now_ns -= round(DT * 1e9)
            self.step()


def balancing() -> Scene:
    scene = Scene()
    scene.step(0.3)
    assert scene.phase is Phase.BALANCING
    assert math.hypot(*scene.controller.state.tilt_rad) > 0.01
    assert scene.controller.state.error_m == pytest.approx((0.02, 0.0))
    return scene


def test_it_waits_level_for_touch_ball_and_reference() -> None:
    scene = Scene()
    scene.touch_age_ms = None
    scene.step(1.0)
    assert (scene.phase, scene.reason) == (Phase.WAITING, "waiting for touch")
    scene.touch_age_ms, scene.valid = 5.0, False
    scene.step(1.0)
    assert (scene.phase, scene.reason) == (Phase.WAITING, "waiting for a ball")
    scene.valid, scene.reference_age_ms = True, None
    scene.step(1.0)
    assert (scene.phase, scene.reason) == (Phase.WAITING, "waiting for a reference")
    assert scene.largest_tilt == 0.0
    scene.reference_age_ms = 5.0
    scene.step(0.2)
    assert (scene.phase, scene.reason) == (Phase.BALANCING, "balancing")


def test_touch_that_is_too_old_when_it_comes_is_told_as_that_and_not_as_missing() -> None:
    scene = Scene()
    scene.touch_age_ms = 500.0
    scene.step()
    assert scene.reason == "waiting for touch"  # a single one may have been held up
    scene.step(0.3)
    assert scene.reason.startswith("waiting for touch; what comes is older than touch_stale_after_s")
    # Nothing more comes: what came last may be as old as it likes.
    scene.go_silent(0.2)
    assert scene.reason == "waiting for touch"
    scene.touch_age_ms = -500.0
    scene.step(0.3)
    assert scene.reason == "waiting for touch; its stamps lie in the future, the clocks differ"
    scene.touch_age_ms, scene.valid = 5.0, False
    scene.step()
    assert scene.reason == "waiting for a ball"


def test_a_ball_felt_for_a_moment_only_does_not_close_the_loop() -> None:
    scene = Scene()
    for _ in range(20):
        scene.valid = True
        scene.step(0.08)
        scene.valid = False
        scene.step(0.08)
    assert scene.phase is Phase.WAITING


def test_touch_that_grows_stale_levels_the_plate_and_then_ends_motion() -> None:
    scene = balancing()
    scene.go_silent(0.09)
    assert scene.reason == "balancing"
    scene.go_silent(0.06)
    assert (scene.phase, scene.reason) == (Phase.BALANCING, "touch is stale: levelling the plate")
    scene.go_silent(0.8)
    assert scene.phase is Phase.STOPPED
    assert scene.reason.startswith("touch is stale: the newest is 0.4")
    assert scene.reason.endswith(" s old, and none was younger than 0.1 s")
    assert scene.controller.state.tilt_rad == pytest.approx(LEVEL, abs=1e-6)
    scene.touch_age_ms = 5.0
    scene.step(1.0)
    assert scene.phase is Phase.STOPPED


def test_touch_that_comes_back_in_time_is_gone_on_with() -> None:
    scene = balancing()
    scene.go_silent(0.15)
    scene.touch_age_ms = 5.0
    scene.step(0.1)
    assert (scene.phase, scene.reason) == (Phase.BALANCING, "balancing")


def test_touch_that_stays_too_old_ends_motion_although_it_keeps_coming() -> None:
    scene = balancing()
    scene.touch_age_ms = 150.0
    scene.step(0.8)
    assert scene.phase is Phase.STOPPED
    assert scene.reason == "touch is stale: the newest is 0.15 s old, and none was younger than 0.1 s"


def test_a_stamp_from_the_future_is_stale_touch() -> None:
    scene = balancing()
    scene.touch_age_ms = -1000.0
    scene.step(0.8)
    assert scene.phase is Phase.STOPPED
    assert scene.reason == "touch is stale: its stamps lie in the future, the clocks differ"


def test_a_lost_ball_levels_the_plate_and_is_waited_for() -> None:
    scene = balancing()
    scene.valid = False
    scene.step(0.2)
    assert (scene.phase, scene.reason) == (Phase.BALANCING, "no contact: levelling the plate")
    assert scene.controller.state.tilt_rad == pytest.approx(LEVEL, abs=1e-6)
    scene.step(0.2)
    assert (scene.phase, scene.reason) == (Phase.WAITING, "waiting for a ball")
    scene.valid = True
    scene.step(0.2)
    assert scene.phase is Phase.BALANCING


def test_a_lost_ball_that_is_back_at_once_is_felt_for_as_long_as_a_new_one() -> None:
    scene = balancing()
    scene.valid = False
    while scene.phase is Phase.BALANCING:
        scene.step()
    assert scene.reason == "ball lost: waiting for a ball"
    scene.valid = True
    phases = []
    for seconds in (0.08, 0.2):
        scene.step(seconds)
        phases.append(scene.phase)
    assert phases == [Phase.WAITING, Phase.BALANCING]


def test_after_a_lost_ball_the_next_one_is_balanced_like_the_first() -> None:
    scenes = balancing(), Scene()
    scenes[0].ball = Ball(0.004, 0.003, 0.0, 0.0)
    scenes[0].step(5.0)
    scenes[0].valid = False
    while scenes[0].phase is Phase.BALANCING:
        scenes[0].step()
    tilts = []
    for scene in scenes:
        scene.ball, scene.valid = Ball(-0.004, 0.003, 0.0, 0.0), True
        tilts.append([scene.step() for _ in range(100)])
        assert scene.phase is Phase.BALANCING
    assert tilts[0] == tilts[1]


@pytest.mark.parametrize(
    "bad", [Ball(NAN, 0.0, 0.0, 0.0), Ball(0.0, 0.0, 0.0, math.inf), Ball(2.0, 0.0, 0.0, 0.0), Ball(0.0, 0.0, 0.0, 9.0)]
)
def test_an_estimate_beyond_reason_is_no_ball(bad: Ball) -> None:
    scene = balancing()
    scene.ball = bad
    scene.step(0.6)
    assert scene.phase is Phase.WAITING
    assert scene.controller.state.tilt_rad == pytest.approx(LEVEL, abs=1e-6)


@pytest.mark.parametrize(
    ("bad", "words"),
    [
        (Reference(NAN, 0.0), "not finite"),
        (Reference(0.0, 0.0, 0.0, math.inf), "not finite"),
        (Reference(1000.0, 0.0), "farther from the centre than reference_reach_m"),
        (Reference(0.0, 0.0, 0.0, 30.0), "faster than 2 m/s"),
        (Reference(0.0, 0.0, 0.0, 0.0, 1e6, 0.0), "accelerated by more than 9.81 m/s^2"),
    ],
)
def test_a_reference_that_cannot_be_meant_is_refused_and_the_ball_held_at_the_last(bad: Reference, words: str) -> None:
    scene = balancing()
    scene.reference = bad
    scene.step(0.6)
    assert (scene.phase, scene.reason) == (Phase.BALANCING, f"balancing; the reference is refused: {words}")
    assert scene.controller.state.error_m == pytest.approx((0.02, 0.0))
    scene.reference = Reference(0.01, 0.0)
    scene.step()
    assert scene.reason == "balancing"
    assert scene.controller.state.error_m == pytest.approx((0.01, 0.0))


def test_without_a_good_reference_there_is_none() -> None:
    scene = Scene()
    scene.reference = Reference(NAN, 0.0)
    scene.step(1.0)
    assert scene.phase is Phase.WAITING
    assert scene.reason == "waiting for a reference; the reference is refused: not finite"


@pytest.mark.parametrize(
    ("age_ms", "why"), [(300.0, "is stale"), (-3.6e6, "is stamped in the future, the clocks differ")]
)
def test_of_a_reference_of_another_time_only_the_place_counts(age_ms: float, why: str) -> None:
    scene = balancing()
    scene.reference = Reference(0.0, 0.0, 0.1, 0.1, 0.5, 0.5)
    scene.reference_age_ms = age_ms
    scene.step()
    assert scene.controller.state.error_m == pytest.approx((0.02, 0.0))
    assert scene.reason == f"balancing; the reference {why}: its motion is left out"


def test_an_estimate_that_stays_the_same_grows_stale_although_the_clock_is_set_back_again_and_again() -> None:
    scene = balancing()
    scene.go_silent(0.15, clock_runs=False)
    assert (scene.phase, scene.reason) == (Phase.BALANCING, "touch is stale: levelling the plate")


def test_without_new_references_the_ball_is_held_at_the_last() -> None:
    scene = balancing()
    scene.reference = Reference(0.0, 0.0, 0.5, 0.5, 5.0, 5.0)
    scene.reference_age_ms = 300.0
    scene.step()
    assert scene.controller.state.error_m == pytest.approx((0.02, 0.0))
    assert scene.phase is Phase.BALANCING


def test_a_request_ends_motion_level_and_the_first_reason_stays() -> None:
    scene = balancing()
    scene.controller.end("stopped by request")
    scene.controller.end("something else")
    scene.step(0.004)
    assert scene.phase is Phase.BALANCING
    scene.step(1.0)
    assert (scene.phase, scene.reason) == (Phase.STOPPED, "stopped by request")
    assert scene.controller.state.tilt_rad == pytest.approx(LEVEL, abs=1e-6)


def test_the_tilt_stays_within_its_limit_whatever_the_error() -> None:
    scene = Scene()
    scene.ball = Ball(0.5, -0.5, 3.0, -3.0)
    scene.step(2.0)
    assert scene.largest_tilt == pytest.approx(ControllerConfig().max_tilt_rad, rel=1e-6)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"kd": NAN}, "kd = nan"),
        ({"max_tilt_rad": 0.4}, "max_tilt_rad = 0.4: allowed is 0.001 to 0.35"),
    ],
)
def test_settings_out_of_range_are_refused(settings: dict[str, float], words: str) -> None:
    with pytest.raises(SettingsError, match=words):
        ControllerConfig(**settings)
