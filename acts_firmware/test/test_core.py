import subprocess

from core_library import installed


def test_core_on_the_host() -> None:
    # Wiring, clock, queue, framing, firmware: plain checks in C++ (core_test.cpp), the same that ctest runs.
    result = subprocess.run([installed("core_test")], capture_output=True, text=True, timeout=60)
    assert result.returncode == 0, result.stderr
