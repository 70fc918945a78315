# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The demonstration of the hand's reflexes: run, recorded, scored and drawn."""
