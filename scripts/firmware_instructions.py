# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Counts the instructions that the firmware's recovery and classification take on an emulated Cortex-M7 (QEMU).

    ./acts run python3 scripts/firmware_instructions.py [--json FILE]

Prints them beside the published times; docs/onboard_recovery.md says what follows. Needs the packages that it names
where they are missing; exit code 3 then.
"""

from __future__ import annotations

import argparse
import json
import struct
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from firmware import QEMU_PACKAGES, RUN_LIMIT_S, build, emulator, need
from numpy.typing import NDArray

from acts_core.wire import (
    UPLOAD_PIECE_MAX,
    BoardModel,
    BoardSettings,
    encode_configure,
    encode_upload_begin,
    encode_upload_data,
    encode_upload_end,
    object_library,
    patch_dictionary,
)
from acts_recon.objects import build_object_library
from acts_recon.sparse import load_dictionary, shipped_dictionary_path
from acts_sim.pressing import OBJECTS, ContactModel, PressingArm

CLOCK_MHZ = 600
FAST_CYCLES, SLOW_CYCLES = 0.5, 2.0
"""Cycles an instruction: two may be executed at once; divisions, calls and waiting for memory take longer."""
ICOUNT_SHIFT = 7
"""As acts_firmware/teensy/qemu/instruction_counter.cpp takes it."""
MEASUREMENTS = ATOMS = (50, 100, 200, 300, 400, 500)
"""The grid of the paper's Fig. 9."""
LIBRARIES = (30, 60)
"""Columns; the paper's 90 of 32 x 32 taxels do not fit a board."""
PRESSES = 10


@dataclass
class Work:
    """Instructions for the image or the object of one frame, by the settings and the size of the model."""

    output: str
    m: int
    columns: int
    """Atoms of the dictionary, or columns of the object library."""
    published_us: float
    """Time that the published board takes to compute, by the virtual board's model."""
    sampling_us: float
    """Time that it takes to measure the frame."""
    presses: list[int] = field(default_factory=list)
    """To compute, for each press."""
    whole_skin: int = 0
    """To compute, where every taxel is pressed."""
    again: int = 0
    """To compute, for the first press once more."""
    packet: int = 0
    """To pack and queue the result, the most of all frames."""

    @property
    def mean(self) -> float:
        return sum(self.presses) / len(self.presses)

    @property
    def published_cycles(self) -> float:
        """Cycles of the Teensy in the published time."""
        return self.published_us * CLOCK_MHZ

    @property
    def published_hz(self) -> float:
        """Frames a second of the published board."""
        return 1e6 / (self.sampling_us + self.published_us)

    def rate_hz(self, cycles_each: float) -> float:
        """Frames a second if an instruction takes so many cycles, with the result's packet."""
        return 1e6 / (self.sampling_us + (self.mean + self.packet) * cycles_each / CLOCK_MHZ)


def record(kind: bytes, data: bytes) -> bytes:
    """What count_instructions reads: see there."""
    return kind + struct.pack("<I", len(data)) + data


def tasks() -> Iterator[tuple[str, BoardModel, list[NDArray[np.uint16]]]]:
    """What to compute, the model for it, and presses of the skin.

    As for the paper's Fig. 9C: images of presses anywhere, by the first atoms of the shipped dictionary; objects that
    an arm presses, by a library of its other presses.
    """
    some = slice(0, None, len(OBJECTS) // PRESSES)
    skin = ContactModel(seed=1)
    anywhere = [skin.random_frame(item) for item in list(OBJECTS.values())[some]]
    atoms = load_dictionary(shipped_dictionary_path()).atoms
    for size in ATOMS:
        yield "image", patch_dictionary(atoms[:, :size]), anywhere[:PRESSES]
    arm = PressingArm()
    frames, names = arm.held_frames(2)
    asked = list(arm.held_frames(1)[0][some])
    for size in LIBRARIES:
        known = build_object_library(frames[:: len(frames) // size], names[:: len(frames) // size])
        yield "object", object_library(known.columns, known.classes), asked[:PRESSES]


def session() -> Iterator[bytes]:
    """Records: each model, each M; the presses, the whole skin, the first press again."""
    for output, model, presses in tasks():
        yield record(b"s", encode_upload_begin(1, model))
        for offset in range(0, len(model.payload), UPLOAD_PIECE_MAX):
            piece = model.payload[offset : offset + UPLOAD_PIECE_MAX]
            yield record(b"s", encode_upload_data(2, offset, piece))
        yield record(b"s", encode_upload_end(3))
        whole = np.linspace(300, 1000, presses[0].size)
        fields = [np.asarray(counts, dtype="<u2").tobytes() for counts in (*presses, whole, presses[0])]
        for m in MEASUREMENTS:
            yield record(b"s", encode_configure(4, BoardSettings(m=m, output=output)))
            yield from (record(b"p", counts) for counts in fields)


def works_of(frames: list[dict[str, Any]]) -> Iterator[Work]:
    """The counts by settings and model, in the order of the session."""
    for first in range(0, len(frames), PRESSES + 2):
        group = frames[first : first + PRESSES + 2]
        computing = [frame["computing"] for frame in group]
        yield Work(
            **{key: group[0][key] for key in ("output", "m", "columns", "published_us", "sampling_us")},
            presses=computing[:PRESSES],
            whole_skin=computing[PRESSES],
            again=computing[PRESSES + 1],
            packet=max(frame["with_packet"] - frame["computing"] for frame in group),
        )


def count(records: bytes) -> tuple[list[dict[str, int]], list[Work]]:
    """Loops of known length as they were counted, and the work of the firmware."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "records"
        path.write_bytes(records)
        command = emulator("count_instructions", [str(path)], "-icount", f"shift={ICOUNT_SHIFT},align=off,sleep=off")
        try:
            finished = subprocess.run(command, stdout=subprocess.PIPE, text=True, timeout=RUN_LIMIT_S)
        except subprocess.TimeoutExpired:
            sys.exit(f"[firmware] the count did not end within {RUN_LIMIT_S} s")
    if finished.returncode != 0:
        sys.exit(f"[firmware] the count failed (exit code {finished.returncode})")
    lines = [json.loads(line) for line in finished.stdout.splitlines()]
    works = list(works_of([line for line in lines if "output" in line]))
    # A model or settings that the firmware refuses leave it with those before.
    asked = [("image", m, columns) for columns in ATOMS for m in MEASUREMENTS]
    asked += [("object", m, columns) for columns in LIBRARIES for m in MEASUREMENTS]
    if [(work.output, work.m, work.columns) for work in works] != asked:
        sys.exit("[firmware] the firmware did not take each of the models and settings: it counted others than asked")
    return [line for line in lines if "turns" in line], works


def report(to: Path | None) -> int:
    """Counts, prints a table, writes the counts as JSON; not 0 where the emulator did not count exactly."""
    need(QEMU_PACKAGES)
    build()
    loops, works = count(b"".join(session()))
    around = loops[0]["instructions"] - 2 * loops[0]["turns"]
    if any(loop["instructions"] != 2 * loop["turns"] + around for loop in loops):
        print(f"[firmware] this QEMU does not count exactly; two instructions a turn became {loops}", file=sys.stderr)
        return 1
    print(
        "              |  instructions to compute       | us at 1 |   published     | frames/s at 2   |\n"
        "output   M cols|     mean   largest  whole skin | cycle   |   us  cycles    | to 0.5 cycles   | published"
    )
    for work in works:
        slow, fast = (work.rate_hz(cycles) for cycles in (SLOW_CYCLES, FAST_CYCLES))
        print(
            f"{work.output:<6} {work.m:>3} {work.columns:>4}|{work.mean:>9.0f} {max(work.presses):>9} "
            f"{work.whole_skin:>11} |{work.mean / CLOCK_MHZ:>7.0f}  |{work.published_us:>6.0f} "
            f"{work.published_cycles / work.mean:>5.1f} each |{slow:>6.0f} to {fast:>4.0f}   |{work.published_hz:>9.0f}"
        )
    print(
        f"Mean and largest are of {PRESSES} simulated presses. Published: the virtual board's model, and its cycles at "
        f"{CLOCK_MHZ} MHz\nfor each instruction of the mean. Frames: sampling as published, then our computing and its "
        "packet, at assumed cycles an instruction."
    )
    if to is not None:
        to.write_text(json.dumps({"loops": loops, "works": [asdict(work) for work in works]}, indent=1) + "\n")
    return 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the counts into this file")
    return report(parser.parse_args().json)


if __name__ == "__main__":
    sys.exit(main())
