# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The recovery methods by name, with one interface."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import SettingsError
from acts_core.settings import SettingValue, describe
from acts_recon.methods import METHODS, Fusion, Method, NoSettings, PerFrame, PerFrameConfig, SkinSetup
from acts_recon.sparse import Dictionary
from acts_tools.evaluate.estimators.dictionaries import cosine_dictionary, haar_dictionary
from acts_tools.evaluate.estimators.interpolation import GaussianProcess, Linear

PAPER_TOUCH_COUNTS = 50
"""The paper takes less for no touch."""


def paper_method() -> PerFrame:
    """The paper's recovery of each frame alone, with the shipped dictionary, of an array of 32 x 32 taxels."""
    return PerFrame(SkinSetup(ArrayGeometry(), touch_counts=PAPER_TOUCH_COUNTS), PerFrameConfig())


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


KINDS: dict[str, type[Method]] = {
    "paper": PerFrame,
    "acts": Fusion,
    "dct": PerFrame,
    "haar": PerFrame,
    "zero": ZeroFill,
    "linear": Linear,
    "gp": GaussianProcess,
    "last": LastValue,
}
"""The node's two methods by their names in reports, and baselines."""

_DICTIONARIES = {"dct": cosine_dictionary, "haar": haar_dictionary}


def _factory(name: str, kind: type[Method]) -> MethodFactory:
    def make(skin: SkinSetup, dictionary: Dictionary, settings: Mapping[str, SettingValue]) -> Method:
        own: Any = kind.Config(**{key: value for key, value in settings.items() if key in describe(kind.Config)})
        if kind is not PerFrame:
            return kind(skin, own)
        return PerFrame(skin, own, _DICTIONARIES[name]() if name in _DICTIONARIES else dictionary)

    return make


FACTORIES = {name: _factory(name, kind) for name, kind in KINDS.items()}
"""What makes each of `KINDS`."""

ALIASES = {"fusion": "acts", "per_frame": "paper"}
"""The node's names of these two, and what reports call them."""


def method_names() -> tuple[str, ...]:
    """Names of all methods: `FACTORIES`, further ones of the node (docs/extending.md), and `ALIASES`."""
    return *FACTORIES, *(name for name in METHODS if name not in ALIASES), *ALIASES


def report_name(name: str) -> str:
    """What reports call a method; a name that is not among `ALIASES` stays as it is."""
    return ALIASES.get(name, name)


def settings_of(name: str) -> tuple[str, ...]:
    """Names of the settings of a method.

    Raises
    ------
    SettingsError
        As `method_named`.
    """
    method_named(name)
    return tuple(describe({**METHODS, **KINDS}[report_name(name)].Config))


def method_named(name: str) -> MethodFactory:
    """Find a method by its name.

    Raises
    ------
    SettingsError
        When there is none; the message names those that exist. When a method of the node has the name of a baseline.
    """
    known_as = report_name(name)
    if name in METHODS and name in FACTORIES:
        raise SettingsError(
            f"method {name!r} in acts_recon/methods/registry.py: the evaluation has a baseline of this name, which it "
            f"would score instead; give the method a name that is none of {', '.join(FACTORIES)}"
        )
    if known_as in FACTORIES:
        return FACTORIES[known_as]
    if known_as in METHODS:
        return _factory(known_as, METHODS[known_as])
    raise SettingsError(f"method {name!r}: allowed is one of {', '.join(method_names())}")
