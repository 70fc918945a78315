# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Which object presses: sparse representation-based classification, on samples and on images.

In come frames or images and a library of known objects; out comes a class with its confidence, or that none is known.
"""

from acts_recon.objects.classification import BOARD_COLUMNS, Classification, Classifier, ClassifierConfig
from acts_recon.objects.image_classification import ImageClassifier, ImageClassifierConfig
from acts_recon.objects.object_library import (
    ObjectLibrary,
    build_object_library,
    load_object_library,
    save_object_library,
)

__all__ = [
    "BOARD_COLUMNS",
    "Classification",
    "Classifier",
    "ClassifierConfig",
    "ImageClassifier",
    "ImageClassifierConfig",
    "ObjectLibrary",
    "build_object_library",
    "load_object_library",
    "save_object_library",
]
