# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A simulated hand that runs from its launch file: commanded, observed and recorded."""
