# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The example of docs/reflexes.md: a reflex of one's own, in one file and one line."""

from __future__ import annotations

import re
from dataclasses import make_dataclass
from pathlib import Path
from typing import Any

import pytest
from hand_rig import RigidHand, region, sensed

from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes import Reflex, registry
from acts_core.errors import SettingsError
from acts_core.settings import describe, setting

PAGE = Path(__file__).resolve().parents[3] / "docs" / "reflexes.md"


@pytest.fixture
def own() -> type[Reflex]:
    (code,) = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
    names: dict[str, object] = {"__name__": __name__}
    exec(compile(code, str(PAGE), "exec"), names)
    kind = names["TapToOpen"]
    assert isinstance(kind, type)
    assert issubclass(kind, Reflex)
    return kind


def test_the_reflex_of_the_documentation_opens_a_hand_that_is_tapped(own: type[Reflex]) -> None:
    reflex = own(own.Config())
    assert reflex.step(sensed(region("palm", 2.0), time_s=1.0)) is None
    hand = RigidHand(("tap", reflex), grip_settle_s=0.02)
    hand.step([])
    hand.supervisor.grasp()
    gripped = [region(f"{finger}_distal", 0.8) for finger in LEAP_RIGHT.fingers]
    hand.step(gripped, steps=20)
    held = hand.goal.copy()
    hand.step([*gripped, region("palm", 8.0)], steps=20)
    assert hand.supervisor.status.events == {"tap": 1}
    assert (hand.goal < held - 0.05).sum() >= 9


def test_one_line_makes_it_known_and_its_settings_parameters(
    own: type[Reflex], monkeypatch: pytest.MonkeyPatch
) -> None:
    from acts_control.hand.nodes import reflexes_node

    monkeypatch.setitem(registry.REFLEXES, "tap", own)
    settings = reflexes_node.settings_class()
    assert "tap_force_n" in describe(settings)
    assert list(registry.make_reflexes("sharp tap", settings())) == ["sharp", "tap"]


def test_what_its_settings_check_is_checked_for_the_node_as_well() -> None:
    from acts_control.hand.nodes.reflexes_node import HandReflexesSettings

    given: Any = HandReflexesSettings(sphere_min_spread_m=0.01)
    with pytest.raises(SettingsError, match=r"sphere_min_spread_m = 0\.01: allowed is sphere_max_spread_m = 0\.007"):
        registry.make_reflexes("slip sphere", given)
    # Of a reflex that does not act they do not matter.
    assert list(registry.make_reflexes("slip", given)) == ["slip"]


def test_a_parameter_that_something_else_has_is_refused(own: type[Reflex], monkeypatch: pytest.MonkeyPatch) -> None:
    from acts_control.hand.nodes import reflexes_node

    class Other(own):  # type: ignore[misc, valid-type]
        Config = make_dataclass("OtherConfig", [("max_force_n", float, setting(1.0, "force [N]"))], frozen=True)

    monkeypatch.setitem(registry.REFLEXES, "other", Other)
    with pytest.raises(SettingsError, match="'max_force_n' is declared 2 times: begin it with the name of its thing"):
        reflexes_node.settings_class()
