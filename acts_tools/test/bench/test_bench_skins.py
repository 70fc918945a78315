# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts bench skins` without processes: its options, what it counts, and what it makes of figures."""

from __future__ import annotations

import copy
import io
import json
import time
from pathlib import Path
from typing import Any

import pytest

from acts_msgs.msg import Contact
from acts_tools.bench.skins import judgement, table
from acts_tools.bench.skins.status_line import StatusLine
from acts_tools.bench.skins.stream import ContactStream
from acts_tools.cli import main


def skin(name: str, **changed: Any) -> dict[str, Any]:
    latency_ms = {"median": 0.3, "p99": 0.9, "p999": 2.0, "max": 3.5}
    driver = dict.fromkeys(("lost", "overruns", "crc_errors", "restarts"), 0)
    values = {"received": 10000, "rate_hz": 1000.0, "lost": 0, "silent_s": 0.0}
    return {
        "name": name,
        **values,
        "latency_ms": latency_ms,
        "driver": driver,
        "reconstruction": {"not_published": 0},
        **changed,
    }


def report(*skins: dict[str, Any], **changed: Any) -> dict[str, Any]:
    cpu_percent = {"bench": 15.0}
    for one in skins:
        cpu_percent |= {f"virtual_board {one['name']}": 3.0, f"tactile {one['name']}": 19.0}
    made: dict[str, Any] = {
        "date": "2030-01-02",
        "machine": {"cores": 2, "architecture": "x86_64", "system": "Linux", "python": "3.11.0", "ros": "kilted"},
        "load_average_before": [0.5, 0.4, 0.3],
        "load_average_after": [1.5, 0.4, 0.3],
        "settings": {"rate_hz": 1000.0, "m": 55},
        "load": 0,
        "realtime": "off",
        "seconds": 10.0,
        "skins": list(skins),
        "cpu_percent": cpu_percent,
        "others_cpu_percent": 2.0,
        "rss_mb": {name: {"start": 100.0, "end": 101.0, "growth_mb_per_h": None} for name in cpu_percent},
        "realtime_granted": dict.fromkeys(cpu_percent, 0),
        **changed,
    }
    made["cpu_percent_total"] = judgement.total_percent(made)
    for name in ("verdict", "problems", "warnings"):
        made[name] = getattr(judgement, name)(made)
    return made


def contact(sequence: int, age_s: float) -> Contact:
    message = Contact(sequence=sequence)
    stamp_ns = time.time_ns() - round(age_s * 1e9)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp_ns, 10**9)
    return message


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["skins", "latency"], "skins is measured by itself; leave out latency"),
        (["latency", "--skins", "2"], "--skins is an option of `acts bench skins` only"),
        (["--load", "2"], "--load is an option of `acts bench skins` only"),
        (["latency", "--realtime", "off"], "--realtime is an option of `acts bench skins` only"),
        (["speed"], "there is no measurement 'speed'"),
    ],
)
def test_wrong_arguments_are_refused_in_words(
    words: list[str], told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["bench", *words, "--json", str(tmp_path / "out.json")]) == 1
    assert told in capsys.readouterr().err
    assert not (tmp_path / "out.json").exists()


def test_a_file_that_cannot_be_written_is_told_before_the_work(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["bench", "skins", "--json", str(tmp_path)]) == 1
    assert "cannot be written" in capsys.readouterr().err
    (tmp_path / "file").touch()
    assert main(["bench", "decode", "--json", str(tmp_path / "file" / "out.json")]) == 1
    assert "--json" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["--skins", "two"], ["--realtime", "maybe"]])
def test_words_that_are_no_numbers_or_choices_are_refused_by_the_parser(words: list[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["bench", "skins", *words])
    assert ended.value.code == 2


def test_a_stream_counts_from_its_beginning_and_sums_up_latencies() -> None:
    stream = ContactStream()
    for sequence in (5, 9):
        stream.take(contact(sequence, 5.0))
    assert stream.ever_received == 2
    stream.begin(100.0)
    assert (stream.received, stream.lost) == (0, 0)
    for sequence in (10, 11, 14):
        stream.take(contact(sequence, 0.010))
    assert (stream.received, stream.lost) == (3, 2)
    assert stream.look(102.0) == pytest.approx(1.5)
    assert stream.silent_s == 0.0
    assert stream.look(104.0) == 0.0
    assert stream.silent_s == pytest.approx(2.0)
    latency_ms = stream.take_latencies_ms()
    assert list(latency_ms) == ["median", "p99", "p999", "max"]
    values = [value for value in latency_ms.values() if value is not None]
    assert values == sorted(values)
    assert values[0] >= 9.999
    assert set(stream.take_latencies_ms().values()) == {None}


def test_lost_frames_and_silence_are_problems_and_slowness_is_none() -> None:
    assert report(skin("skin_1", latency_ms={"median": 50.0, "p99": 90.0, "p999": 95.0, "max": 99.0}))["problems"] == []
    lost = skin("skin_1", lost=9, driver={"lost": 5, "overruns": 3}, reconstruction={"not_published": 2})
    assert report(lost)["problems"] == [
        "skin_1: 9 frames lost (5 before the driver, 3 of them dropped by the board; 2 late and left out by the "
        "reconstruction for newer ones; 2 between them and the subscriber)"
    ]
    assert report(skin("skin_1", lost=2))["problems"] == ["skin_1: 2 frames lost (2 between them and the subscriber)"]
    silent = report(skin("skin_1"), skin("skin_2", silent_s=4.0), skin("skin_3", received=0))
    assert silent["problems"] == [
        "skin_2: nothing was received in the last 4 s",
        "skin_3: nothing was received",
    ]
    damaged = skin("skin_1", driver={"lost": 0, "overruns": 0, "crc_errors": 2})
    assert report(damaged)["problems"] == ["skin_1: the driver counted 2 crc_errors on an undisturbed line"]


def test_what_spoils_the_figures_is_a_warning() -> None:
    assert report(skin("skin_1"))["warnings"] == []
    assert "others used the CPU" in report(skin("skin_1"), others_cpu_percent=40.0)["warnings"][0]
    assert "skin_1 800" in report(skin("skin_1", rate_hz=800.0))["warnings"][0]
    granted = {"bench": 35, "virtual_board skin_1": 45, "tactile skin_1": 0, "load 1": 0}
    refused = report(skin("skin_1"), realtime="on", realtime_granted=granted)
    assert refused["warnings"] == [
        "not in real time, as the kernel did not grant it or took it away: tactile skin_1",
    ]
    memory = {name: {"start": 1.0, "end": 9.0, "growth_mb_per_h": 60.0} for name in ("bench", "tactile skin_1")}
    assert judgement.warnings({**report(skin("skin_1")), "rss_mb": memory}) == [
        "the memory of tactile skin_1 grows by 60.0 MB an hour"
    ]


def test_the_verdict_compares_with_what_is_wanted_of_one_skin_and_of_four() -> None:
    assert report(skin("skin_1"))["verdict"] == [
        "driver and reconstruction: 19 % of a core, wanted at most 20: met",
        "latency, median: 0.3 ms, wanted at most 0.35: met",
        "latency, 99 % within: 0.9 ms, wanted at most 1: met",
    ]
    slow = skin("skin_4", lost=1, latency_ms={"median": 1.0, "p99": 7.0, "p999": 8.0, "max": 9.0})
    assert report(skin("skin_1"), slow)["verdict"] == [
        "frames lost: 1, wanted 0: not met",
        "largest 99 % within: 7 ms, wanted at most 5: not met",
    ]
    assert report(skin("skin_1"), load=4)["verdict"] == []
    assert report(*(skin(f"skin_{number}") for number in range(1, 6)))["verdict"] == []


def test_the_table_names_skins_processes_and_conditions(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = report(skin("skin_1"), skin("skin_2", lost=3, driver={"lost": 3, "overruns": 0}), load=1)
    made["cpu_percent"]["load 1"] = 99.0
    made["rss_mb"]["load 1"] = {"start": 8.0, "end": 8.0, "growth_mb_per_h": None}
    assert judgement.total_percent(made) == pytest.approx(59.0)
    text = table.table(made)
    for words in ("2 skins, 1000 frames/s, M = 55, 10 s, 1 busy loop beside, ordinary", "tactile skin_2", "problem: "):
        assert words in text
    marked = table.markdown(made)
    assert "| skin_1 | 1000.0 | 0 | 0 | 0 | 0.3 | 0.9 | 2 | 3.5 |" in marked
    path = tmp_path / "report.json"
    path.write_text(json.dumps(made))
    assert main(["bench", "--show", str(path)]) == 1
    assert "tactile skin_2" in capsys.readouterr().out
    nothing = copy.deepcopy(made)
    nothing["skins"][0]["latency_ms"] = dict.fromkeys(("median", "p99", "p999", "max"))
    assert table.table(nothing)


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_the_line_is_shown_on_a_terminal_only() -> None:
    for stream, is_shown in ((Terminal(), True), (io.StringIO(), False)):
        line = StatusLine(60.0, stream)
        line.show(3.01, {"skin_1": 999.6, "skin_2": 1000.0}, {"skin_1": 2, "skin_2": 1})
        assert ("3 of 60 s: skin_1 1000/s, skin_2 1000/s; 3 lost" in stream.getvalue()) == is_shown
        line.clear()
        assert stream.getvalue().endswith("\r\033[K") == is_shown
