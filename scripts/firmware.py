# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Cross-compiles the firmware for the Teensy 4.1, checks its sizes, and runs programs on QEMU's Cortex-M7.

    ./acts run python3 scripts/firmware.py                     # build, sizes; what `make firmware` does
    ./acts run python3 scripts/firmware.py run core_test       # a program of acts_firmware/teensy under QEMU

Needs the packages that it names where they are missing; exit code 3 then.
"""

from __future__ import annotations

import argparse
import fcntl
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SOURCE = ROOT / "acts_firmware"
BUILD = ROOT / ".acts/firmware"
LOCK = ROOT / ".acts/firmware.lock"
TOOLS_MISSING = 3

COMPILER = "arm-none-eabi-g++"
COMPILER_PACKAGES = {
    COMPILER: "gcc-arm-none-eabi libnewlib-arm-none-eabi libstdc++-arm-none-eabi-newlib",
    "cmake": "cmake",
    "make": "make",
}
QEMU_PACKAGES = {"qemu-system-arm": "qemu-system-arm"}
RUN_LIMIT_S = 120

KB = 1024
BANK_BYTES = 512 * KB
CODE_BLOCK_BYTES = 32 * KB
FLASH_BYTES = 7936 * KB
STACK_BYTES = 64 * KB
"""What is to remain of RAM1 for the stack."""

# What the Teensy's own core adds, rounded up: linked with that of June 2026 it was 8, 4 and 12 KB.
CORE_CODE_BYTES = 16 * KB
CORE_DATA_BYTES = 8 * KB
CORE_RAM2_BYTES = 16 * KB

PROGRAM_SECTIONS = {
    "flash": (".startup",),
    "code": (".text", ".ARM.exidx"),
    "data": (".data",),
    "zeroed": (".bss",),
    "ram2": (".dmabuffers",),
}


@dataclass(frozen=True)
class Sizes:
    """Bytes that a program takes, without the Teensy's core: once-run code in flash, the rest as it lies in RAM."""

    flash: int
    code: int
    data: int
    zeroed: int
    ram2: int

    @property
    def image(self) -> int:
        """What is flashed."""
        return self.flash + self.code + self.data

    @property
    def stack(self) -> int:
        """What remains of RAM1 with the Teensy's core: code takes whole blocks, the rest is data, then stack."""
        blocks = -(-(self.code + CORE_CODE_BYTES) // CODE_BLOCK_BYTES)
        return BANK_BYTES - blocks * CODE_BLOCK_BYTES - self.data - self.zeroed - CORE_DATA_BYTES

    @property
    def ram2_free(self) -> int:
        return BANK_BYTES - self.ram2 - CORE_RAM2_BYTES

    def complaints(self) -> list[str]:
        """Why it does not fit; empty where it does."""
        found = []
        if self.image + CORE_CODE_BYTES + CORE_DATA_BYTES > FLASH_BYTES:
            found.append(f"the image of {self.image} bytes does not fit into {FLASH_BYTES} bytes of flash")
        if self.stack < STACK_BYTES:
            found.append(f"RAM1 leaves {self.stack} bytes for the stack, wanted are {STACK_BYTES}: move data to DMAMEM")
        if self.ram2_free < 0:
            found.append(f"RAM2 is over-full by {-self.ram2_free} bytes: less in DMAMEM")
        return found


def works(tool: str) -> bool:
    """Whether it is installed; the compiler not without its C++ library, which its package only recommends."""
    if shutil.which(tool) is None:
        return False
    if tool != COMPILER:
        return True
    asked = [tool, "-x", "c++", "-fsyntax-only", "-"]
    return subprocess.run(asked, input="#include <array>\n", text=True, capture_output=True).returncode == 0


def missing(tools: dict[str, str]) -> list[str]:
    """Packages of the tools that are not installed."""
    return [package for tool, package in tools.items() if not works(tool)]


def need(tools: dict[str, str]) -> None:
    if packages := missing(tools):
        print(f"[firmware] missing. Install with: sudo apt-get install {' '.join(packages)}", file=sys.stderr)
        sys.exit(TOOLS_MISSING)


def remove_of_another_place() -> None:
    """Removes what was built before the checkout was moved or mounted elsewhere: CMake would refuse it for good."""
    cache = BUILD / "CMakeCache.txt"
    if cache.exists() and f"CMAKE_HOME_DIRECTORY:INTERNAL={SOURCE}" not in cache.read_text().splitlines():
        shutil.rmtree(BUILD)


def build() -> None:
    need(COMPILER_PACKAGES)
    toolchain = SOURCE / "teensy/cortex_m7.cmake"
    configure = ["cmake", "-S", str(SOURCE), "-B", str(BUILD), "-G", "Unix Makefiles"]
    LOCK.parent.mkdir(parents=True, exist_ok=True)
    with LOCK.open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # files of tests run side by side
        remove_of_another_place()
        for command in (
            [*configure, f"-DCMAKE_TOOLCHAIN_FILE={toolchain}"],
            ["cmake", "--build", str(BUILD), "--parallel", str(os.cpu_count() or 1)],
        ):
            finished = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            if finished.returncode != 0:
                print(finished.stdout, file=sys.stderr)
                sys.exit("[firmware] the build for the Teensy failed")


def sizes_of(program: Path) -> Sizes:
    listing = subprocess.run(["arm-none-eabi-size", "-A", program], capture_output=True, text=True, check=True).stdout
    rows = (line.split() for line in listing.splitlines() if line.startswith("."))
    section = {name: int(size) for name, size, _ in rows}
    return Sizes(**{field: sum(section.get(name, 0) for name in names) for field, names in PROGRAM_SECTIONS.items()})


def report() -> bool:
    """Builds, prints a table, says what does not fit; false then."""
    build()
    print("                       flashed  code in RAM1  data in RAM1  data in RAM2   left for stack      left in RAM2")
    fits = True
    for program in sorted((BUILD / "teensy").glob("sketch_*.elf")):
        if program.stem == "sketch_run":
            continue
        sizes = sizes_of(program)
        ram1 = sizes.data + sizes.zeroed
        columns = (
            f"{sizes.image:>9} {sizes.code:>13} {ram1:>13} {sizes.ram2:>13} {sizes.stack:>16} {sizes.ram2_free:>17}"
        )
        print(f"{program.stem:<20} {columns}")
        for complaint in sizes.complaints():
            print(f"[firmware] {program.stem}: {complaint}", file=sys.stderr)
            fits = False
    print(
        "Bytes. What is left takes the Teensy's own core into account with "
        f"{CORE_CODE_BYTES // KB}, {CORE_DATA_BYTES // KB} and {CORE_RAM2_BYTES // KB} KB of code, RAM1 and RAM2."
    )
    return fits


def emulator(name: str, arguments: list[str], *options: str) -> list[str]:
    """The command that runs a program as it is built on the emulated processor."""
    program = BUILD / f"teensy/{name}.elf"
    if not program.exists():
        programs = ", ".join(sorted(path.stem for path in program.parent.glob("*.elf")))
        sys.exit(f"[firmware] no program {name}; there are {programs}")
    words = [name, *arguments]
    if any("," in word or " " in word for word in words):
        sys.exit(f"[firmware] an argument with a comma or a space cannot be handed over: {words}")
    console = ["-nographic", "-monitor", "none", "-serial", "none"]
    asking = ["-semihosting-config", ",".join(["enable=on", "target=native", *(f"arg={word}" for word in words)])]
    # The vectors lie at the start of flash, where the Teensy's boot ROM looks too.
    machine = ["-machine", "mps2-an500", "-global", "armv7m.init-nsvtor=0x60000000", "-kernel", str(program)]
    return ["qemu-system-arm", *machine, *console, *asking, *options]


def run(name: str, arguments: list[str], as_built: bool) -> int:
    """A program on the emulated processor; its output and exit code are the program's own."""
    need(QEMU_PACKAGES)
    if not as_built:
        build()
    try:
        return subprocess.run(emulator(name, arguments), timeout=RUN_LIMIT_S).returncode
    except subprocess.TimeoutExpired:
        sys.exit(f"[firmware] {name} did not end within {RUN_LIMIT_S} s")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command")
    running = commands.add_parser("run", help="run a program under QEMU")
    running.add_argument("--as-built", action="store_true", help="do not build before")
    running.add_argument("program")
    running.add_argument("arguments", nargs="*")
    arguments = parser.parse_args()
    if arguments.command == "run":
        return run(arguments.program, arguments.arguments, arguments.as_built)
    return 0 if report() else 1


if __name__ == "__main__":
    sys.exit(main())
