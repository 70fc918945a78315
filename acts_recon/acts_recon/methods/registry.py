# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""All methods of recovery by name: a new one is a module beside this and a line here (docs/extending.md)."""

from __future__ import annotations

from acts_recon.methods.fusion import Fusion
from acts_recon.methods.method import Method
from acts_recon.methods.per_frame import PerFrame

METHODS: dict[str, type[Method]] = {
    "fusion": Fusion,
    "per_frame": PerFrame,
}
