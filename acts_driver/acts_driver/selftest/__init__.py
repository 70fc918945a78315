# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Whether a board and its skin work: judged from frames of the untouched skin, and of a hand that rolls over it."""

from acts_driver.selftest.findings import Finding, Level, Thresholds, listed
from acts_driver.selftest.record import FrameRecord
from acts_driver.selftest.timing import Timing, judge_timing, measure_timing
from acts_driver.selftest.touched import Touched, judge_touched, measure_touched
from acts_driver.selftest.untouched import Untouched, judge_high, judge_untouched, measure_untouched

__all__ = [
    "Finding",
    "FrameRecord",
    "Level",
    "Thresholds",
    "Timing",
    "Touched",
    "Untouched",
    "judge_high",
    "judge_timing",
    "judge_touched",
    "judge_untouched",
    "listed",
    "measure_timing",
    "measure_touched",
    "measure_untouched",
]
