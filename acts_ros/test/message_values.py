# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Whatever the fields of messages may hold, for property tests."""

import math

from hypothesis import strategies as st

STAMPS_NS = st.integers(-(2**31) * 10**9, 2**31 * 10**9 - 1)
NAMES = st.text(st.characters(exclude_characters="\0", codec="utf-8"), max_size=20)
NUMBERS = st.integers(0, 2**32 - 1)
DOUBLES = st.floats()
# Of the largest ones rclpy says that they do not fit.
SINGLES = st.floats(width=32).filter(lambda value: not 3.4e38 < abs(value) < math.inf)
