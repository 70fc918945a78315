# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Check the parameters of driver and reconstruction in a file of skins, by their settings classes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

import yaml

from acts_core.errors import ActsError
from acts_core.files import Section
from acts_core.sampling import check_frame
from acts_core.settings import checked, default_of, describe, unknown_key_message
from acts_driver.settings import DriverSettings
from acts_recon.settings import ReconstructionConfig, ReconstructionSettings
from acts_skins.skins_file import Skin

T = TypeVar("T")


@dataclass(frozen=True)
class TactileParameters:
    """Settings of the two nodes of a skin.

    Attributes
    ----------
    driver, reconstruction
        Checked settings.
    words : tuple of str
        Arguments of `tactile` that result in these settings.
    """

    driver: DriverSettings
    reconstruction: ReconstructionConfig
    words: tuple[str, ...]


def tactile_parameters(skin: Skin, port: str) -> TactileParameters:
    """Check the parameters that the file gives to a skin.

    Parameters
    ----------
    skin : Skin
        Skin of the file.
    port : str
        Port of its board, real or simulated; unused where the skin has a recording to replay.

    Raises
    ------
    SettingsError
        For an unknown parameter or one out of range, or a frame that the board cannot sample, with file, line, skin and
        key.
    """
    driver: dict[str, Any] = {**skin.driver, "frame_id": skin.name, "port": port}
    if skin.replay is not None:
        driver["replay"] = str(skin.replay)
    given = {"driver": driver, "reconstruction": dict(skin.reconstruction)}
    driver_settings = _settings(DriverSettings, skin, "driver", driver)
    reconstruction: ReconstructionConfig = _settings(
        ReconstructionSettings, skin, "reconstruction", skin.reconstruction
    )
    if driver_settings.has_dialogue and driver_settings.scheme and driver_settings.m:
        try:
            check_frame(driver_settings.scheme, driver_settings.rows, driver_settings.cols, driver_settings.m)
        except ActsError as error:
            raise skin.section.error(str(error), "m") from None
    try:
        reconstruction.arranged()
    except ActsError as error:
        raise skin.section.error(str(error), "layout") from None
    words: list[str] = []
    for node, values in given.items():
        for name, value in values.items():
            words += ["--set", f"{node}.{name}={_text(value)}"]
    return TactileParameters(driver_settings, reconstruction, tuple(words))


def _settings(settings_class: type[T], skin: Skin, node: str, values: Mapping[str, Any]) -> T:
    """Like `acts_core.settings.from_mapping`, but errors name the place in the file."""
    infos = describe(settings_class)
    arguments = {}
    for name, value in values.items():
        section, key = _place(skin, node, name)
        if name not in infos:
            raise section.error(unknown_key_message(name, list(infos), f"parameters of {node}"), key)
        try:
            arguments[name] = checked(name, value, default_of(settings_class, name), infos[name])
        except ActsError as error:
            raise section.error(str(error), key) from None
    try:
        return settings_class(**arguments)
    except ActsError as error:
        raise skin.section.error(str(error)) from None


def _place(skin: Skin, node: str, name: str) -> tuple[Section, str]:
    further = skin.section.section(node, f"{skin.section.what}: {node}")
    return (further, name) if name in further.values else (skin.section, name)


def _text(value: object) -> str:
    """Text that `acts_core.settings.from_text` reads as `value`: strings unchanged, everything else as YAML."""
    if isinstance(value, str):
        return value
    # In a list, because PyYAML appends a line "..." to a single value.
    return yaml.safe_dump([value], default_flow_style=True, width=math.inf).strip()[1:-1]
