# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The Arduino builder, which compiles all of src/, builds what CMake builds and the tests test."""

import re
from pathlib import Path

FIRMWARE = Path(__file__).resolve().parents[2]


def test_cmake_lists_every_source_of_the_core() -> None:
    text = (FIRMWARE / "CMakeLists.txt").read_text()
    (core,) = re.findall(r"^add_library\(acts_firmware_core STATIC$(.*?)^\)$", text, re.MULTILINE | re.DOTALL)
    (schemes,) = re.findall(r"^file\(GLOB SCHEMES .*/(src/\S+)\)$", text, re.MULTILINE)
    assert "${SCHEMES}" in core
    listed = [str(path.relative_to(FIRMWARE)) for path in FIRMWARE.glob(schemes)] + re.findall(r"src/\S+\.cpp", core)
    assert sorted(listed) == sorted(str(path.relative_to(FIRMWARE)) for path in FIRMWARE.glob("src/**/*.cpp"))


def test_it_is_released_with_the_package() -> None:
    version = re.search(r"<version>(.+)</version>", (FIRMWARE / "package.xml").read_text())
    assert version is not None
    assert f"version={version[1]}" in (FIRMWARE / "library.properties").read_text().splitlines()


def test_the_builder_finds_library_and_sketch() -> None:
    assert "includes=acts_firmware.hpp" in (FIRMWARE / "library.properties").read_text().splitlines()
    assert (FIRMWARE / "src/acts_firmware.hpp").exists()
    for sketch in FIRMWARE.glob("examples/**/*.ino"):
        assert sketch.stem == sketch.parent.name  # or the Arduino IDE refuses it
