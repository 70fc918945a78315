# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The protocol of the RTDE port: packets, variables, and recipes (lists) of variables.

In come bytes and values; out come values and bytes. It does not depend on the robot.
"""

from acts_sim.ur.rtde.packets import PROTOCOL_VERSION, InputRecipe, PacketReader, PacketType, Value, encode, split_names
from acts_sim.ur.rtde.variables import INPUT_TYPES, OUTPUT_TYPES, OutputImage, OutputRecipe

__all__ = [
    "INPUT_TYPES",
    "OUTPUT_TYPES",
    "PROTOCOL_VERSION",
    "InputRecipe",
    "OutputImage",
    "OutputRecipe",
    "PacketReader",
    "PacketType",
    "Value",
    "encode",
    "split_names",
]
