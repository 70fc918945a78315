# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate`: score recovery, classification, slip and reflexes on recorded or simulated touch."""
