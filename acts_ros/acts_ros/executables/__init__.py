# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The start of every executable: signal handlers first, then imports, then nodes; what keeps one from starting."""
