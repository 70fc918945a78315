# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Skins: driver and reconstruction of one skin in one process (`tactile`), and several skins of a robot.

In comes a file that describes the skins; out come their processes, their contacts in one message, their coordinate
frames, and an aggregate of their diagnostics.
"""
