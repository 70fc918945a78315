# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Plan the processes for a file of skins, without starting them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from acts_core.errors import SettingsError
from acts_core.files import require_regular
from acts_driver.settings import DriverSettings
from acts_ros.processes import packages
from acts_ros.processes.process import Process
from acts_sim.ball import WorldConfig
from acts_skins.skins_file import Skin, SkinsFile
from acts_skins.tactile_parameters import TactileParameters, tactile_parameters

_RESPAWN_DELAY_S = 0.02
_BOARD_RATE_HZ = 1000.0
# The largest that the option of a simulated board takes; its measurements take longer anyway.
_BOARD_RATE_MAX_HZ = 100_000.0
_FIRST_BOARD_ID = 0x4143_5453_0000_0001


class SkinProcesses:
    """Plans the processes of skins.

    Parameters
    ----------
    skins_file : SkinsFile
        The skins.
    simulated : bool
        Whether skins without a recording to replay get a simulated board instead of the one at their port.
    run_dir : Path
        Folder for the ports and shared files of simulated boards: each skin has a subfolder of its name.
    namespace : str
        Prefix of the skins' namespaces; empty or like ``/robot``.
    environment : mapping of str to str
        Environment of the processes.
    """

    def __init__(
        self, skins_file: SkinsFile, *, simulated: bool, run_dir: Path, namespace: str, environment: Mapping[str, str]
    ) -> None:
        self._skins_file = skins_file
        self._simulated = simulated
        self._run_dir = run_dir
        self._namespace = namespace
        self._environment = dict(environment)

    def plan(self) -> list[Process]:
        """The processes of all skins, in the order in which they are to be started.

        Raises
        ------
        SettingsError
            For an error in the file, with file, line and skin.
        LaunchError
            When a package is not installed.
        """
        return [process for number, skin in enumerate(self._skins_file.skins) for process in self._of(skin, number)]

    def _of(self, skin: Skin, number: int) -> list[Process]:
        has_board = self._simulated and skin.replay is None
        folder = self._run_dir / skin.name
        if not self._simulated and skin.port is None and skin.replay is None:
            raise skin.section.error("port or replay is missing: without simulation samples come from one of them")
        port = str(folder / "board") if has_board else skin.port or "auto"
        parameters = tactile_parameters(skin, port)
        skin.check_files()
        processes = self._simulation(skin, number, parameters, folder) if has_board else []
        processes.append(
            self._process(skin, "acts_skins", "tactile", *parameters.words, "--ros-args", *self._remaps(skin))
        )
        return processes

    def _simulation(self, skin: Skin, number: int, parameters: TactileParameters, folder: Path) -> list[Process]:
        driver = parameters.driver
        words = ["--link", f"{folder}/board", *_board_options(driver), "--seed", f"{number + 1}"]
        words += ["--board-id", f"{_FIRST_BOARD_ID + number}"]
        if skin.recording is not None:
            try:
                _require_frames(skin.recording, driver.rows, driver.cols)
            except SettingsError as error:
                raise skin.section.error(f"recording = {error}", "recording") from None
            words += ["--recording", f"{skin.recording}", "--recording-rate-hz", f"{skin.recording_rate_hz}", "--loop"]
            return [self._process(skin, "acts_firmware", "virtual_board", *words)]
        ring = f"{folder}/field.ring"
        world: dict[str, object] = {"field_ring": ring, "joint_ring": "none", "seed": number + 1}
        shown = parameters.reconstruction
        try:
            WorldConfig(pitch_m=shown.pitch_m, row_pitch_m=shown.row_pitch_m)
        except SettingsError as error:
            key = str(error).partition(" ")[0]
            raise skin.section.error(f"{error}, for a simulated ball; or give it a recording", key) from None
        world.update(rows=driver.rows, cols=driver.cols, layout=shown.layout)
        world.update(pitch_m=shown.pitch_m, row_pitch_m=shown.row_pitch_m)
        pushes = packages.share("acts_config", self._environment) / "params" / "tactile.yaml"
        # Not as ROS parameters, which are parsed as YAML: a path might be read as a number.
        given = [word for name, value in world.items() for word in ("--set", f"ball_world.{name}={value}")]
        ball_words = [*given, "--ros-args", *self._remaps(skin), "--params-file", f"{pushes}"]
        return [
            self._process(skin, "acts_firmware", "virtual_board", *words, "--field-ring", ring),
            self._process(skin, "acts_sim", "ball_world", *ball_words),
        ]

    def _remaps(self, skin: Skin) -> tuple[str, str]:
        return "-r", f"__ns:={self._namespace}/{skin.name}"

    def _process(self, skin: Skin, package: str, executable: str, *words: str) -> Process:
        program = packages.executable(package, executable, self._environment)
        return Process(
            label=f"{skin.name}/{executable}",
            command=(str(program), *words),
            environment=self._environment,
            output="screen",
            respawn=True,
            respawn_delay_s=_RESPAWN_DELAY_S,
        )


def _require_frames(path: Path, rows: int, cols: int) -> None:
    """Refuse what the simulated board would refuse to play, by when other skins would have begun."""
    require_regular(path, error=SettingsError)
    needed = f"needed are one or more frames (n, rows = {rows}, cols = {cols}) of type uint16 in C order"
    try:
        frames = np.lib.format.open_memmap(path, mode="r")
    except (OSError, ValueError) as error:
        raise SettingsError(f"{path}: no .npy file of frames ({error}); {needed}") from None
    fits = frames.size and frames.shape[1:] == (rows, cols)
    if not fits or frames.dtype != "<u2" or not frames.flags.c_contiguous:
        raise SettingsError(f"{path}: holds {frames.shape} of type {frames.dtype}; {needed}")


def _board_options(driver: DriverSettings) -> list[str]:
    """Options of a simulated board that match the driver's parameters."""
    words = ["--rows", f"{driver.rows}", "--cols", f"{driver.cols}", "--protocol", driver.protocol]
    words += ["--rate-hz", f"{min(driver.rate_cap_hz or _BOARD_RATE_HZ, _BOARD_RATE_MAX_HZ)}"]
    if driver.scheme:
        words += ["--scheme", driver.scheme]
    if driver.m:
        words += ["--m", f"{driver.m}"]
    if driver.threshold_counts >= 0:
        words += ["--threshold", f"{driver.threshold_counts}"]
    return words
