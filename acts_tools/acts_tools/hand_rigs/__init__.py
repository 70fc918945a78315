# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The simulated hand as a scenario uses it: in one process without a clock, or launched with all its processes."""
