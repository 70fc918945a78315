# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts bench`: choosing, reporting, and what it says of a run. ROS_DOMAIN_ID 105."""

from __future__ import annotations

import json
import os
import time
from pathlib import Path

import pytest

from acts_core.errors import ActsError
from acts_tools.bench import machine, report, runner
from acts_tools.bench.registry import MEASUREMENTS, Entry
from acts_tools.bench.result import Figure, Result, shortened
from acts_tools.cli import main

pytestmark = pytest.mark.slow

REPORT = {
    "date": "2030-01-02",
    "machine": {"cores": 2, "architecture": "x86_64", "system": "Linux", "python": "3.11.0", "ros": "kilted"},
    "load_average_before": [0.5, 0.4, 0.3],
    "load_average_after": [1.5, 0.4, 0.3],
    "measurements": {
        "decode": {
            "summary": "decoding",
            "seconds": 5.0,
            "others_cpu_percent": 31.0,
            "figures": [
                {"key": "a_hz", "label": "rate", "value": 123456.7, "unit": "frames/s", "is_ratio": False},
                {"key": "b", "label": "ratio", "value": 4.5678, "unit": "times", "is_ratio": True},
                {"key": "c", "label": "unknown", "value": None, "unit": "ms", "is_ratio": False},
            ],
            "problems": ["it differs"],
        }
    },
    "problems": ["decode: it differs"],
    "warnings": ["others used the CPU"],
}


@pytest.fixture(autouse=True)
def own_domain(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "105")


def test_without_names_all_but_the_long_ones_are_chosen_and_each_once() -> None:
    entries = {"a": Entry("m", "s", 1.0), "long": Entry("m", "s", 600.0, only_by_name=True), "b": Entry("m", "s", 1.0)}
    assert runner.choose([], entries) == ["a", "b"]
    assert runner.choose(["long", "a", "long"], entries) == ["long", "a"]


def test_an_unknown_measurement_is_refused_with_the_known_ones() -> None:
    with pytest.raises(ActsError, match="no measurement 'speed'; there are: decode"):
        runner.choose(["speed"])


def test_every_measurement_can_be_loaded() -> None:
    assert all(callable(entry.load().measure) for entry in MEASUREMENTS.values())


def test_figures_are_shown_with_four_digits() -> None:
    assert [shortened(value) for value in (123456.7, 1234.5, 12.3456, 0.00123456, 3.0)] == [
        "123457",
        "1234",
        "12.35",
        "0.001235",
        "3",
    ]
    assert Figure("key", "label", None, "ms").text == "-"
    assert Figure("key", "label", 7, "").text == "7"


def test_table_and_markdown_show_figures_load_warnings_and_problems() -> None:
    text = report.table(REPORT)
    for words in ("123457 frames/s", "4.568 times", "load average 0.50 before, 1.50 after", "warning: others used"):
        assert words in text
    assert "problem: decode: it differs" in text
    marked = report.markdown(REPORT)
    assert "| ratio | **4.568 times** |" in marked
    assert "| rate | 123457 frames/s |" in marked
    assert "decode 31" in marked


def test_an_earlier_report_is_shown_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "bench.json"
    path.write_text(json.dumps(REPORT))
    assert main(["bench", "--show", str(path)]) == 1
    assert "123457 frames/s" in capsys.readouterr().out


@pytest.mark.parametrize("text", ["{", "[1, 2]", "{}", '{"measurements": 3}', '{"skins": [], "problems": []}'])
def test_what_is_no_report_is_not_shown(text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "bench.json"
    path.write_text(text)
    assert main(["bench", "--show", str(path)]) == 1
    said = capsys.readouterr()
    assert said.err.startswith(f"error: --show {path}: not a report of")
    assert said.out == ""


def test_own_work_is_not_counted_as_that_of_others() -> None:
    meter, whole = machine.OthersMeter(), machine.BusyMeter()
    begin_s, begin_cpu_s = time.monotonic(), time.process_time()
    while time.process_time() - begin_cpu_s < 0.5:
        pass
    own_percent = (time.process_time() - begin_cpu_s) / (time.monotonic() - begin_s) * 100
    others_percent, all_percent = meter.percent(), whole.percent()
    # The kernel's ticks are coarse.
    assert others_percent == pytest.approx(max(all_percent - own_percent, 0.0), abs=30)
    assert 0.0 <= others_percent <= (os.cpu_count() or 1) * 100 - own_percent + 30


def test_decoding_leaves_a_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "decode", "--seconds", "0.2", "--out", str(tmp_path)]) == 0
    written = json.loads((tmp_path / "bench.json").read_text())
    figures = {figure["key"]: figure["value"] for figure in written["measurements"]["decode"]["figures"]}
    assert all(figures[key] > 0 for key in ("frames_hz", "naive_hz", "raster_hz", "ratio"))
    assert figures["turns"] >= 3
    assert written["problems"] == []
    assert "StreamDecoder to plain Python" in capsys.readouterr().out


def test_the_report_goes_to_the_file_that_is_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "decode.json"
    words = ["--seconds", "0.2", "--json", str(path), "--out", str(tmp_path / "out")]
    assert main(["bench", "decode", *words]) == 0
    assert "decode" in json.loads(path.read_text())["measurements"]
    assert not (tmp_path / "out").exists()


class _Measurement:
    """Stands for the module of a measurement."""

    def __init__(self, error: BaseException | None = None) -> None:
        self._error = error

    def load(self) -> _Measurement:
        return self

    def measure(self, _bench: object) -> Result:
        if self._error is not None:
            raise self._error
        return Result([Figure("rate", "rate", 7, "Hz")])


def _use(monkeypatch: pytest.MonkeyPatch, **errors: BaseException | None) -> None:
    """Measurements by name, each with what it raises, in place of the real ones."""
    for name in errors:
        monkeypatch.setitem(MEASUREMENTS, name, Entry("none", name, 0.2))
        monkeypatch.setattr(Entry, "load", lambda entry: _Measurement(errors[entry.summary]))


def test_a_measurement_that_cannot_be_made_is_a_problem_and_the_others_are_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    _use(monkeypatch, first=None, broken=ActsError("no browser"), last=None)
    assert main(["bench", "first", "broken", "last", "--out", str(tmp_path)]) == 1
    written = json.loads((tmp_path / "bench.json").read_text())
    assert {name: len(one["figures"]) for name, one in written["measurements"].items()} == {
        "first": 1,
        "broken": 0,
        "last": 1,
    }
    assert written["problems"] == ["broken: no browser"]
    assert "problem: broken: no browser" in capsys.readouterr().out
    assert main(["bench", "--show", str(tmp_path / "bench.json"), "--markdown"]) == 1
    assert "Problem: broken: no browser" in capsys.readouterr().out


def test_an_interruption_keeps_what_is_finished(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    _use(monkeypatch, first=None, stopped=KeyboardInterrupt(), last=None)
    assert main(["bench", "first", "stopped", "last", "--out", str(tmp_path)]) == 130
    assert list(json.loads((tmp_path / "bench.json").read_text())["measurements"]) == ["first"]
    capsys.readouterr()
    assert main(["bench", "--show", str(tmp_path / "bench.json")]) == 0
    assert "7 Hz" in capsys.readouterr().out
