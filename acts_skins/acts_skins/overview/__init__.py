# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""All skins together: their frames, and an aggregate of their diagnostics."""
