# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The demonstration of ball balancing: run, recorded, scored and drawn."""
