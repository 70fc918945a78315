# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Poses, and the two text ports of the simulated controller."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_sim.shared import LineSession
from acts_sim.ur import Controller, RuntimeState, UrControllerConfig
from acts_sim.ur.ports import ScriptSession
from acts_sim.ur.ports.script import ScriptReader
from acts_sim.ur.pose import pose_from_transform, transform_from_pose


@settings(deadline=None)
@given(st.lists(st.floats(-1.8, 1.8), min_size=6, max_size=6))
def test_pose_and_transform_are_inverse(pose: list[float]) -> None:
    transform = transform_from_pose(pose)
    assert transform_from_pose(pose_from_transform(transform)) == pytest.approx(transform, abs=1e-9)
    if np.linalg.norm(pose[3:]) < math.pi - 1e-3:
        assert pose_from_transform(transform) == pytest.approx(pose, abs=1e-7)


@pytest.mark.parametrize("axis", [[1, 0, 0], [0, 1, 0], [0, 0, -1], [0.6, -0.8, 0], [0.48, 0.6, -0.64]])
def test_half_turns(axis: list[float]) -> None:
    transform = transform_from_pose([0.0, 0.0, 0.0, *(math.pi * value for value in axis)])
    assert transform_from_pose(pose_from_transform(transform)) == pytest.approx(transform, abs=1e-9)


PROGRAM = b"def rtde_control():\n    global reg_offset_int = # int register offset\n24\n    x = 1\n\nend\n"


@settings(deadline=None)
@given(st.binary(max_size=60), st.lists(st.integers(0, len(PROGRAM)), max_size=5))
def test_programs_are_found_in_any_pieces(before: bytes, cuts: list[int]) -> None:
    stream = before.replace(b"end", b"") + b"\n" + PROGRAM
    edges = [0, *sorted(cuts), len(stream)]
    reader, found = ScriptReader(), []
    for start, end in itertools.pairwise(edges):
        found += reader.feed(stream[start:end])
    assert len(found) == 1
    assert found[0] == ("rtde_control", PROGRAM)


def test_control_script_is_started_with_its_offset_and_others_are_refused() -> None:
    log: list[str] = []
    controller = Controller(UrControllerConfig(start_delay_s=0.002), log.append)
    session = ScriptSession(controller)
    session.receive(b"def dance():\n  movej([0,0,0,0,0,0])\nend\n")
    controller.tick()
    controller.tick()
    before = controller.runtime
    assert "'dance' not started" in log[-1]
    session.receive(PROGRAM)
    controller.tick()
    controller.tick()
    assert (before, controller.runtime) == (RuntimeState.STOPPED, RuntimeState.PLAYING)
    assert controller.output.get("output_int_register_24") == (1,)
    session.receive(b"x" * 2_000_000)
    session.receive(PROGRAM.replace(b"\n24\n", b"\n7\n"))
    assert "offset 7" in log[-1]
    session.receive(PROGRAM.replace(b"\n24\n", b"\n" + b"9" * 5000 + b"\n"))
    assert "offset 99999999..." in log[-1]
    assert len(log[-1]) < 200


@settings(deadline=None)
@given(st.binary(max_size=500))
def test_lines_are_answered_one_by_one(data: bytes) -> None:
    session = LineSession(lambda line: f"<{line}>", "hello")
    assert session.greeting == b"hello\n"
    assert session.receive(data).count(b"\n") == data.count(b"\n")


@pytest.mark.parametrize("piece_bytes", [1, 4096, 100_000])
def test_a_line_that_is_too_long_is_answered_with_an_error_and_not_carried_out(piece_bytes: int) -> None:
    done = []

    def answer(line: str) -> str:
        done.append(line)
        return "ok"

    session = LineSession(answer)
    sent = b"stop\n" + b"x" * 5000 + b" stop\n" + b"y" * 4096 + b"\nplay\n"
    received = b"".join(session.receive(sent[k : k + piece_bytes]) for k in range(0, len(sent), piece_bytes))
    replies = received.decode().splitlines()
    assert done == ["stop", "y" * 4096, "play"]
    assert replies[:1] + replies[2:] == ["ok", "ok", "ok"]
    assert replies[1] == "error: the line is longer than 4096 bytes; nothing was done"


def test_a_line_without_end_does_not_pile_up() -> None:
    session = LineSession(lambda line: str(len(line)))
    for _ in range(10):
        assert session.receive(b"x" * 4000) == b""
    assert session.receive(b"y\n").count(b"\n") == 1
