# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts selftest` as a user runs it, on virtual boards with noise and broken wiring."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest

from acts_sim.shared import TimedRingReader
from acts_tools.bench.rigs.processes import virtual_board
from acts_tools.cli import main
from acts_tools.selftest.session import BoardReader
from acts_tools.selftest.simulation import SimulatedSkin

pytestmark = pytest.mark.slow

DEADLINE_S = 60.0
# Of a busy machine, not of the board.
TIMING = {"frame rate", "lost frames", "clock jitter", "clock drift", "time per taxel"}


def selftest(folder: Path, *words: str) -> tuple[int, dict[str, str], dict]:
    """Exit code, level by item, and the whole report."""
    code = main(["selftest", *words, "--json", str(folder / "a/test.json"), "--picture", str(folder / "b/test.png")])
    report = json.loads((folder / "a/test.json").read_text())
    return code, {finding["name"]: finding["level"] for finding in report["findings"]}, report


def test_a_healthy_board_passes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, levels, report = selftest(tmp_path, "--sim", "--untouched-s", "1", "--touch-s", "3")
    assert {level for name, level in levels.items() if name not in TIMING} == {"PASS"}
    assert {"open rows", "shorted columns", "multiplexer", "dead taxels", "noise", "coverage"} <= levels.keys()
    assert code == (1 if "FAIL" in levels.values() else 0)
    assert report["scheme"] == "raster"
    assert report["dead_taxels"] == ""
    assert report["timing"]["taxel_us"] == pytest.approx(17.6, rel=0.05)
    assert report["thresholds"]["high_counts"] == 60
    height, width, _ = matplotlib.image.imread(tmp_path / "b/test.png").shape
    assert height > 500
    assert width > 1000
    assert "PASS  open rows        none" in capsys.readouterr().out


def test_every_broken_wire_is_found_and_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    faults = ("open-row=5", "open-col=7", "short-rows=13,14", "short-cols=20,27", "dead=10,12", "stuck=4,4,700")
    words = [word for fault in faults for word in ("--hardware-fault", fault)]
    code, _, report = selftest(tmp_path, "--sim", *words, "--untouched-s", "1", "--touch-s", "3")
    assert code == 1
    assert not report["ok"]
    found = {finding["name"]: finding for finding in report["findings"] if finding["level"] == "FAIL"}
    assert found.keys() - TIMING == {
        "open rows", "open columns", "shorted rows", "shorted columns", "dead taxels", "stuck taxels"
    }  # fmt: skip
    assert found["open rows"]["rows"] == [5]
    assert found["open columns"]["cols"] == [7]
    assert found["shorted rows"]["rows"] == [13, 14]
    assert found["shorted columns"]["cols"] == [20, 27]
    assert found["dead taxels"]["taxels"] == [[10, 12]]
    assert found["stuck taxels"]["taxels"] == [[4, 4]]
    assert report["dead_taxels"] == "row=5 col=7 4,4 10,12"
    said = capsys.readouterr().out
    assert "FAIL  open rows        row 5 never responded" in said
    assert said.splitlines()[-2].endswith("driver and reconstruction do without: dead_taxels: 'row=5 col=7 4,4 10,12'")


def test_a_board_that_takes_no_commands_is_tested_with_what_it_sends(tmp_path: Path) -> None:
    words = ("--hardware-fault", "address-bit=2", "--protocol", "raster_ascii", "--untouched-s", "1", "--touch-s", "3")
    code, _, report = selftest(tmp_path, "--sim", *words)
    assert code == 1
    found = {finding["name"]: finding for finding in report["findings"] if finding["level"] == "FAIL"}
    assert found.keys() - TIMING == {"multiplexer"}
    assert "address bit 2 (pin 35)" in found["multiplexer"]["text"]


def test_a_board_of_another_size_than_is_given_is_told_by_the_options(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with virtual_board(tmp_path, "--protocol", "raster_ascii", "--rows", "8", "--cols", "5", "--m", "40") as board:
        assert main(["selftest", str(board.link), "--protocol", "raster_ascii", "--no-touch"]) == 1
    said = capsys.readouterr().err
    assert "is it a board of this --protocol, --rows and --cols, and is it running?" in said


def test_the_board_gets_its_settings_back_even_when_interrupted(tmp_path: Path) -> None:
    with virtual_board(tmp_path, "--scheme", "tracking", "--rate-hz", "500") as board:

        def settings() -> object:
            with BoardReader(str(board.link), "binary", 32, 32) as reader:
                state = reader.query()
            assert state is not None
            return state.settings

        own = settings()
        assert own.scheme == "tracking"  # type: ignore[attr-defined]
        process = subprocess.Popen(
            [sys.executable, "-m", "acts_tools", "selftest", str(board.link), "--untouched-s", "100"],
            stderr=subprocess.PIPE,
            env={**os.environ, "PYTHONUNBUFFERED": "1"},
        )
        assert process.stderr is not None
        try:
            assert b"leave the skin alone" in process.stderr.readline()
            process.send_signal(signal.SIGTERM)
            assert process.wait(DEADLINE_S) == 130
        finally:
            process.kill()
            process.wait()
            process.stderr.close()
        assert settings() == own


def test_a_board_that_is_unplugged_is_told_so(tmp_path: Path) -> None:
    control = tmp_path / "control"
    with virtual_board(tmp_path, "--control", str(control)) as board:
        process = subprocess.Popen(
            [sys.executable, "-m", "acts_tools", "selftest", str(board.link), "--untouched-s", "100"],
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "PYTHONUNBUFFERED": "1"},
        )
        assert process.stderr is not None
        try:
            assert "leave the skin alone" in process.stderr.readline()
            control.write_text("unplug:60\n")
            said = process.communicate(timeout=DEADLINE_S)[1]
        finally:
            process.kill()
            process.wait()
    # Not that it does not get its settings back: without power it has those that it starts with.
    assert said.startswith(f"error: port {board.link}")
    assert said.endswith("start the test again\n")
    assert process.returncode == 1


@pytest.mark.parametrize("phase", ["leave the skin alone", "now roll a hand"])
def test_of_a_board_that_falls_silent_the_skin_is_not_judged(tmp_path: Path, phase: str) -> None:
    control = tmp_path / "control"
    words = ["--protocol", "raster_ascii", "--rows", "8", "--cols", "8", "--untouched-s", "4", "--touch-s", "4"]
    with virtual_board(tmp_path, *words[:6], "--m", "64", "--control", str(control)) as board:
        process = subprocess.Popen(
            [sys.executable, "-m", "acts_tools", "selftest", str(board.link), *words],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "PYTHONUNBUFFERED": "1"},
        )
        assert process.stderr is not None
        try:
            assert any(phase in line for line in process.stderr)
            control.write_text("freeze:3600\n")
            out, said = process.communicate(timeout=DEADLINE_S)
        finally:
            process.kill()
            process.wait()
    assert "has fallen silent" in said
    assert out == ""
    assert process.returncode == 1


def test_a_board_that_is_not_touched_and_one_that_is_no_board(tmp_path: Path) -> None:
    _, levels, report = selftest(tmp_path, "--sim", "--no-touch", "--untouched-s", "1", "--rows", "8", "--cols", "5")
    assert levels["high taxels"] == "PASS"
    assert "open rows" not in levels
    assert report["response_counts"] is None
    assert len(report["noise_counts"]) == 8
    with pytest.raises(SystemExit):
        main(["selftest", "--sim", "--rows", "65"])
    assert main(["selftest", "--hardware-fault", "open-row=5"]) == 1
    assert main(["selftest", "--sim", "--hardware-fault", "open-row=40"]) == 1
    assert main(["selftest", str(tmp_path / "nothing")]) == 1


def test_a_disk_that_is_full_is_told_with_the_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--sim", "--no-touch", "--untouched-s", "1", "--rows", "8", "--cols", "5"]
    assert main(["selftest", *words, "--json", "/dev/full", "--picture", str(tmp_path / "test.png")]) == 1
    assert "error: /dev/full: cannot be written (No space left on device)\n" in capsys.readouterr().err


def test_a_simulated_hand_that_rolls_for_an_hour_fits_into_memory(tmp_path: Path) -> None:
    skin = SimulatedSkin("none", tmp_path / "field.ring")
    begin_ns = time.monotonic_ns()
    with skin.rolled(8, 8, 3600.0):
        assert skin.ring.stat().st_size < 5_000_000
        reader = TimedRingReader(skin.ring, 64)
        along_columns, along_rows = (
            [reader.sample(begin_ns + int(at_s * 1e9)) for at_s in np.linspace(from_s, to_s, 500)]
            for from_s, to_s in ((1.0, 1800.0), (1801.0, 3599.0))
        )
    for half in (along_columns, along_rows):
        pressed = np.max([field for field in half if field is not None], axis=0)
        assert pressed.min() > 100, "every taxel is rolled over"
