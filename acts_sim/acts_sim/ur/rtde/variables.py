# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The variables of the RTDE interface, and a packed buffer of the outputs from which data packages are made.

The buffer has all outputs in the order in which ``ur_rtde`` requests them by default. So a package of all of them is a
few slices of the buffer, and a cycle packs only what has changed.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence

from acts_core.errors import PacketError
from acts_sim.ur.rtde.packets import HEADER, MAX_PACKET_BYTES, TYPE_FORMATS, Number, PacketType

REGISTERS = 48
"""Number of general purpose registers of each type; 0 to 23 is the lower range, 24 to 47 the upper."""

_OUTPUT_GROUPS: tuple[tuple[str, str], ...] = (
    ("DOUBLE", "timestamp"),
    (
        "VECTOR6D",
        "target_q target_qd target_qdd target_current target_moment actual_q actual_qd actual_current"
        " joint_control_output actual_TCP_pose actual_TCP_speed actual_TCP_force target_TCP_pose target_TCP_speed",
    ),
    ("UINT64", "actual_digital_input_bits"),
    ("VECTOR6D", "joint_temperatures"),
    ("DOUBLE", "actual_execution_time"),
    ("INT32", "robot_mode"),
    ("VECTOR6INT32", "joint_mode"),
    ("INT32", "safety_mode"),
    ("VECTOR3D", "actual_tool_accelerometer"),
    (
        "DOUBLE",
        "speed_scaling target_speed_fraction actual_momentum actual_main_voltage actual_robot_voltage"
        " actual_robot_current",
    ),
    ("VECTOR6D", "actual_joint_voltage"),
    ("UINT64", "actual_digital_output_bits"),
    ("UINT32", "runtime_state"),
    (
        "DOUBLE",
        "standard_analog_input0 standard_analog_input1 standard_analog_output0 standard_analog_output1",
    ),
    ("UINT32", "robot_status_bits safety_status_bits"),
    ("VECTOR6D", "ft_raw_wrench"),
    ("DOUBLE", "payload"),
    ("VECTOR3D", "payload_cog"),
    ("VECTOR6D", "payload_inertia"),
    ("INT32", " ".join(f"output_int_register_{index}" for index in range(REGISTERS))),
    ("DOUBLE", " ".join(f"output_double_register_{index}" for index in range(REGISTERS))),
    ("UINT32", "output_bit_registers0_to_31 output_bit_registers32_to_63"),
    ("INT32", "safety_status"),
)

OUTPUT_TYPES: dict[str, str] = {name: kind for kind, names in _OUTPUT_GROUPS for name in names.split()}
"""RTDE type of each output variable by name."""

_INPUT_GROUPS: tuple[tuple[str, str], ...] = (
    ("UINT32", "speed_slider_mask"),
    ("DOUBLE", "speed_slider_fraction"),
    (
        "UINT8",
        "standard_digital_output_mask standard_digital_output configurable_digital_output_mask"
        " configurable_digital_output tool_digital_output_mask tool_digital_output standard_analog_output_mask"
        " standard_analog_output_type",
    ),
    ("DOUBLE", "standard_analog_output_0 standard_analog_output_1"),
    ("UINT32", "input_bit_registers0_to_31 input_bit_registers32_to_63"),
    ("INT32", " ".join(f"input_int_register_{index}" for index in range(REGISTERS))),
    ("DOUBLE", " ".join(f"input_double_register_{index}" for index in range(REGISTERS))),
    ("VECTOR6D", "external_force_torque"),
)

INPUT_TYPES: dict[str, str] = {name: kind for kind, names in _INPUT_GROUPS for name in names.split()}
"""RTDE type of each input variable by name."""

TCP_VARIABLES = frozenset({"actual_TCP_pose", "actual_TCP_speed", "target_TCP_pose", "target_TCP_speed"})
"""The outputs that need forward kinematics."""

# Values of a robot that is switched on and idle; variables that are not simulated keep them.
_INITIAL: dict[str, tuple[Number, ...]] = {
    "joint_temperatures": (25.0,) * 6,
    "actual_tool_accelerometer": (0.0, 0.0, 9.81),
    "speed_scaling": (1.0,),
    "target_speed_fraction": (1.0,),
    "actual_main_voltage": (48.0,),
    "actual_robot_voltage": (48.0,),
    "actual_robot_current": (0.5,),
    "actual_joint_voltage": (48.0,) * 6,
}


class OutputImage:
    """Packed present values of all output variables."""

    def __init__(self) -> None:
        self._structs: dict[str, struct.Struct] = {}
        self._offsets: dict[str, int] = {}
        offset = 0
        for name, kind in OUTPUT_TYPES.items():
            packer = struct.Struct(">" + TYPE_FORMATS[kind])
            self._structs[name] = packer
            self._offsets[name] = offset
            offset += packer.size
        self._buffer = bytearray(offset)
        self._view = memoryview(self._buffer)
        for name, values in _INITIAL.items():
            self.set(name, *values)

    def set(self, name: str, *values: Number) -> None:
        """Set the values of a variable, as many as its type has."""
        self._structs[name].pack_into(self._buffer, self._offsets[name], *values)

    def get(self, name: str) -> tuple[Number, ...]:
        """Values of a variable."""
        return self._structs[name].unpack_from(self._buffer, self._offsets[name])

    def slices(self, names: Sequence[str]) -> list[memoryview]:
        """Views of the buffer that together are the packed values of `names`, and change with them."""
        ranges: list[list[int]] = []
        for name in names:
            start = self._offsets[name]
            end = start + self._structs[name].size
            if ranges and ranges[-1][1] == start:
                ranges[-1][1] = end
            else:
                ranges.append([start, end])
        return [self._view[start:end] for start, end in ranges]


class OutputRecipe:
    """An agreed list of output variables; makes its data packages.

    Parameters
    ----------
    image : OutputImage
        Source of the values.
    names : sequence of str
        Names of known variables, in order.
    frequency_hz : float
        Packages per second, at most the controller's rate.

    Raises
    ------
    PacketError
        When the values do not fit one packet.
    """

    ID = 1

    def __init__(self, image: OutputImage, names: Sequence[str], frequency_hz: float) -> None:
        self.names = tuple(names)
        self.frequency_hz = frequency_hz
        self.needs_tcp = not TCP_VARIABLES.isdisjoint(names)
        self._pieces = image.slices(names)
        size = HEADER.size + 1 + sum(len(piece) for piece in self._pieces)
        if size > MAX_PACKET_BYTES:
            raise PacketError(f"a data package of {size} bytes is asked for; at most {MAX_PACKET_BYTES} fit")
        self._header = HEADER.pack(size, PacketType.DATA_PACKAGE) + bytes([self.ID])

    def package(self) -> bytes:
        """A data package with the present values."""
        return b"".join([self._header, *self._pieces])
