# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Numbers on the command line that are not allowed: refused in words, by every command that takes them."""

from __future__ import annotations

import argparse
from pathlib import Path

import pytest

from acts_tools.arguments import real, whole
from acts_tools.cli import main

EVALUATIONS = (
    "classification",
    "edges",
    "events",
    "gait",
    "impacts",
    "objects",
    "outlines",
    "ricochet",
    "spectra",
    "wearables",
)


@pytest.mark.parametrize(
    ("words", "allowed"),
    [
        ("bench decode --seconds 0.1", "a number from 0.2 to 3600"),
        ("bench decode --seconds 99999", "a number from 0.2 to 3600"),
        ("bench decode --seconds nan", "a number from 0.2 to 3600"),
        ("bench skins --load -1", "a whole number from 0 to 64"),
        ("bench skins --skins 0", "a whole number from 1 to 16"),
        ("bench skins --skins 17", "a whole number from 1 to 16"),
        ("demo ball_balancing --realtime-priority 100", "a whole number from 0 to 99"),
        ("demo ball_balancing --seconds 1", "a number from 5 to 600"),
        ("diagnostics --timeout 0", "0.001 or more"),
        ("diagnostics --watch nan", "0.001 or more"),
        ("echo /cop -n 0", "1 or more"),
        ("echo /cop -d 0", "0.001 or more"),
        ("echo /cop -d nan", "0.001 or more"),
        ("evaluate hand --scenario slip --rate-hz 5", "a number from 10 to 500"),
        ("evaluate hand --scenario slip --seed -1", "a whole number from 0 to 9223372036854775807"),
        ("evaluate hand --scenario slip --seeds 0", "a whole number from 1 to 10000"),
        ("evaluate slip-sampled --hold-s 1e308", "a number from 0 to 1e+06"),
        ("evaluate wearables --minutes 1e308", "a number from 0 to 1e+06"),
        ("listen /cop --every 0", "0.05 or more"),
        ("listen /cop --every inf", "0.05 or more"),
        ("listen /cop --every nan", "0.05 or more"),
        ("listen /cop -d 0", "0.001 or more"),
        ("listen /cop -d inf", "0.001 or more"),
        ("play any --delay nan", "0 or more"),
        ("play any --rate 0", "0.001 or more"),
        ("play any --start-offset -1", "0 or more"),
        ("record -a -d -1", "0.001 or more"),
        ("train -o any.npz --patches 1", "a whole number from 2 to 1000000"),
        ("train -o any.npz --presses 0", "a whole number from 1 to 1000000"),
        ("train -o any.npz --seed -1", "a whole number from 0 to 9223372036854775807"),
    ],
)
def test_it_is_told_what_is_allowed(
    words: str, allowed: str, capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as end:
        main(words.split())
    assert end.value.code == 2
    assert f": {words.split()[-1]}: allowed is {allowed}\n" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "words",
    [
        *(["evaluate", name, "--seed", "-1"] for name in EVALUATIONS),
        *(["evaluate", name, "--seeds", "0"] for name in ("gait", "impacts", "slip-sampled", "wearables")),
        ["evaluate", "impacts", "--m", "0"],
        *(
            ["evaluate", name, "--m", "64", "1025"]
            for name in ("impacts", "objects", "outlines", "slip-sampled", "spectra")
        ),
        *(["evaluate", name, "--m", "1025"] for name in ("ricochet", "wearables")),
        *(["evaluate", name, "--noise-counts", "101"] for name in ("impacts", "wearables")),
        ["evaluate", "impacts", "--touch-ms", "0"],
        ["evaluate", "impacts", "--touch-ms", "500"],
        ["evaluate", "recovery", "--presses", "1", "--search-counts", "1024"],
        ["evaluate", "ricochet", "--speeds", "1", "nan"],
        ["evaluate", "spectra", "--noise-counts", "-1"],
        ["evaluate", "gait", "--rate", "0"],
        ["evaluate", "slip", "--frames", "any.npz", "--pitch-m", "nan"],
        ["figures", "4E", "--seed", "-1"],
        ["demo", "hand", "--seed", "-1"],
        ["library", "-o", "any.npz", "--seed", "x"],
        ["library", "-o", "any.npz", "--touch-counts", "1023"],
        ["evaluate", "classification", "--miss-deg", "5x"],
        ["evaluate", "recovery", "--presses", "1", "--fixed-row", "4x"],
        ["evaluate", "recovery", "--presses", "1", "--search-share", "half"],
        ["evaluate", "recovery", "--presses", "1", "--touch-counts", "6.5"],
        ["evaluate", "slip", "--frames", "any.npz", "--slip-min-counts", "5x"],
        ["export", "any", "--to", "csv", "--rate", "fast"],
        ["train", "-o", "any.npz", "--atoms", "1e3"],
        ["view", "--baud", "fast"],
        ["view", "--port", "22x"],
        ["view", "--size", "32", "32x"],
        ["view", "--size", "32", "65"],
    ],
    ids=" ".join,
)
def test_a_number_out_of_range_is_refused(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(words)
    assert end.value.code == 2
    assert f"{words[-1]}: allowed is " in capsys.readouterr().err


def test_an_option_is_not_taken_for_another_that_begins_alike(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    with pytest.raises(SystemExit):
        main(["evaluate", "slip-sampled", "--seed", "3", "--json", str(tmp_path / "out.json")])
    assert "unrecognized arguments: --seed 3" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "name"),
    [
        ("evaluate hand --scenario slip --set", "grip_force_n"),
        ("evaluate recovery --presses 1 --set", "sparsity_ratio"),
        ("evaluate slip-sampled --set", "slip_hold_s"),
    ],
)
def test_settings_without_name_or_value_are_refused(words: str, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    for word in (name, "=5"):
        try:
            code = main([*words.split(), word])
        except SystemExit as end:
            code = int(str(end.code))
        assert code in (1, 2)
        assert f"'{word}': needed is NAME=VALUE\n" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "lacking"), [("param", "NODE"), ("launch", "PACKAGE"), ("driver", "what"), ("pub", "TOPIC, TYPE")]
)
def test_of_words_that_are_lacking_only_those_are_told_that_are_needed(
    name: str, lacking: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        main([name])
    assert f"the following arguments are required: {lacking}\n" in capsys.readouterr().err


@pytest.mark.parametrize("word", ["", "x", "1.5", "0", "65", "-1", "nan"])
def test_whole_numbers_have_a_range(word: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="allowed is a whole number from 1 to 64"):
        whole(1, 64)(word)


@pytest.mark.parametrize("word", ["", "x", "0.4", "inf", "nan", "-1"])
def test_real_numbers_have_a_range_and_are_finite(word: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match=r"allowed is 0\.5 or more"):
        real(0.5)(word)
    assert real(0.5, 0.5)("0.5") == 0.5
