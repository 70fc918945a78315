# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Options that are made from settings classes."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass

import pytest

from acts_core.errors import SettingsError
from acts_core.settings import setting, validate
from acts_sim.shared import add_settings, number, require_within, settings_from, whole_number


@dataclass(frozen=True)
class Config:
    """One setting of each type."""

    is_on: bool = setting(True, "whether 100 % are on")
    steps: int = setting(3, "steps", minimum=1, maximum=9)
    lead_ms: float = setting(4.0, "lead [ms]", minimum=0.0)
    cores: str = setting("", "cores")
    q_rad: tuple[float, ...] = setting((0.0, 0.0), "angles [rad]", length=2)

    def __post_init__(self) -> None:
        validate(self)


def read(*words: str) -> Config:
    parser = argparse.ArgumentParser()
    parser.add_argument("--other", type=int)
    add_settings(parser, Config)
    return settings_from(parser.parse_args(words), Config)


def test_each_setting_has_an_option() -> None:
    assert read("--other", "1") == Config()
    given = read("--is-on", "false", "--steps", "4", "--lead-ms", "1e-3", "--cores", "0,2-3", "--q-rad", "0.1, -2")
    assert given == Config(False, 4, 1e-3, "0,2-3", (0.1, -2.0))


@pytest.mark.parametrize("words", ["--steps 10", "--steps 1.5", "--is-on 1", "--lead-ms nan", "--q-rad 1"])
def test_what_does_not_fit_is_refused_by_its_name(words: str) -> None:
    option, value = words.split()
    with pytest.raises(SettingsError, match=option[2:].replace("-", "_")):
        read(option, value)


def test_help_says_what_is_allowed(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        read("--help")
    told = " ".join(capsys.readouterr().out.split())
    assert "--steps VALUE steps (1 to 9); 3" in told
    assert "whether 100 % are on; True" in told
    assert "--cores VALUE cores --q-rad" in told


@pytest.mark.parametrize(("kind", "allowed"), [(whole_number, "a whole number"), (number, "a number")])
def test_a_word_that_is_no_number_is_refused_with_what_is_allowed(
    kind: Callable[[str], float], allowed: str, capsys: pytest.CaptureFixture[str]
) -> None:
    parser = argparse.ArgumentParser(prog="simulated")
    parser.add_argument("--motors", type=kind)
    assert parser.parse_args(["--motors", "16"]).motors == 16
    with pytest.raises(SystemExit):
        parser.parse_args(["--motors", "2x"])
    assert f"simulated: error: argument --motors: 2x: allowed is {allowed}\n" in capsys.readouterr().err


def test_an_option_out_of_its_range_is_refused_with_what_is_allowed(capsys: pytest.CaptureFixture[str]) -> None:
    parser = argparse.ArgumentParser(prog="simulated")
    parser.add_argument("--lead-ms", type=float)
    for text in ("2", "20"):
        require_within(parser, parser.parse_args(["--lead-ms", text]), lead_ms=(2.0, 20.0))
    for text in ("1.9", "20.1", "nan"):
        with pytest.raises(SystemExit):
            require_within(parser, parser.parse_args(["--lead-ms", text]), lead_ms=(2.0, 20.0))
        assert f"simulated: error: --lead-ms {text}: allowed is 2.0 to 20.0\n" in capsys.readouterr().err
