# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The file of skins: what it may hold, and words about what it may not."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from ament_index_python.packages import get_package_share_directory
from hypothesis import given
from hypothesis import strategies as st

from acts_core.errors import SettingsError
from acts_core.settings import default_of, describe, from_text
from acts_driver.settings import DriverSettings
from acts_recon.settings import ReconstructionSettings
from acts_skins.skins_file import SkinsFile, read_skins
from acts_skins.tactile_parameters import tactile_parameters

pytestmark = pytest.mark.slow

POSE = "pose: {parent: torso, position_m: [0.1, 0.2, 0.3], rpy_rad: [0, 0, 1.5]}"


def read(folder: Path, text: str) -> SkinsFile:
    path = folder / "skins.yaml"
    path.write_text(text)
    return read_skins(path)


def of_skin(*lines: str, pose: str = POSE) -> str:
    """A file whose skin stands in line 3, and the given lines from line 4 on."""
    return "\n".join(["base_frame: torso", "skins:", "  left:", *(f"    {line}" for line in (*lines, pose))])


def test_the_shipped_file_has_two_skins_that_stand_to_one_another() -> None:
    path = Path(get_package_share_directory("acts_config")) / "skins" / "two_skins.yaml"
    skins_file = read_skins(path)
    assert [skin.name for skin in skins_file.skins] == ["left_arm", "right_arm"]
    assert skins_file.base_frame == "torso"
    placed = skins_file.in_base()
    assert placed["left_arm"].position_m == pytest.approx((0.25, 0.2, 0.1))
    assert placed["right_arm"].rotation()[:, 2] == pytest.approx([0, -1, 0], abs=1e-6)
    for skin in skins_file.skins:
        assert tactile_parameters(skin, skin.port or "").driver.frame_id == skin.name


def test_the_plates_of_the_shipped_chest_lie_side_by_side() -> None:
    skins_file = read_skins(Path(get_package_share_directory("acts_config")) / "skins" / "chest.yaml")
    placed = skins_file.in_base()
    left, right = (placed[f"{side}_chest"] for side in ("left", "right"))
    # 140 mm and a gap of 10: seen from outside, x is to the left of the torso and y is up.
    assert np.subtract(left.position_m, right.position_m) == pytest.approx([0, 0.15, 0])
    assert left.rotation() == pytest.approx(np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]]), abs=1e-6)
    for skin in skins_file.skins:
        assert tactile_parameters(skin, skin.port or "").reconstruction.arranged().name == "chest"


def test_the_file_of_the_documents_is_one(tmp_path: Path) -> None:
    page = Path(__file__).resolve().parents[2] / "docs" / "skins.md"
    skins_file = read(tmp_path, page.read_text().partition("```yaml")[2].partition("```")[0])
    assert [skin.name for skin in skins_file.skins] == ["left_arm", "left_sole"]
    for skin in skins_file.skins:
        tactile_parameters(skin, skin.port or "")
    assert skins_file.in_base()["left_arm"].position_m == pytest.approx((0.25, 0.2, 0.14))


def test_everything_that_can_be_said_of_a_skin(tmp_path: Path) -> None:
    (tmp_path / "press.npy").touch()
    text = of_skin(
        "port: serial:123",
        "recording: press.npy",
        "recording_rate_hz: 60",
        "rows: 32",
        "cols: 32",
        "layout: glove",
        "pitch_m: 0.005",
        "scheme: uniform",
        "m: 64",
        "threshold_counts: 80",
        "driver: {search_share: 0.00001, protocol: binary, reconnect_s: 2}",
        "reconstruction: {touch_counts: 40, keep_measured: false}",
    )
    skins_file = read(tmp_path, text + "\nframes:\n  belt: {parent: torso, position_m: [0, 0, -0.2]}\n")
    (skin,) = skins_file.skins
    assert (skin.name, skin.port, skin.recording_rate_hz) == ("left", "serial:123", 60.0)
    assert skin.recording == tmp_path / "press.npy"
    assert list(skins_file.poses()) == ["belt", "left"]
    parameters = tactile_parameters(skin, "/dev/pts/1")
    assert (parameters.driver.scheme, parameters.driver.m, parameters.driver.frame_id) == ("uniform", 64, "left")
    assert parameters.reconstruction.layout == "glove"
    assert vars(parameters.reconstruction)["keep_measured"] is False
    # The words of the command line come to the same values.
    for node, name in ((word.split("=")[0].split(".")) for word in parameters.words[1::2]):
        if node == "driver":
            text = next(word.partition("=")[2] for word in parameters.words if word.startswith(f"driver.{name}="))
            assert from_text(DriverSettings, name, text) == getattr(parameters.driver, name)


def test_a_replay_is_found_beside_the_file(tmp_path: Path) -> None:
    (skin,) = read(tmp_path, of_skin("replay: touch.npz")).skins
    assert tactile_parameters(skin, "unused").driver.replay == str(tmp_path / "touch.npz")


def files_of(settings_class: type) -> list[str]:
    """Parameters that are paths of files by their description, except those with a key of their own."""
    return [
        name
        for name, info in describe(settings_class).items()
        if isinstance(default_of(settings_class, name), str)
        and name not in ("port", "replay", "layout")
        and re.search(r"file\b|\bpath\b|npz", info.description)
    ]


@pytest.mark.parametrize("given", ["sub/one.npz", "../one.npz", "/one.npz", "~/one.npz"])
def test_files_of_the_two_nodes_are_found_beside_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, given: str
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    found = {"driver": files_of(DriverSettings), "reconstruction": files_of(ReconstructionSettings)}
    assert {"calibration_file", "model"} <= set(found["driver"])
    assert {"force_response", "object_library", "dictionary"} <= set(found["reconstruction"])
    own = dict.fromkeys(found["driver"], given)
    further = dict.fromkeys(found["reconstruction"], given)
    (skin,) = read(tmp_path, of_skin(f"driver: {own}", f"reconstruction: {further | {'method': 'per_frame'}}")).skins
    parameters = tactile_parameters(skin, "auto")
    expected = tmp_path / given.replace("~", "home")
    for node, names in found.items():
        for name in names:
            assert getattr(getattr(parameters, node), name) == str(expected), name
            assert f"{node}.{name}={expected}" in parameters.words


@pytest.mark.parametrize("word", ["", "none"])
def test_no_file_stays_none(tmp_path: Path, word: str) -> None:
    (skin,) = read(tmp_path, of_skin(f"driver: {{calibration_file: '{word}', model: '{word}'}}")).skins
    driver = tactile_parameters(skin, "auto").driver
    assert (driver.calibration_file, driver.model) == (word, word)


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (["replay: ~nobody_at_all/x"], ["skins.yaml:4: skin left: replay = ~nobody_at_all/x: "]),
        (["driver:", "  model: ~nobody_at_all/x"], ["skins.yaml:5: skin left: driver: model = ~nobody_at_all/x: "]),
        (["prot: x"], ["skins.yaml:4: skin left:", "unknown key 'prot'", "did you mean 'port'?"]),
        (["port: 5"], ["skins.yaml:4: skin left:", "port = 5", "put it in quotes"]),
        (["port: auto", "replay: x"], ["skins.yaml:5:", "port and replay"]),
        (["replay: x", "recording: y"], ["skins.yaml:5:", "replay and recording"]),
        (["port: ''"], ["skins.yaml:4: skin left: port = '': allowed is text that is not empty; or leave port out"]),
        (["recording_rate_hz: 0"], ["skins.yaml:4:", "recording_rate_hz = 0"]),
        (["driver: {frame_id: x}"], ["skins.yaml:4: skin left: driver:", "frame_id is the skin's name"]),
        (["driver: {m: 3}"], ["m is given at the skin itself"]),
        (["driver: 3"], ["skins.yaml:4: skin left:", "driver = 3"]),
        (["port: a", "port: b"], ["skins.yaml:5: the key 'port' is given twice"]),
    ],
)
def test_a_wrong_key_of_a_skin_is_told_with_its_place(tmp_path: Path, lines: list[str], words: list[str]) -> None:
    with pytest.raises(SettingsError) as caught:
        read(tmp_path, of_skin(*lines))
    assert all(word in str(caught.value) for word in words), caught.value


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (["m: 0.5"], ["skins.yaml:4: skin left: m = 0.5"]),
        (["pitch_m: 4e-3"], ["skins.yaml:4: skin left: pitch_m = '4e-3'", "write 1.0e-3", "0 to 1"]),
        (["driver: {rate_cap_hz: 1.0e3}"], ["skins.yaml:4: skin left: driver: rate_cap_hz = '1.0e3'", "and 1.0e+3"]),
        (["scheme: adaptiv"], ["skins.yaml:4: skin left: scheme = 'adaptiv'", "adaptive"]),
        (["rows: 65"], ["skins.yaml:4: skin left: rows = 65", "1 to 64"]),
        (["rows: 7", "cols: 7"], ["skins.yaml:3: skin left: m = 55: an array of 7 x 7 has 49 taxels"]),
        (["rows: 7", "m: 250"], ["skins.yaml:5: skin left: m = 250: an array of 7 x 32 has 224 taxels"]),
        (["scheme: uniform", "m: 100"], ["skins.yaml:5: skin left: m = 100: no uniform grid"]),
        (["layout: insole", "rows: 16"], ["skins.yaml:4: skin left: layout insole"]),
        (["driver: {bauds: 9600}"], ["skins.yaml:4: skin left: driver:", "'bauds'; did you mean 'baud'?"]),
        (["driver:", "  baud: 1"], ["skins.yaml:5: skin left: driver: baud = 1"]),
        (["reconstruction: {methods: fusion}"], ["did you mean 'method'?"]),
        (["port: 'serial:'"], ["skins.yaml:3: skin left: port = 'serial:'"]),
    ],
)
def test_a_wrong_parameter_is_told_with_its_place(tmp_path: Path, lines: list[str], words: list[str]) -> None:
    (skin,) = read(tmp_path, of_skin(*lines)).skins
    with pytest.raises(SettingsError) as caught:
        tactile_parameters(skin, skin.port or "auto")
    assert all(word in str(caught.value) for word in words), caught.value


@pytest.mark.parametrize(
    ("pose", "words"),
    [
        ("pose: {position_m: [0, 0, 0]}", ["skins.yaml:4: skin left: pose:", "parent = None"]),
        ("pose: {parent: 'a b'}", ["parent = 'a b'"]),
        ("pose: {parent: /torso}", ["skins.yaml:4: skin left: pose:", "parent = '/torso'"]),
        ("pose: {parent: torso, position_m: [0, 0]}", ["position_m = [0, 0]: allowed are 3 finite numbers"]),
        ("pose: {parent: torso, position_m: [0, 0, .nan]}", ["position_m", "finite"]),
        ("pose: {parent: torso, position_m: [0, 0, 1e-3]}", ["write 1.0e-3"]),
        ("pose: {parent: torso, position_m: [0, 0, 1.0e3]}", ["1.0e+3"]),
        ("pose: {parent: torso, rpy_rad: [0, 0, 0], quaternion_xyzw: [0, 0, 0, 1]}", ["give one of them"]),
        ("pose: {parent: torso, quaternion_xyzw: [0, 0, 0, 2]}", ["its length is 2, needed is 1"]),
        ("pose: {parent: torso, rpi_rad: [0, 0, 0]}", ["did you mean 'rpy_rad'?"]),
        ("pose: {parent: torso, rpy_rad: [0, 90, 0]}", ["rpy_rad = [0.0, 90.0, 0.0]", "90 degrees are 1.5708"]),
        ("pose: torso", ["pose = 'torso'"]),
        ("pose: {parent: left}", ["circle"]),
        ("", ["skins.yaml:3: skin left: pose is missing"]),
    ],
)
def test_a_wrong_pose_is_told_with_its_place(tmp_path: Path, pose: str, words: list[str]) -> None:
    with pytest.raises(SettingsError) as caught:
        read(tmp_path, of_skin("m: 55", pose=pose).replace("    m: 55\n", "") if pose else of_skin("m: 55", pose=""))
    assert all(word in str(caught.value) for word in words), caught.value


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("skins: {}", "there has to be at least one"),
        ("- 1", "top level"),
        ("", "top level"),
        ("skins: {left: [", "not valid YAML"),
        ("skin: {}", "did you mean 'skins'?"),
        (f"skins: {{2left: {{{POSE}}}}}", "does not begin with a digit"),
        (f"skins: {{on: {{{POSE}}}}}", "skin True"),
        (f"skins: {{a: {{{POSE}}}, a: {{{POSE}}}}}", "the key 'a' is given twice"),
        (f"skins: {{a: {{{POSE}}}}}\nframes: {{a: {{parent: b}}}}", "same name"),
        (f"base_frame: '/x'\nskins: {{a: {{{POSE}}}}}", "base_frame = '/x'"),
        (f"skins: {{a: {{port: COM1, {POSE}}}, b: {{port: COM1, {POSE}}}}}", "skin a has this port already"),
        (f"skins: {{a: {{port: serial:1, {POSE}}}, b: {{port: 'serial: 1', {POSE}}}}}", "skin a has this port already"),
        (f"skins: {{a: {{port: auto, {POSE}}}, b: {{port: COM1, {POSE}}}}}", "works with a single board only"),
        ("x: &a [*a]", "unknown key 'x'"),
    ],
)
def test_a_wrong_file_is_refused(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(SettingsError, match=r"skins\.yaml") as caught:
        read(tmp_path, text)
    assert words in str(caught.value), caught.value


def test_two_names_of_one_device_are_one_port(tmp_path: Path) -> None:
    (tmp_path / "by_id").symlink_to(tmp_path / "tty")
    text = f"skins: {{a: {{port: {tmp_path}/tty, {POSE}}}, b: {{port: {tmp_path}/by_id, {POSE}}}}}"
    with pytest.raises(SettingsError, match="skin a has this port already"):
        read(tmp_path, text)


@pytest.mark.parametrize("second", ["left.npz", "../dev/left.npz", "link.npz"])
def test_one_calibration_file_for_two_skins_is_refused(tmp_path: Path, second: str) -> None:
    folder = tmp_path / "dev"
    folder.mkdir()
    (folder / "link.npz").symlink_to(folder / "left.npz")
    text = (
        f"skins:\n  a: {{{POSE}, driver: {{calibration_file: left.npz}}}}\n"
        f"  b: {{{POSE}, driver: {{calibration_file: {second}}}}}"
    )
    with pytest.raises(SettingsError, match=r"skins\.yaml:3: skin b: driver: calibration_file") as caught:
        read(folder, text)
    assert "skin a has this file already" in str(caught.value)
    # Skins without one have none in common.
    assert len(read(folder, text.replace("left.npz", "none").replace(second, "none")).skins) == 2


@pytest.mark.parametrize(
    ("given", "port"),
    [
        ("tty", "{folder}/tty"),
        ("../dev/tty", "{folder}/../dev/tty"),
        ("~/tty", "{folder}/home/tty"),
        ("/dev/ttyACM1", "/dev/ttyACM1"),
        ("auto", "auto"),
        ("serial:12", "serial:12"),
    ],
)
def test_a_port_is_found_beside_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, given: str, port: str
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    (skin,) = read(tmp_path, of_skin(f"port: {given}")).skins
    assert skin.port == port.format(folder=tmp_path)


@pytest.mark.parametrize("first", ["~/tty", "home/tty", "home/../home/tty", "link/tty"])
def test_one_port_is_known_whatever_its_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, first: str) -> None:
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    (tmp_path / "home").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "home")
    text = f"skins: {{a: {{port: {first}, {POSE}}}, b: {{port: {tmp_path}/home/tty, {POSE}}}}}"
    with pytest.raises(SettingsError, match="skin a has this port already"):
        read(tmp_path, text)


@pytest.mark.parametrize("port", ['"a\\0b"', "loop"])
def test_a_port_that_cannot_be_looked_for_is_refused_in_words(tmp_path: Path, port: str) -> None:
    (tmp_path / "loop").symlink_to("loop")
    with pytest.raises(SettingsError, match=r"skins.yaml:4: skin left: port = "):
        read(tmp_path, of_skin(f"port: {port}"))


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match=r"none\.yaml"):
        read_skins(tmp_path / "none.yaml")


def test_a_skin_on_a_link_that_moves_cannot_be_placed(tmp_path: Path) -> None:
    skins_file = read(tmp_path, of_skin(pose="pose: {parent: elbow}"))
    with pytest.raises(SettingsError, match=r"skins.yaml:4: skin left: the frame left is fixed to elbow"):
        skins_file.in_base()
    assert skins_file.in_base("elbow")["left"].position_m == (0.0, 0.0, 0.0)


SCALARS = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8) | st.dates()
KEYS = st.sampled_from(
    ["base_frame", "frames", "skins", "left", "port", "replay", "rows", "m", "pose", "parent", "position_m", "rpy_rad",
     "quaternion_xyzw", "driver", "reconstruction", "recording_rate_hz", "layout", "baud"]
)  # fmt: skip
TREES = st.recursive(
    SCALARS, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(KEYS | st.text(max_size=4), inner, max_size=5)
)


@given(st.dictionaries(KEYS, TREES, max_size=6), st.dictionaries(KEYS, TREES, max_size=6))
def test_whatever_is_in_the_file_it_is_read_or_refused_in_words(
    tmp_path_factory: pytest.TempPathFactory, skin: dict[str, Any], top: dict[str, Any]
) -> None:
    pose = {"parent": "torso", **skin.get("pose", {})} if isinstance(skin.get("pose", {}), dict) else skin["pose"]
    path = tmp_path_factory.getbasetemp() / "any.yaml"
    for content in (top, {"skins": {"left": skin}}, {"skins": {"left": {**skin, "pose": pose}}}):
        path.write_text(yaml.safe_dump(content))
        refusal = ""
        try:
            for read_skin in read_skins(path).skins:
                tactile_parameters(read_skin, "auto")
        except SettingsError as error:
            refusal = str(error)
        assert not refusal or str(path) in refusal


NAMES = st.from_regex(r"[a-z][a-z0-9_]{0,10}", fullmatch=True)


@given(st.dictionaries(NAMES, st.tuples(*[st.floats(-5, 5)] * 6), min_size=1, max_size=4))
def test_what_was_written_is_read(
    tmp_path_factory: pytest.TempPathFactory, poses: dict[str, tuple[float, ...]]
) -> None:
    path = tmp_path_factory.getbasetemp() / "written.yaml"
    skins = {
        name: {"pose": {"parent": "Base", "position_m": list(numbers[:3]), "rpy_rad": list(numbers[3:])}}
        for name, numbers in poses.items()
    }
    path.write_text(yaml.safe_dump({"base_frame": "Base", "skins": skins}))
    placed = read_skins(path).in_base()
    assert {name: transform.position_m for name, transform in placed.items()} == {
        name: pytest.approx(numbers[:3]) for name, numbers in poses.items()
    }


def test_a_layout_of_ones_own_is_found_beside_the_file(tmp_path: Path) -> None:
    (tmp_path / "hand.yaml").write_text("patches:\n  tip:\n    wires: {down: cols, across: row}\n")
    (skin,) = read(tmp_path, of_skin("layout: hand.yaml")).skins
    with pytest.raises(
        SettingsError, match=r"skins.yaml:4: skin left: .*hand.yaml:3: patch tip: wires: across = 'row'"
    ):
        tactile_parameters(skin, "auto")
    (tmp_path / "hand.yaml").write_text("patches:\n  tip:\n    wires: {down: cols, across: rows}\n")
    assert tactile_parameters(skin, "auto").reconstruction.arranged().taxels[1, 0] == 1
    (tmp_path / "hand.yaml").unlink()
    with pytest.raises(SettingsError, match=r"skins.yaml:4: skin left: .*hand.yaml: cannot be read"):
        tactile_parameters(skin, "auto")
    with pytest.raises(SettingsError, match=r"skins.yaml:4: skin left: .*allowed is one of square"):
        read(tmp_path, of_skin("layout: hnad"))
