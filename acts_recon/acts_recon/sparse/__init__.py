# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Sparse recovery: the image from the samples of one frame alone, as a sum of few atoms of a dictionary.

In come samples and a dictionary of patches; out comes the image. FastOMP (paper, section "Reconstruction") is here in
NumPy and as kernels.
"""

from acts_recon.sparse import fastomp_kernels
from acts_recon.sparse.dictionary import Dictionary, load_dictionary, save_dictionary
from acts_recon.sparse.fastomp import REGULARISATION, SPARSITY_RATIO, fast_omp, sparsity
from acts_recon.sparse.fastomp_kernels import FASTMATH, pursue, solve
from acts_recon.sparse.fastomp_model import (
    ALLOWED,
    CHOSEN,
    MEASURED,
    N_CHOSEN,
    ORDER,
    PRESSED,
    RESIDUAL_ROWS,
    Y_ROWS,
    PatchModel,
    Problems,
    in_blocks,
    workspace,
)
from acts_recon.sparse.patches import PatchLayout, patch_layout, patch_starts
from acts_recon.sparse.reconstructor import Reconstructor, ReconstructorConfig
from acts_recon.sparse.shipped import shipped_dictionary_path

__all__ = [
    "ALLOWED",
    "CHOSEN",
    "FASTMATH",
    "MEASURED",
    "N_CHOSEN",
    "ORDER",
    "PRESSED",
    "REGULARISATION",
    "RESIDUAL_ROWS",
    "SPARSITY_RATIO",
    "Y_ROWS",
    "Dictionary",
    "PatchLayout",
    "PatchModel",
    "Problems",
    "Reconstructor",
    "ReconstructorConfig",
    "fast_omp",
    "fastomp_kernels",
    "in_blocks",
    "load_dictionary",
    "patch_layout",
    "patch_starts",
    "pursue",
    "save_dictionary",
    "shipped_dictionary_path",
    "solve",
    "sparsity",
    "workspace",
]
