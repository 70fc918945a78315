# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures on fast events: bounces, ricochets, outlines and vibration."""
