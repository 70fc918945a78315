"""What each taxel reads untouched: determined, followed as it drifts, kept in a file.

In come frames; out comes the `Baseline`, by which the reconstruction subtracts. Kernels do it a frame at a time.
"""

from acts_driver.baseline.baseline import Baseline
from acts_driver.baseline.baseline_parameters import BaselineParameters
from acts_driver.baseline.baseline_tracker import BaselineTracker

__all__ = ["Baseline", "BaselineParameters", "BaselineTracker"]
