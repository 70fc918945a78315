# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures on the board: frame rates, recovery and classification on it, and the response of its taxels."""
