# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A hand that holds by touch: its description, its motors, its reflexes, and the loop that runs them.

Each is a room of its own; see theirs.
"""
