# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""All classifiers by name: a new one is a module beside this and a line here (docs/extending.md)."""

from __future__ import annotations

from acts_core.errors import SettingsError
from acts_recon.classifiers.fused_image import FusedImageRecogniser
from acts_recon.classifiers.recogniser import ObjectRecogniser
from acts_recon.classifiers.src import SrcRecogniser
from acts_recon.methods import Method

CLASSIFIERS: dict[str, type[ObjectRecogniser]] = {
    "fused_image": FusedImageRecogniser,
    "src": SrcRecogniser,
}

AUTO = "auto"
"""``fused_image`` where the method of recovery knows how sure it is, otherwise ``src``."""


def classifier_named(name: str, method: type[Method]) -> type[ObjectRecogniser]:
    """The classifier of a name, or for `AUTO` the one that goes with a method.

    Raises
    ------
    SettingsError
        When the method does not know what the classifier needs.
    """
    if name == AUTO:
        name = "fused_image" if method.is_uncertainty_known else "src"
    kind = CLASSIFIERS[name]
    if kind.is_uncertainty_needed and not method.is_uncertainty_known:
        raise SettingsError(
            f"object_classifier = {name!r}: it needs to know how sure the image is, which this method of recovery does "
            f"not say; choose {AUTO}, or the method fusion"
        )
    return kind
