# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The script port, which receives URScript programs and starts them."""

from __future__ import annotations

import re

from acts_sim.ur import COMMANDS, Controller, ControlProgram

MAX_PROGRAM_BYTES = 1_000_000
"""Largest size of a program [bytes]; the control script has about 42 kB."""

CONTROL_PROGRAM = "rtde_control"

_HEAD = re.compile(rb"^(def|sec)[ \t]+(\w+)[ \t]*\([^\n]*\n", re.MULTILINE)
_END = b"\nend\n"
_OFFSET = re.compile(rb"reg_offset_int[ \t]*=[ \t]*#[^\n]*\n[ \t]*(\d+)")


class ScriptReader:
    """Splits a stream of text into programs: from a line ``def name():`` to a line ``end``; other text is dropped."""

    def __init__(self) -> None:
        self._buffer = bytearray()

    def feed(self, data: bytes) -> list[tuple[str, bytes]]:
        """The programs that `data` completes, as (name, text)."""
        searched_from = max(len(self._buffer) - len(_END), 0)
        self._buffer += data
        programs = []
        while (end := self._buffer.find(_END, searched_from)) >= 0:
            text = bytes(self._buffer[: end + len(_END)])
            del self._buffer[: end + len(_END)]
            searched_from = 0
            head = _HEAD.search(text)
            if head is not None:
                programs.append((head.group(2).decode(), text[head.start() :]))
        if len(self._buffer) > MAX_PROGRAM_BYTES:
            self._buffer.clear()
        return programs


class ScriptSession:
    """One client of the script port."""

    greeting = b""
    streaming = False

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._reader = ScriptReader()

    def receive(self, data: bytes) -> bytes:
        """Start the programs that `data` completes; there is no reply."""
        for name, text in self._reader.feed(data):
            self._controller.note("script", f"program {name}")
            if name == CONTROL_PROGRAM:
                found = _OFFSET.search(text)
                # No number yet: the text may be anything, and Python refuses to convert thousands of digits.
                offset = found.group(1).decode() if found else "0"
                if offset in ("0", "24"):
                    self._controller.load_program(ControlProgram(COMMANDS, name, int(offset)))
                else:
                    offset = offset if len(offset) <= 8 else f"{offset[:8]}..."
                    self._controller.log(
                        f"control script with register offset {offset} not started; allowed are 0 and 24"
                    )
            else:
                self._controller.log(f"program {name!r} not started: only the control script of ur_rtde is simulated")
        return b""

    def tick(self) -> bytes:
        """Nothing to send."""
        return b""

    def close(self) -> None:
        """Nothing to do: the program runs on without the connection."""
