# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The driver: reads a board at a serial port, or a recording, and publishes frames stamped with their measurement.

In come bytes and parameters; out come frames, the baseline and the state of the board. Only `nodes` needs ROS.
"""
