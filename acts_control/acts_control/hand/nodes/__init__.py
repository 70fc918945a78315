# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The nodes of a hand: its motors alone, or with its reflexes.

In come `regions` and services; out go joint states, the reflexes' state, and the motors' goals.
"""
