# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Work on threads of its own, also at the end of the process."""

from __future__ import annotations

import subprocess
import sys
import threading

import pytest

from acts_core.errors import SettingsError
from acts_core.runtime import background

# A program that ends while its work goes on.
_BEGIN = """
import threading, time
import numpy as np
from acts_core.runtime import background
values = np.arange(2000) % 1000
begun = threading.Event()
def sort():
    begun.set()
    until_s = time.monotonic() + {seconds}
    while time.monotonic() < until_s:
        np.unique(values)
    print("sorted", flush=True)
def hang():
    begun.set()
    threading.Event().wait()
background.begin({work})
begun.wait()
"""


@pytest.mark.parametrize(
    ("work", "seconds", "told"),
    [("sort", 0.2, "sorted\n"), ("sort, ends_within_s=60.0", 1.0, "sorted\n"), ("hang", 0.0, "")],
)
def test_a_process_ends_orderly_while_work_goes_on(work: str, seconds: float, told: str) -> None:
    command = [sys.executable, "-c", _BEGIN.format(work=work, seconds=seconds)]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=60.0, check=False)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, told, "")


def test_results_and_errors_come_back() -> None:
    assert background.begin(lambda: 3).result(10.0) == 3
    assert isinstance(background.begin(lambda: 1 // 0).exception(10.0), ZeroDivisionError)


def test_what_takes_too_long_is_given_up() -> None:
    go_on = threading.Event()
    with pytest.raises(SettingsError, match=r"reading takes longer than 0\.5 s"):
        background.within_patience(go_on.wait, SettingsError, "reading")
    go_on.set()
    assert background.within_patience(lambda: 4, SettingsError, "counting") == 4
