# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Hands as YAML files, and where their links are."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_control.hand.description import LEAP_RIGHT, HandKinematics, hand_description
from acts_control.hand.nodes.hand_node import HandSettings
from acts_control.hand.nodes.reflexes_node import HandReflexesSettings
from acts_core.errors import SettingsError
from acts_core.skin import layout

LEAP = HandKinematics(LEAP_RIGHT)

EXAMPLE, SKIN = re.findall(
    r"```yaml\n(.*?)```", (Path(__file__).parents[3] / "docs" / "hand.md").read_text(), re.DOTALL
)
GRIPPER = re.sub(r" +#.*", "", EXAMPLE)
"""The example of docs/hand.md, without its comments; `SKIN` is the layout of its skin."""


def test_the_leap_hand_has_the_joints_fingers_and_regions_of_the_contract() -> None:
    assert [joint.motor_id for joint in LEAP_RIGHT.joints] == list(range(16))
    assert LEAP_RIGHT.names[:4] == ["index_mcp_side", "index_mcp_forward", "index_pip", "index_dip"]
    assert LEAP_RIGHT.joints[0].gain_scale == 0.75
    assert LEAP_RIGHT.joints[5].motor_zero_rad == pytest.approx(math.pi)
    assert list(LEAP_RIGHT.fingers) == ["index", "middle", "ring", "thumb"]
    assert len(LEAP_RIGHT.regions) == 13
    assert LEAP_RIGHT.regions["palm"].finger == ""


@pytest.mark.parametrize(
    ("link", "anchor_m", "axis"),
    [
        # As worked out from the published model by MuJoCo.
        ("index_base", (-0.0070, 0.0230, -0.0187), (0, 1, 0)),
        ("index_proximal", (0.0311, 0.0085, -0.0065), (0, 0, -1)),
        ("index_medial", (0.0461, 0.0228, -0.0195), (0, 1, 0)),
        ("index_distal", (0.0822, 0.0226, -0.0195), (0, 1, 0)),
        ("middle_distal", (0.0821, -0.0228, -0.0195), (0, 1, 0)),
        ("ring_distal", (0.0821, -0.0682, -0.0195), (0, 1, 0)),
        ("thumb_base", (-0.0693, -0.0012, -0.0216), (-1, 0, 0)),
        ("thumb_proximal", (-0.0823, 0.0131, -0.0216), (0, 1, 0)),
        ("thumb_medial", (-0.0823, 0.0301, -0.0071), (0, 0, -1)),
        ("thumb_distal", (-0.0823, 0.0767, -0.0069), (0, 0, -1)),
    ],
)
def test_the_flat_leap_hand_has_its_joints_where_they_are(
    link: str, anchor_m: tuple[float, ...], axis: tuple[float, ...]
) -> None:
    pose = LEAP.at(np.zeros(16))
    assert pose.point(link, (0, 0, 0)) == pytest.approx(anchor_m, abs=1.5e-4)
    assert pose.direction(link, (0, 0, -1)) == pytest.approx(axis, abs=1e-4)


@pytest.mark.parametrize(
    ("finger", "tip_m"),
    [
        ("index", (0.1302, 0.0076, -0.0195)),
        ("middle", (0.1301, -0.0378, -0.0195)),
        ("ring", (0.1301, -0.0832, -0.0195)),
        ("thumb", (-0.0823, 0.1367, -0.0219)),
    ],
)
def test_the_tips_of_the_flat_leap_hand(finger: str, tip_m: tuple[float, ...]) -> None:
    assert LEAP.at(np.zeros(16)).tip(finger) == pytest.approx(tip_m, abs=1.5e-4)


def test_closing_angles_bring_the_tips_of_the_fingers_to_the_palm() -> None:
    closing = np.array([0.0 if name.endswith("side") else 0.3 for name in LEAP_RIGHT.names])
    before, after = LEAP.at(np.zeros(16)), LEAP.at(closing)
    for finger in ("index", "middle", "ring"):
        assert after.tip(finger)[2] < before.tip(finger)[2] - 0.02


@settings(max_examples=40, deadline=None)
@given(
    q=st.lists(st.floats(-0.3, 1.8), min_size=16, max_size=16),
    link=st.sampled_from([link.name for link in LEAP_RIGHT.links]),
    point=st.tuples(*[st.floats(-0.05, 0.05)] * 3),
)
def test_the_jacobian_is_the_slope_of_the_kinematics(q: list[float], link: str, point: tuple[float, ...]) -> None:
    q_rad = np.array(q)
    pose = LEAP.at(q_rad)
    jacobian = pose.jacobian(link, pose.point(link, point))
    step = 1e-6
    for joint in range(16):
        moved = q_rad.copy()
        moved[joint] += step
        slope = (LEAP.at(moved).point(link, point) - pose.point(link, point)) / step
        assert jacobian[:, joint] == pytest.approx(slope, abs=1e-6)


def test_another_hand_is_another_file(tmp_path: Path) -> None:
    path = tmp_path / "gripper.yaml"
    path.write_text(GRIPPER)
    gripper = hand_description(str(path))
    assert gripper.names == ["left", "right"]
    assert gripper.joints[0].to_motor_rad(0.5) == pytest.approx(1.5)
    pose = HandKinematics(gripper).at(np.array([0.3, 0.3]))
    assert pose.tip("left")[0] == pytest.approx(0.02 - 0.05 * math.sin(0.3))
    assert pose.tip("right")[0] == pytest.approx(-0.02 + 0.05 * math.sin(0.3))


def test_the_skin_of_the_other_hand_has_its_regions_on_its_links(tmp_path: Path) -> None:
    for name, text in (("gripper.yaml", GRIPPER), ("gripper_skin.yaml", SKIN)):
        (tmp_path / name).write_text(text)
    regions = hand_description(str(tmp_path / "gripper.yaml")).regions
    skin = layout(str(tmp_path / "gripper_skin.yaml"), 16, 8)
    assert {patch.name: patch.link for patch in skin.patches} == {name: one.link for name, one in regions.items()}
    left = skin.patches[1]
    # Along the jaw towards its tip, and out of the skin towards the other jaw.
    assert left.points_m()[0, 0] - left.points_m()[-1, 0] == pytest.approx([0, 0, 0.028], abs=1e-6)
    assert left.normals()[0, 0] == pytest.approx([-1, 0, 0], abs=1e-6)


def test_the_file_of_a_hand_may_be_named_from_the_home_folder_on_as_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In a params file, and behind `hand:=`, no shell replaces the ~."""
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "gripper.yaml").write_text(GRIPPER)
    assert hand_description("~/gripper.yaml").name == "gripper"


def test_a_file_that_was_changed_is_read_anew(tmp_path: Path) -> None:
    path = tmp_path / "gripper.yaml"
    path.write_text(GRIPPER)
    assert hand_description(str(path)).name == "gripper"
    path.write_text(GRIPPER.replace("name: gripper", "name: pliers"))
    assert hand_description(str(path)).name == "pliers"


@pytest.mark.parametrize(
    ("wrong", "right", "told"),
    [
        ("limits_rad: [0, 1.2], zero_rad: 2.0}", "limits_rad: [1.2, 0]}", "5: joint right: limits 1.2"),
        ("[0, 1.2], zero_rad: 2.0}", "[0, 70]}", "5: joint right: limits_rad: 70 rad is more than two turns"),
        ("zero_rad: 2.0}", "zero_rad: 180}", "5: joint right: zero_rad: 180 rad is more than .* not in degrees"),
        ("motor: 2", "motor: 300", "5: joint right: direction 1, motor_id 300"),
        ("[-0.02, 0, 0]", "[-20, 0, 0]", "8: link right_jaw: position_m = .*: allowed is -1 to 1, in metres"),
        ("[0, 0, 0.05]", "[0, 0, 50]", "11: finger right: tip_m = .* not in millimetres"),
        ("[0, 0, 0.01]", "[0, 0, 10]", "13: region body: centre_m = .* not in millimetres"),
        ("  right_jaw: {parent", "  body: {parent", "8: link body: the base has this name"),
        ("motor: 2", "motor: 1", "3: hand gripper: joints"),
        ("motor: 2", "motor: two", "5: joint right: motor = 'two': needed is a whole number"),
        ("motor: 2, ", "", "5: joint right: motor = None"),
        ("zero_rad: 2.0}", "zero_red: 2.0}", "did you mean 'zero_rad'"),
        (
            "parent: body, joint: right",
            "parent: bdy, joint: right",
            "8: link right_jaw: parent = 'bdy'.*body, left_jaw: .*before this",
        ),
        ("joint: right,", "joint: rigt,", "8: link right_jaw: joint = 'rigt': allowed is one of left, right"),
        ("axis: [0, 1, 0]", "axis: [0, 2, 0]", "8: link right_jaw: axis = .*its length is 2"),
        ("axis: [0, 1, 0]", "axis: [0, .nan, 0]", "8: link right_jaw: axis = .*3 finite numbers"),
        ("{right: 1.0}", "{rigt: 1.0}", "11: finger right: 'rigt' is no joint"),
        ("{right: 1.0}", "{}", "11: finger right: closes: at least one joint"),
        ("{right: 1.0}", "{right: 0}", "11: finger right: right = 0: how much a joint takes part .* is above 0"),
        ("{right: 1.0}", "{right: -0.5}", "11: finger right: right = -0.5: how much .* above 0"),
        ("{right: 1.0}", "{right: .inf}", "11: finger right: right = inf: needed is a finite number"),
        (
            "{right: 1.0}",
            "{right: 1.0, left: 0.5}",
            "11: finger right: left does not move right_jaw, .* moved by right",
        ),
        ("tip_link: right_jaw", "tip_link: body", "11: finger right: right does not move body, .* moved by no joint"),
        (
            "  right: {motor: 2",
            "  spare: {motor: 9, limits_rad: [0, 1]}\n  right: {motor: 2",
            "5: joint spare: it turns no",
        ),
        ("finger: right", "finger: thumb", "15: region right_pad: finger = 'thumb'"),
        ("finger: right, role: distal", "finger: right, role: tip", "15: region right_pad: role = 'tip'"),
        (", normal: [0, 0, 1]", "", "13: region body: normal is missing"),
        ("right: 0.1", "right: 3", "18: posture pregrasp: right = 3: allowed is 0 to 1.2"),
        ("  open: {}\n", "", "posture open is missing"),
        ("name: gripper\n", "", "name is missing"),
    ],
)
def test_what_cannot_be_is_refused_with_its_line(tmp_path: Path, wrong: str, right: str, told: str) -> None:
    path = tmp_path / "gripper.yaml"
    assert wrong in GRIPPER
    # The last place: most lines of the left jaw are like those of the right one.
    before, _, after = GRIPPER.rpartition(wrong)
    path.write_text(before + right + after)
    with pytest.raises(SettingsError, match=told) as refused:
        hand_description(str(path))
    assert str(refused.value).count(str(path)) == 1


def test_a_hand_without_joints_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "gripper.yaml"
    begin, end = GRIPPER.index("joints:"), GRIPPER.index("links:")
    path.write_text(GRIPPER[:begin] + GRIPPER[end:])
    with pytest.raises(SettingsError, match="joints: at least one is needed"):
        hand_description(str(path))


def test_a_hand_that_is_not_shipped_is_refused_with_those_that_are() -> None:
    with pytest.raises(SettingsError, match=r"allowed is one of leap_right, or the path of a \.yaml file"):
        hand_description("leap_wrong")
    with pytest.raises(SettingsError, match=r"cannot be read .*too long"):
        hand_description("leap" * 100)


@pytest.mark.parametrize("settings", [HandSettings, HandReflexesSettings])
def test_the_frame_is_the_base_of_the_hand_unless_it_is_given(settings: type, tmp_path: Path) -> None:
    path = tmp_path / "gripper.yaml"
    path.write_text(GRIPPER)
    assert settings().frame_of(LEAP_RIGHT) == "palm_lower"
    assert settings().frame_of(hand_description(str(path))) == "body"
    assert settings(frame_id="arm/palm").frame_of(LEAP_RIGHT) == "arm/palm"


@pytest.mark.parametrize("settings", [HandSettings, HandReflexesSettings])
@pytest.mark.parametrize("frame_id", ["", "/palm", "the palm"])
def test_a_frame_that_tf2_does_not_take_is_refused(settings: type, frame_id: str) -> None:
    assert settings(frame_id="arm/palm").frame_id == "arm/palm"
    with pytest.raises(SettingsError, match=f"frame_id='{frame_id}': .* has no blanks and does not begin with /"):
        settings(frame_id=frame_id)
