# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Launch a simulated hand for every rig of a scenario."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from types import TracebackType

import yaml
from ament_index_python.packages import get_package_share_directory

from acts_sim.hand import HandWorldConfig
from acts_tools.hand_rigs.collector import HandCollector
from acts_tools.hand_rigs.live import NAMESPACE, live_hand
from acts_tools.hand_rigs.live_rig import LiveRig
from acts_tools.hand_rigs.recording import HandRecording
from acts_tools.hand_rigs.rig import RigOptions
from acts_tools.run_folder import run_folder
from acts_tools.running.stopping import StopFlag


class LiveRigs:
    """Makes rigs one after another: each is stopped when the next is made, and the last at the end of the block.

    Parameters
    ----------
    log_path : Path
        File for the output of the launch.
    stop : StopFlag
        Set when the user wants to stop (KeyboardInterrupt).
    line : callable
        Returns the status line.

    Attributes
    ----------
    recording : HandRecording
        Recording of the newest rig; complete when that has ended.
    world : HandWorldConfig
        Settings of that rig's world.
    """

    def __init__(
        self, log_path: Path, stop: StopFlag, line: Callable[[HandCollector], str] = lambda _collector: ""
    ) -> None:
        self.recording = HandRecording()
        self.world = HandWorldConfig()
        self._log_path = log_path
        self._stop = stop
        self._line = line
        self._stack = ExitStack()

    def __enter__(self) -> LiveRigs:
        """Does not launch anything yet."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End what runs."""
        self._stack.__exit__(kind, error, trace)

    def close(self) -> None:
        """End what runs."""
        self._stack.close()

    def __call__(self, world: HandWorldConfig, options: RigOptions) -> LiveRig:
        """Launch a hand with this world and these reflexes."""
        self.close()
        self.recording, self.world = HandRecording(), world
        folder = Path(self._stack.enter_context(run_folder("acts_hand_")))
        arguments = {
            "object": world.object,
            "object_size": f"{world.object_size_m:.6f}",
            "object_mass": f"{world.object_mass_kg:.6f}",
            "object_x": f"{world.object_x_m:.6f}",
            "object_y": f"{world.object_y_m:.6f}",
            "object_held": str(world.object_held).lower(),
            "pose": world.pose,
            "seed": str(world.seed),
            "reflexes": " ".join(options.reflexes),
            "rate_hz": f"{options.rate_hz:g}.0" if float(options.rate_hz).is_integer() else f"{options.rate_hz}",
            "params_file": str(_params_file(folder, options)),
        }
        hand = self._stack.enter_context(
            live_hand(arguments, self.recording, folder / "run", self._log_path, self._stop, self._line)
        )
        return LiveRig(hand, world)


def _params_file(folder: Path, options: RigOptions) -> Path:
    """Write a params file with the shipped parameters and those of the options."""
    shipped = Path(get_package_share_directory("acts_config")) / "params" / "hand_reflexes.yaml"
    felt = {"touch_counts": options.touch_counts, "noise_counts": options.noise_counts, **asdict(options.slip)}
    own = {"reconstruction": felt}
    if options.settings:
        own["hand_reflexes"] = dict(options.settings)
    sections = {f"{NAMESPACE}/{node}": {"ros__parameters": parameters} for node, parameters in own.items()}
    path = folder / "params.yaml"
    path.write_text(f"{shipped.read_text()}\n{yaml.safe_dump(sections)}")
    return path
