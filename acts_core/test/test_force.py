import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.errors import SettingsError
from acts_core.force import ForceResponse

GRAVITY = 9.81
ASSUMED_FOOT_TAXELS = 16


def test_follows_the_published_response() -> None:
    # Paper, Fig. S9: weight [g] and counts per taxel.
    grams = np.array([0, 10, 30, 50, 70, 100, 200, 300, 400, 500, 600, 700, 800])
    counts = np.array([0, 0, 63, 96, 138, 208, 278, 334, 443, 485, 535, 591, 647])
    force_n = grams / 1000 * GRAVITY / ASSUMED_FOOT_TAXELS
    assert np.abs(ForceResponse().counts(force_n) - counts).max() < 50


@given(st.floats(0.01, 5.0))
def test_inverse_returns_the_force(force_n: float) -> None:
    response = ForceResponse()
    assert response.force_n(response.counts(force_n)) == pytest.approx(force_n, rel=1e-6)


def test_nothing_below_the_dead_band_and_no_force_without_counts() -> None:
    response = ForceResponse(dead_n=0.01)
    assert response.counts(0.009) == 0
    assert response.force_n(0) == 0


def test_saturated_counts_give_a_finite_force() -> None:
    assert np.isfinite(ForceResponse().force_n(np.array([1023.0, 5000.0]))).all()


@pytest.mark.parametrize(
    "wrong", [{"full_scale_counts": 0.0}, {"full_scale_counts": 2000.0}, {"dead_n": -1.0}, {"half_n": 0.0}]
)
def test_impossible_response_is_refused_by_name(wrong: dict[str, float]) -> None:
    with pytest.raises(SettingsError, match=next(iter(wrong))):
        ForceResponse(**wrong)
