# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts selftest`: test a board, its wiring and its skin."""
