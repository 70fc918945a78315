# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is wanted of a board, before it is asked: models that it can hold, and quotas that fit the frame."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.errors import BoardError
from acts_core.wire import (
    BoardSettings,
)
from acts_driver.board import BoardParameters
from acts_driver.board.model_file import load_model


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ({"atoms": np.ones((63, 5))}, "a patch is square"),
        ({"columns": np.ones((1024, 2)), "classes": [0, 2]}, "none left out"),
        ({"atoms": np.ones((64, 5000))}, "use fewer columns"),
        ({"other": [1]}, "needed is a dictionary"),
    ],
)
def test_models_that_no_board_can_hold(content: dict[str, Any], words: str, tmp_path: Path) -> None:
    np.savez(tmp_path / "m.npz", **content)
    with pytest.raises(BoardError, match=words) as caught:
        load_model(tmp_path / "m.npz")
    assert "m.npz" in str(caught.value)


def test_a_model_in_the_home_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    np.savez(tmp_path / "m.npz", atoms=np.eye(64))
    assert load_model(Path("~/m.npz")) == load_model(tmp_path / "m.npz")
    with pytest.raises(BoardError, match="~nobody-of-this-name"):
        load_model(Path("~nobody-of-this-name/m.npz"))


@pytest.mark.parametrize(
    ("rate_cap_hz", "period_us"),
    [(300.0, 3334), (7e5, 2), (500.0, 2000), (1e6 / 333, 333), (1.0, 1_000_000), (1e6, 1)],
)
def test_the_rate_is_never_above_its_cap(rate_cap_hz: float, period_us: int) -> None:
    wanted = BoardParameters(rate_cap_hz=rate_cap_hz).wanted(BoardSettings())
    assert wanted.frame_period_us == period_us


def test_a_share_of_a_frame_is_exact() -> None:
    wanted = BoardParameters(scheme="tracking", m=100, search_share=0.55, adaptive_share=0.07).wanted(BoardSettings())
    assert (wanted.search_quota, wanted.adaptive_quota) == (55, 7)


@given(st.integers(1, 1024), st.integers(1, 1024), st.sampled_from(["tracking", "hybrid", "adaptive"]), st.data())
def test_quotas_always_fit_the_frame(own_m: int, m: int, scheme: str, data: st.DataObject) -> None:
    own = BoardSettings(
        m=own_m, search_quota=data.draw(st.integers(0, 1024)), adaptive_quota=data.draw(st.integers(0, 1024))
    )
    # Whatever is asked, BoardSettings itself refuses what a board would.
    wanted = BoardParameters(scheme=scheme, m=m).wanted(own)
    assert (wanted.scheme, wanted.m) == (scheme, m)
    assert BoardParameters().wanted(own) == own
