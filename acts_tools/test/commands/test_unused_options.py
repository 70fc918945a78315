# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Options that have no effect beside others are refused, before anything is done."""

from __future__ import annotations

from pathlib import Path

import pytest

from acts_tools.cli import main

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("view --size 16 16", "--size 16 16 has no effect without --board; leave it out"),
        ("view --protocol raster_ascii", "--protocol raster_ascii has no effect without --board"),
        ("view --bag x --baud 9600", "--baud 9600 has no effect without --board"),
        ("view --layout arm", "--layout arm has no effect without --bag, --npz or --board"),
        ("view --npz x --control", "--control has no effect on a recording"),
        ("view a b --board /dev/x", "a board is one skin; a, b are 2"),
        ("selftest --rows 16", "--rows 16 has no effect on a board that speaks binary"),
        ("selftest --sim --baud 9600", "--baud 9600 has no effect with --sim"),
        ("selftest /dev/x --sim", "/dev/x: with --sim the board is a virtual one"),
        ("selftest --no-touch --touch-s 4", "--touch-s 4.0 has no effect with --no-touch"),
        ("evaluate gait --frames x --rate 8 30", "--rate 8.0 30.0 has no effect on recorded insoles"),
        ("evaluate gait --width-m 0.1", "--width-m 0.1 has no effect without --frames"),
        ("evaluate recovery --presses 3 --peaks", "--peaks has no effect with --presses"),
        (
            "evaluate recovery --presses 3 --method acts last --set sparsity_ratio=0.1",
            "--set sparsity_ratio=0.1 has no effect with --method acts, last; leave it out",
        ),
        ("evaluate events --method acts last --dictionary x", "--dictionary x has no effect with --method acts, last"),
        ("evaluate events --method gp --patch-step 2", "--patch-step 2 has no effect with --method gp"),
        (
            "evaluate events --scheme random uniform --search-share 0.3",
            "--search-share 0.3 has no effect with the sampling of random, uniform; leave it out",
        ),
        (
            "evaluate objects --fixed-taxels 4",
            "--fixed-taxels 4 has no effect with the sampling of adaptive, uniform, random, tracking",
        ),
        ("train -o {out} --frames x --presses 4", "--presses 4 has no effect with --frames"),
        ("library -o {out} --frames x --seed 4", "--seed 4 has no effect with --frames"),
        ("export x --to csv --task grasp", "--task grasp has no effect with --to csv"),
        ("bench --show x --seconds 3", "--seconds 3.0 has no effect with --show"),
        ("bench loopback --show x", "loopback: nothing is measured with --show"),
    ],
)
def test_an_option_without_effect_is_refused(
    words: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words.format(out=f"{tmp_path}/out.npz").split()) == 1
    assert f"error: {message}" in capsys.readouterr().err
