# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Runs the Teensy's sketch on a model of the board (sketch_run.cpp), on the host or on an emulated Teensy processor."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass, field
from pathlib import Path

from core_library import installed

from acts_core.frames import SampleFrame
from acts_core.wire import (
    UPLOAD_PIECE_MAX,
    BoardMessage,
    BoardModel,
    StreamDecoder,
    encode_upload_begin,
    encode_upload_data,
    encode_upload_end,
)

WATCHDOG_ENABLED = 0x04
RUN_LIMIT_S = 120


@dataclass
class SketchRun:
    """What the host read, in order, and what the model saw of the sketch."""

    reads: list[tuple[int, bytes]] = field(default_factory=list)
    """Time [us] at which the host read, and what."""
    report: dict[str, list[int]] = field(default_factory=dict)
    text: str = ""

    def read_from(self, start_us: int) -> bytes:
        return b"".join(data for time_us, data in self.reads if time_us >= start_us)

    def messages(self) -> list[BoardMessage]:
        """Replies, images and objects."""
        found: list[BoardMessage] = []
        decoder = StreamDecoder(on_message=found.append)
        decoder.feed(self.read_from(0))
        return found

    def frames(self, start_us: int = 0) -> list[SampleFrame]:
        """Frames read from `start_us` on; every byte must be part of one."""
        decoder = StreamDecoder()
        found = list(decoder.feed(self.read_from(start_us)))
        assert decoder.crc_errors == 0
        assert decoder.malformed == 0
        return found


def upload(model: BoardModel, start_us: int, step_us: int = 200) -> list[str]:
    """Script lines that upload a model, the last command with request number 3."""
    commands = [encode_upload_begin(1, model)]
    for offset in range(0, len(model.payload), UPLOAD_PIECE_MAX):
        commands.append(encode_upload_data(2, offset, model.payload[offset : offset + UPLOAD_PIECE_MAX]))
    commands.append(encode_upload_end(3))
    return [f"{start_us + step_us * i} send {command.hex()}" for i, command in enumerate(commands)]


def parse(text: str) -> SketchRun:
    run = SketchRun(text=text)
    for line in text.splitlines():
        name, *words = line.split()
        if name == "data":
            run.reads.append((int(words[0]), bytes.fromhex(words[1])))
        else:
            run.report[name] = [int(word) for word in words]
    return run


def run_sketch(script: list[str], tmp_path: Path, command: list[str] | None = None) -> SketchRun:
    """Runs `script` (see sketch_run.cpp); by the binary sketch on the host unless `command` says otherwise."""
    path = tmp_path / "script.txt"
    path.write_text("\n".join(script) + "\n")
    result = subprocess.run(
        [*(command or [str(installed("sketch_binary"))]), str(path)],
        capture_output=True,
        text=True,
        timeout=RUN_LIMIT_S,
    )
    assert result.returncode == 0, result.stdout[-2000:] + result.stderr
    return parse(result.stdout)
