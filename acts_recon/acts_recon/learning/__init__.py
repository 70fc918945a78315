# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Learning of dictionaries: K-SVD on patches of recorded or simulated frames.

In come full frames; out come atoms. Nothing of it runs while a skin is read.
"""

from acts_recon.learning.ksvd import KsvdConfig, KsvdProgress, KsvdState, learn_dictionary
from acts_recon.learning.ksvd_kernels import code_patches
from acts_recon.learning.training_patches import prune_coherent, random_patches

__all__ = [
    "KsvdConfig",
    "KsvdProgress",
    "KsvdState",
    "code_patches",
    "learn_dictionary",
    "prune_coherent",
    "random_patches",
]
