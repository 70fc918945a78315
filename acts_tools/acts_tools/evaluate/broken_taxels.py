# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Broken taxels of a simulated skin, and those that recovery and board are told of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import SettingsError
from acts_core.settings import setting
from acts_core.skin import TAXELS_RULE, taxels_named
from acts_recon.images import DeadTaxelsConfig


@dataclass(frozen=True, kw_only=True)
class BrokenTaxels:
    """Which taxels are broken, and of which recovery and board know."""

    broken_taxels: str = setting("", f"taxels that read 0, but for added noise: {TAXELS_RULE}")
    dead_taxels: str = setting("", "taxels that recovery and board are told to be dead, in the same way")

    def are_broken(self, rows: int, cols: int) -> NDArray[np.bool_]:
        """`broken_taxels` of a matrix of this size; bool (rows, cols).

        Raises
        ------
        SettingsError
            They are none of it.
        """
        try:
            return taxels_named(self.broken_taxels, rows, cols)
        except SettingsError as error:
            raise SettingsError(f"broken_taxels: {error}") from None

    def are_dead(self, rows: int, cols: int) -> NDArray[np.bool_] | None:
        """`dead_taxels` likewise, or None where there are none; see `DeadTaxelsConfig.dead`."""
        return DeadTaxelsConfig(self.dead_taxels).dead(rows, cols)
