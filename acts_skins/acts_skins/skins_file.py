# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Read the file that describes the skins of a robot: the sources of their samples, and their poses. No ROS.

`docs/skins.md` describes each key. The parameters of driver and reconstruction are only collected here;
`acts_skins.tactile_parameters` checks them when processes are planned.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from acts_core.errors import ActsError, SettingsError
from acts_core.files import Section, is_there, path_of, read_yaml, require_regular
from acts_core.names import RULE, is_frame_name, is_short_name
from acts_core.settings import is_given
from acts_core.skin import LAYOUTS, layout_path
from acts_core.transforms import Transform
from acts_driver.port import AUTO, SERIAL_PREFIX
from acts_skins.frame_tree import FrameTree, Pose

_FRAME_RULE = f"the name of a frame {RULE}"

_NODES_OF: dict[str, tuple[str, ...]] = {
    "rows": ("driver", "reconstruction"),
    "cols": ("driver", "reconstruction"),
    "scheme": ("driver",),
    "m": ("driver",),
    "threshold_counts": ("driver",),
    "layout": ("driver", "reconstruction"),
    "pitch_m": ("reconstruction",),
    "row_pitch_m": ("reconstruction",),
}
"""Parameters with a key of their own, and the nodes that get them."""

_PATHS_OF: dict[str, tuple[str, ...]] = {
    "driver": ("calibration_file", "model"),
    "reconstruction": ("dictionary", "force_response", "object_library"),
}
"""Further parameters of the two nodes that are paths of files."""

# Written by the driver's service ~/calibrate where it is missing.
_MADE_LATER = ("calibration_file",)

# As in the params file of tactile.launch.xml; the defaults of a board are for the paper's scheme.
_DEFAULTS: dict[str, Any] = {"scheme": "tracking", "m": 55, "threshold_counts": 60}

_FILE_KEYS = ("base_frame", "frames", "skins")
_SOURCE_KEYS = ("port", "replay", "recording", "recording_rate_hz")
_SKIN_KEYS = (*_SOURCE_KEYS, *_NODES_OF, "pose", "driver", "reconstruction")
_POSE_KEYS = ("parent", "position_m", "rpy_rad", "quaternion_xyzw")


@dataclass(frozen=True)
class Skin:
    """One skin.

    Attributes
    ----------
    name : str
        Its namespace and its frame.
    pose : Pose
        Pose of its frame.
    port : str or None
        Port of its board, as in the driver's parameter.
    replay : Path or None
        Recording that the driver replays in place of a board.
    recording : Path or None
        Recording that a simulated board plays, or None.
    recording_rate_hz : float
        Frames per second of `recording` [Hz].
    driver, reconstruction : mapping
        Parameters that the file gives to the two nodes, not yet checked.
    section : Section
        Section of the file, for messages.
    """

    name: str
    pose: Pose
    port: str | None
    replay: Path | None
    recording: Path | None
    recording_rate_hz: float
    driver: Mapping[str, Any]
    reconstruction: Mapping[str, Any]
    section: Section = field(repr=False, compare=False)

    def check_files(self) -> None:
        """Check that the files are there that its nodes are to read.

        Raises
        ------
        SettingsError
            One is missing, or is no file, with file, line, skin and key.
        """
        if self.replay is not None:
            self._check_file(self.section, "replay", self.replay, may_be_folder=True)
        for node, given in (("driver", self.driver), ("reconstruction", self.reconstruction)):
            for key in _PATHS_OF[node]:
                if key not in _MADE_LATER and isinstance(text := given.get(key), str) and is_given(text):
                    further = self.section.section(node, f"{self.section.what}: {node}")
                    self._check_file(further, key, Path(text), may_be_folder=False)

    @staticmethod
    def _check_file(section: Section, key: str, path: Path, *, may_be_folder: bool) -> None:
        try:
            if not may_be_folder:
                require_regular(path, error=SettingsError)
            elif not is_there(path, error=SettingsError):
                raise SettingsError(f"{path}: there is nothing of this name")
        except SettingsError as error:
            raise section.error(f"{key} = {error}", key) from None


@dataclass(frozen=True)
class SkinsFile:
    """The skins of a robot.

    Attributes
    ----------
    path : Path
        The file.
    base_frame : str
        Frame of the merged contacts.
    skins : tuple of Skin
        In the file's order; at least one.
    frames : mapping of str to Pose
        Further fixed frames that the file names.
    """

    path: Path
    base_frame: str
    skins: tuple[Skin, ...]
    frames: Mapping[str, Pose]

    def poses(self) -> dict[str, Pose]:
        """Pose of every frame of the file: its further frames, then the skins."""
        return {**self.frames, **{skin.name: skin.pose for skin in self.skins}}

    def merged_in(self, base_frame: str) -> str:
        """Frame of the merged contacts: `base_frame`, or that of the file where it is empty or none."""
        return base_frame if is_given(base_frame) else self.base_frame

    def in_base(self, base_frame: str = "") -> dict[str, Transform]:
        """Transform from each skin to the frame of the merged contacts, see `merged_in`.

        Raises
        ------
        SettingsError
            When a skin is not fixed to it.
        """
        tree = FrameTree(self.poses())
        placed = {}
        for skin in self.skins:
            try:
                placed[skin.name] = tree.between(self.merged_in(base_frame), skin.name)
            except SettingsError as error:
                raise skin.section.error(f"{error}, or merge:=false", "pose") from None
        return placed


def skins_of(parameter: str) -> SkinsFile:
    """Read the file that the parameter `skins_file` of a node names.

    Raises
    ------
    SettingsError
        When it names none, and as of `read_skins`.
    """
    if not parameter:
        raise SettingsError("skins_file is missing: the YAML file that describes the skins (docs/skins.md)")
    return read_skins(Path(parameter))


def read_skins(path: Path) -> SkinsFile:
    """Read a file of skins.

    Raises
    ------
    SettingsError
        For any error in the file, with file, line, skin and key, and what is allowed.
    """
    path = path_of(str(path), error=SettingsError)
    top = read_yaml(path)
    top.check_keys(_FILE_KEYS)
    frames_section = top.section("frames", "")
    frame_names = frames_section.names(is_frame_name, "frame")
    frames = {name: _pose(frames_section.section(name, f"frame {name}")) for name in frame_names}
    skins_section = top.section("skins", "")
    names = skins_section.names(is_short_name, "skin")
    if not names:
        raise top.error("skins: there has to be at least one", "skins")
    skins = tuple(_skin(name, skins_section.section(name, f"skin {name}")) for name in names)
    for skin in skins:
        if skin.name in frames:
            raise skin.section.error("a frame of this file has the same name")
    _check_ports(skins)
    _check_calibration_files(skins)
    base_frame = top.text("base_frame", "base_link")
    assert base_frame is not None
    if not is_frame_name(base_frame):
        raise top.error(f"base_frame = {base_frame!r}: {_FRAME_RULE}", "base_frame")
    read = SkinsFile(path, base_frame, skins, frames)
    try:
        FrameTree(read.poses())
    except SettingsError as error:
        raise top.error(str(error), "skins") from None
    return read


def _skin(name: str, section: Section) -> Skin:
    section.check_keys(_SKIN_KEYS)
    port = _port(section)
    if port is not None and "replay" in section.values:
        raise section.error("port and replay: samples come either from a board or from a recording", "replay")
    if "replay" in section.values and "recording" in section.values:
        raise section.error(
            "replay and recording: a recording is played by a simulated board, and a replay takes the place of a board",
            "recording",
        )
    rate_hz = section.number("recording_rate_hz", 1000.0, highest=1_000_000)
    if "pose" not in section.values:
        raise section.error("pose is missing: parent, position_m and rpy_rad or quaternion_xyzw of the skin's frame")
    return Skin(
        name,
        _pose(section.section("pose", f"skin {name}: pose")),
        port,
        _file(section, "replay"),
        _file(section, "recording"),
        rate_hz,
        _parameters(section, "driver"),
        _parameters(section, "reconstruction"),
        section,
    )


def _port(section: Section) -> str | None:
    """A port as the driver takes it: paths are absolute; `auto` and `serial:NUMBER` stay."""
    text = section.text("port")
    if text is None or not text.strip() or text == AUTO or text.startswith(SERIAL_PREFIX):
        return text
    return str(_beside(section, "port", text))


def _file(section: Section, key: str) -> Path | None:
    """A path; relative ones start at the file's folder."""
    text = section.text(key)
    return None if text is None else _beside(section, key, text)


def _beside(section: Section, key: str, text: str) -> Path:
    """The path that a key names, with ``~`` resolved; relative ones start at the file's folder."""
    try:
        return section.path.absolute().parent / path_of(text, error=SettingsError)
    except SettingsError as error:
        raise section.error(f"{key} = {error}", key) from None


def _layout(section: Section) -> str:
    """A known name, or the path of a file; relative ones start at the file's folder."""
    text = section.text("layout", "") or ""
    try:
        path = layout_path(text)
    except ActsError as error:
        raise section.error(str(error), "layout") from None
    return text if text in LAYOUTS else str(section.path.absolute().parent / path)


def _parameters(section: Section, node: str) -> dict[str, Any]:
    further = section.section(node, f"{section.what}: {node}")
    for key in further.values:
        if not isinstance(key, str):
            raise further.error(f"the name of a parameter is text, not {key!r}", str(key))
        if key in _NODES_OF or key in _SOURCE_KEYS:
            raise further.error(f"{key} is given at the skin itself, beside pose", key)
        if key == "frame_id":
            raise further.error("frame_id is the skin's name", key)
    own: dict[str, Any] = {
        key: section.values.get(key, _DEFAULTS.get(key)) for key, nodes in _NODES_OF.items() if node in nodes
    }
    if own.get("layout") is not None:
        own["layout"] = _layout(section)
    # What is no text is refused with the other parameters, by their settings class.
    files = {
        key: str(_beside(further, key, text))
        for key in _PATHS_OF[node]
        if isinstance(text := further.values.get(key), str) and is_given(text)
    }
    return {**{key: value for key, value in own.items() if value is not None}, **further.values, **files}


def _pose(section: Section) -> Pose:
    section.check_keys(_POSE_KEYS)
    parent = section.text("parent")
    if parent is None or not is_frame_name(parent):
        raise section.error(f"parent = {parent!r}: needed is the name of a frame; {_FRAME_RULE}", "parent")
    return Pose(parent, section.transform())


def _check_ports(skins: tuple[Skin, ...]) -> None:
    users: dict[str, Skin] = {}
    for skin in skins:
        if skin.port is None:
            continue
        port = _device(skin)
        if port in users:
            raise skin.section.error(f"port = {skin.port}: skin {users[port].name} has this port already", "port")
        users[port] = skin
    if len(users) > 1 and "auto" in users:
        raise users["auto"].section.error(
            f"port = auto works with a single board only, but {len(users)} skins have one; "
            "give serial:NUMBER or a path",
            "port",
        )


def _check_calibration_files(skins: tuple[Skin, ...]) -> None:
    """Refuse a file that two skins would read, and write in turns: each has a baseline of its own."""
    users: dict[str, Skin] = {}
    for skin in skins:
        text = skin.driver.get("calibration_file")
        # What is no text is refused with the other parameters.
        if not isinstance(text, str) or not is_given(text):
            continue
        section = skin.section.section("driver", f"{skin.section.what}: driver")
        path = _resolved(section, "calibration_file", text)
        if path in users:
            raise section.error(
                f"calibration_file = {text}: skin {users[path].name} has this file already, and each skin has a "
                "baseline of its own: name another file",
                "calibration_file",
            )
        users[path] = skin


def _device(skin: Skin) -> str:
    """What a port is told from others by: symbolic links, such as those in /dev/serial/by-id, are resolved."""
    assert skin.port is not None
    if skin.port.startswith(SERIAL_PREFIX):
        # Blanks around the number do not matter to the driver either.
        return SERIAL_PREFIX + skin.port.removeprefix(SERIAL_PREFIX).strip()
    return _resolved(skin.section, "port", skin.port) if skin.port.startswith("/") else skin.port


def _resolved(section: Section, key: str, text: str) -> str:
    """The path that a key names, without symbolic links."""
    try:
        path = Path(text).resolve()
        if path.is_symlink():  # of links in a circle; from Python 3.13 on `resolve` leaves one of them
            raise OSError(errno.ELOOP, os.strerror(errno.ELOOP), text)
        return str(path)
    except (OSError, ValueError, RuntimeError) as error:
        raise section.error(f"{key} = {text!r}: {error}", key) from None
