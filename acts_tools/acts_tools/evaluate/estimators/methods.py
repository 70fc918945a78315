# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The recovery methods by name, with one interface."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import SettingsError
from acts_core.settings import SettingValue, describe
from acts_recon.methods import METHODS as REGISTERED
from acts_recon.methods import Fusion, Method, NoSettings, PerFrame, SkinSetup
from acts_recon.sparse import Dictionary
from acts_tools.evaluate.estimators.dictionaries import cosine_dictionary, haar_dictionary
from acts_tools.evaluate.estimators.interpolation import GaussianProcess, Linear


class ZeroFill(Method):
    """Taxels that were not measured in this frame are 0."""

    summary = "0 for taxels that were not measured"

    def __init__(self, skin: SkinSetup, config: NoSettings | None = None) -> None:
        self.image = np.zeros((skin.geometry.rows, skin.geometry.cols), dtype=np.float32)

    def reset(self) -> None:
        """Nothing is kept."""

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> NDArray[np.float32]:
        """See `Method.step`."""
        self.image.fill(0)
        self.image.ravel()[indices] = counts
        return self.image


class LastValue(ZeroFill):
    """Every taxel keeps its last measured value."""

    summary = "the last measured value"

    def reset(self) -> None:
        """Set all values to 0."""
        self.image.fill(0)

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> NDArray[np.float32]:
        """See `Method.step`."""
        self.image.ravel()[indices] = counts
        return self.image


MethodFactory = Callable[[SkinSetup, Dictionary, Mapping[str, SettingValue]], Method]
"""Function from a skin, a dictionary (for methods that use one) and settings by name to a method."""


def _registered(kind: type[Method]) -> MethodFactory:
    return lambda skin, dictionary, settings: kind(skin, _config(kind, settings))


def _config(kind: type[Method], settings: Mapping[str, SettingValue]) -> Any:
    """Settings of a method, from all given settings."""
    return kind.Config(**{name: value for name, value in settings.items() if name in describe(kind.Config)})


METHODS: dict[str, MethodFactory] = {
    "paper": lambda skin, dictionary, settings: PerFrame(skin, _config(PerFrame, settings), dictionary),
    "acts": _registered(Fusion),
    "dct": lambda skin, dictionary, settings: PerFrame(skin, _config(PerFrame, settings), cosine_dictionary()),
    "haar": lambda skin, dictionary, settings: PerFrame(skin, _config(PerFrame, settings), haar_dictionary()),
    "zero": _registered(ZeroFill),
    "linear": _registered(Linear),
    "gp": _registered(GaussianProcess),
    "last": _registered(LastValue),
}
"""The node's two methods by their names in reports, and baselines."""


def method_names() -> tuple[str, ...]:
    """Names of all methods: `METHODS`, and further ones of the node (docs/extending.md)."""
    return *METHODS, *(name for name, kind in REGISTERED.items() if kind not in (Fusion, PerFrame))


def method_named(name: str) -> MethodFactory:
    """Find a method by its name.

    Raises
    ------
    SettingsError
        When there is none; the message names those that exist.
    """
    if name in METHODS:
        return METHODS[name]
    if name in REGISTERED:
        return _registered(REGISTERED[name])
    raise SettingsError(f"method {name!r}: allowed is one of {', '.join(method_names())}")
