# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

import subprocess

import pytest
from core_library import installed


def test_core_on_the_host() -> None:
    # Wiring, clock, queue, framing, firmware: plain checks in C++ (core_test.cpp), the same that ctest runs.
    result = subprocess.run([installed("core_test")], capture_output=True, text=True, timeout=60)
    assert result.returncode == 0, result.stderr


@pytest.mark.parametrize("name", ["core_test", "libcore_probe.so", "sampling_digest", "sketch_binary"])
def test_programs_of_the_tests_are_none_of_the_package(name: str) -> None:
    # `ros2 pkg executables` lists what can be executed in lib/acts_firmware.
    assert installed(name).parent.parts[-3:] == ("libexec", "acts_firmware", "test")
