# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where the dictionary that comes with ACTS is."""

from __future__ import annotations

from pathlib import Path

SHIPPED_NAME = "patch8_k1000.npz"


def shipped_dictionary_path() -> Path:
    """Path of the shipped dictionary, which is installed with this package."""
    return Path(__file__).with_name("dictionaries") / SHIPPED_NAME
