# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The classifiers that the node and `acts evaluate` offer: a classifier is a module here and a line in `registry`.

In come the samples of frame after frame, and what a method of recovery has made of them; out comes which of the objects
of a library presses.
"""

from acts_recon.classifiers.fused_image import FusedImageConfig, FusedImageRecogniser
from acts_recon.classifiers.recogniser import ObjectRecogniser
from acts_recon.classifiers.registry import AUTO, CLASSIFIERS, classifier_named
from acts_recon.classifiers.src import SrcConfig, SrcRecogniser

__all__ = [
    "AUTO",
    "CLASSIFIERS",
    "FusedImageConfig",
    "FusedImageRecogniser",
    "ObjectRecogniser",
    "SrcConfig",
    "SrcRecogniser",
    "classifier_named",
]
