# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Output of processes as the real launch passes it on; its events are made up here, as it need not be installed."""

from __future__ import annotations

import importlib
import sys
from types import SimpleNamespace
from unittest.mock import MagicMock

import pytest

from acts_tools.testing.launch_runner import LaunchFile

MODULE = "acts_tools.testing.launch_pytest_backend"
REAL = ("launch", *(f"launch.{name}" for name in ("actions", "event_handlers", "events", "launch_description_sources")))


def test_a_line_in_parts_is_one_and_the_last_need_not_end(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in (*REAL, "launch_pytest"):
        monkeypatch.setitem(sys.modules, name, MagicMock())
    monkeypatch.delitem(sys.modules, MODULE, raising=False)
    backend = importlib.import_module(MODULE)
    # Not for other tests: it is made of what stands in for the real launch.
    monkeypatch.delitem(sys.modules, MODULE)
    run = backend.ServiceLaunch(LaunchFile("/it.launch.xml"))
    who = {"pid": 5, "process_name": "it-1", "action": None}
    for from_stdout, text in ((True, b"one\ntw"), (False, b"bad"), (True, b"o\nthe end")):
        run._on_output(SimpleNamespace(**who, from_stdout=from_stdout, text=text))
    assert run.output == "[it-1] one\n[it-1] two\n"
    run._on_exit(SimpleNamespace(**who, returncode=0), None)
    *_, last, error, told = run.output.splitlines()
    assert [last, error] == ["[it-1] the end", "[it-1] bad"]
    assert told.endswith("ended with exit code 0")
