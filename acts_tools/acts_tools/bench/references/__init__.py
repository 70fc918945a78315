# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""References to compare ACTS with: the same work in plain Python, in other libraries, and as bare arithmetic."""
