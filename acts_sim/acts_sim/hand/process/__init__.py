# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The process `hand_world`: the simulated hand in real time, behind a serial port, a ring and a socket."""
