# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""One client of the RTDE port: its requests and their replies as bytes, without sockets."""

from __future__ import annotations

import math
import struct

from acts_core.errors import PacketError
from acts_sim.ur import COMMAND_REGISTERS, CYCLE_HZ, MOTION_COMMANDS, VERSION, Controller
from acts_sim.ur.rtde import (
    INPUT_TYPES,
    OUTPUT_TYPES,
    PROTOCOL_VERSION,
    InputRecipe,
    OutputRecipe,
    PacketReader,
    PacketType,
    encode,
    split_names,
)

MAX_INPUT_RECIPES = 255


class RtdePort:
    """The clients of the RTDE port, and which of them writes each input variable, at most one.

    Parameters
    ----------
    controller : Controller
        The robot.
    """

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._sessions: list[RtdeSession] = []
        self._writers: dict[str, RtdeSession] = {}

    def session(self) -> RtdeSession:
        """The session of a new client."""
        session = RtdeSession(self._controller, self)
        self._sessions.append(session)
        return session

    @property
    def needs_tcp(self) -> bool:
        """Whether any client receives the pose or speed of the tool."""
        return any(session.needs_tcp for session in self._sessions)

    def writer(self, name: str) -> RtdeSession | None:
        """The session that writes a variable."""
        return self._writers.get(name)

    def claim(self, names: tuple[str, ...], session: RtdeSession) -> None:
        """Register a session as the writer of variables."""
        self._writers.update(dict.fromkeys(names, session))

    def release(self, session: RtdeSession) -> None:
        """Remove a session that has ended."""
        self._sessions = [other for other in self._sessions if other is not session]
        self._writers = {name: writer for name, writer in self._writers.items() if writer is not session}


class RtdeSession:
    """State of one RTDE connection.

    Parameters
    ----------
    controller : Controller
        The robot.
    port : RtdePort
        Shared by all sessions.
    """

    greeting = b""

    def __init__(self, controller: Controller, port: RtdePort) -> None:
        self._controller = controller
        self._port = port
        self._reader = PacketReader()
        self._inputs: list[InputRecipe] = []
        self._output: OutputRecipe | None = None
        self._started = False
        self._phase = 0.0

    @property
    def streaming(self) -> bool:
        """Whether data packages are being sent; those of the client then have an effect from the next cycle on."""
        return self._started

    @property
    def needs_tcp(self) -> bool:
        """Whether the packages being sent contain the pose or speed of the tool."""
        return self._started and self._output is not None and self._output.needs_tcp

    def receive(self, data: bytes) -> bytes:
        """Replies to bytes from the client.

        Raises
        ------
        PacketError
            When they are not RTDE; the connection must be closed.
        """
        replies = b""
        data_package: bytes | None = None
        for kind, payload in self._reader.feed(data):
            # Registers are read once per cycle, so of consecutive packages of the same inputs only the last matters.
            if data_package is not None and (
                kind != PacketType.DATA_PACKAGE or payload[:1] != data_package[:1] or len(payload) != len(data_package)
            ):
                self._take_inputs(data_package)
                data_package = None
            if kind == PacketType.DATA_PACKAGE:
                data_package = payload
            else:
                replies += self._reply(kind, payload)
        if data_package is not None:
            self._take_inputs(data_package)
        return replies

    def tick(self) -> bytes:
        """Bytes to send after a cycle: a data package, or nothing."""
        if not self._started or self._output is None:
            return b""
        self._phase += self._output.frequency_hz / CYCLE_HZ
        if self._phase < 1.0 - 1e-9:
            return b""
        self._phase -= 1.0
        return self._output.package()

    def close(self) -> None:
        """Handle the end of the connection."""
        self._started = False
        self._port.release(self)

    def _reply(self, kind: PacketType, payload: bytes) -> bytes:
        if kind == PacketType.REQUEST_PROTOCOL_VERSION:
            return encode(kind, bytes([payload == struct.pack(">H", PROTOCOL_VERSION)]))
        if kind == PacketType.GET_URCONTROL_VERSION:
            return encode(kind, struct.pack(">4I", *VERSION))
        if kind == PacketType.SETUP_OUTPUTS:
            return encode(kind, self._setup_outputs(payload))
        if kind == PacketType.SETUP_INPUTS:
            return encode(kind, self._setup_inputs(payload))
        if kind == PacketType.START:
            return self._start()
        if kind == PacketType.PAUSE:
            self._started = False
            return encode(kind, b"\x01")
        return b""  # text messages of the client are ignored

    def _setup_outputs(self, payload: bytes) -> bytes:
        if len(payload) < 8:
            raise PacketError(f"output setup of {len(payload)} bytes; it begins with a frequency of 8 bytes")
        (frequency,) = struct.unpack_from(">d", payload)
        names = split_names(payload[8:])
        types = [OUTPUT_TYPES.get(name, "NOT_FOUND") for name in names]
        self._output = None
        number = 0
        if names and "NOT_FOUND" not in types:
            # The range of a real controller; NaN means the highest frequency.
            in_range = min(max(frequency, 1.0), float(CYCLE_HZ)) if math.isfinite(frequency) else float(CYCLE_HZ)
            try:
                self._output = OutputRecipe(self._controller.output, names, in_range)
                number = OutputRecipe.ID
            except PacketError as error:
                self._controller.log(str(error))
        return bytes([number]) + ",".join(types).encode()

    def _setup_inputs(self, payload: bytes) -> bytes:
        names = split_names(payload)
        types = [INPUT_TYPES.get(name, "NOT_FOUND") for name in names]
        for index, name in enumerate(names):
            if types[index] != "NOT_FOUND" and self._port.writer(name) not in (None, self):
                types[index] = "IN_USE"
        answer = ",".join(types).encode()
        if not names or not set(types).isdisjoint({"NOT_FOUND", "IN_USE"}) or len(self._inputs) == MAX_INPUT_RECIPES:
            return b"\x00" + answer
        recipe = InputRecipe(names, types)
        self._inputs.append(recipe)
        self._port.claim(recipe.names, self)
        return bytes([len(self._inputs)]) + answer

    def _start(self) -> bytes:
        self._started = self._output is not None
        reply = encode(PacketType.START, bytes([self._started]))
        if self._output is None:
            return reply
        if self._output.needs_tcp:
            self._controller.publish_tcp()
        self._phase = 0.0
        # The client expects a state first.
        return reply + self._output.package()

    def _take_inputs(self, payload: bytes) -> None:
        number = payload[0] if payload else 0
        if not 1 <= number <= len(self._inputs):
            self._controller.log(f"data package for input recipe {number}; {len(self._inputs)} are agreed; ignored")
            return
        recipe = self._inputs[number - 1]
        decoded = recipe.decode(payload[1:])
        excess = len(payload) - 1 - recipe.size
        if excess > 0:
            self._controller.log(f"input recipe {number}: {excess} bytes too many, ignored")
        if not decoded.whole:
            self._controller.log(f"input recipe {number}: {-excess} bytes too few")
            if any(decoded.values.get(name) in MOTION_COMMANDS for name in COMMAND_REGISTERS):
                self._controller.protective_stop("a motion command with too few values")
                return
        self._controller.write_inputs(decoded.values)
