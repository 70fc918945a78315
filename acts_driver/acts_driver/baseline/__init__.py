# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Baseline: what each taxel reads untouched. It is measured, follows drift, and is kept in a file.

In come frames; out comes the `Baseline`, which the reconstruction subtracts. Kernels take one frame at a time.
"""

from acts_driver.baseline.baseline import Baseline, BaselineSource
from acts_driver.baseline.baseline_config import BaselineConfig
from acts_driver.baseline.baseline_parameters import BaselineParameters
from acts_driver.baseline.baseline_tracker import BaselineTracker
from acts_driver.baseline.kept_baseline import KeptBaseline

__all__ = ["Baseline", "BaselineConfig", "BaselineParameters", "BaselineSource", "BaselineTracker", "KeptBaseline"]
