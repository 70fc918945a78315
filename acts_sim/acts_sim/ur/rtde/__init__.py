"""The language of the RTDE port: packets, the variables that they carry, and recipes of variables.

In come bytes and values; out come values and bytes. Nothing here knows a robot.
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
