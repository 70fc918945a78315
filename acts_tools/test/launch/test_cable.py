# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The cable between two machines: what it delays, loses and counts; on pipes, without any namespace."""

from __future__ import annotations

import os
import socket
import time
from collections.abc import Iterator

import pytest

from acts_tools.bench.cases.link import CONTACT, _Link
from acts_tools.listen.arrivals import Interval
from acts_tools.two_machines.cable import Cable
from acts_tools.two_machines.conditions import Conditions
from acts_tools.two_machines.listener import Report


@pytest.fixture
def ends() -> Iterator[tuple[Cable, socket.socket, socket.socket]]:
    """A cable, and the machines' sides of both of its ends."""
    near, near_tap = socket.socketpair(type=socket.SOCK_DGRAM)
    far, far_tap = socket.socketpair(type=socket.SOCK_DGRAM)
    for side in (near, far, near_tap, far_tap):
        side.setblocking(False)
    yield Cable([near_tap.fileno(), far_tap.fileno()]), near, far
    for side in (near, far, near_tap, far_tap):
        side.close()


def received(side: socket.socket) -> list[bytes]:
    frames = []
    while True:
        try:
            frames.append(os.read(side.fileno(), 65536))
        except BlockingIOError:
            return frames


def test_frames_come_out_at_the_other_end_in_order(ends: tuple[Cable, socket.socket, socket.socket]) -> None:
    cable, near, far = ends
    near.send(b"one")
    near.send(b"three")
    far.send(b"back")
    assert cable.carry() is None
    assert (received(far), received(near)) == ([b"one", b"three"], [b"back"])
    assert [(traffic.frames, traffic.sent_bytes) for traffic in cable.traffic] == [(2, 8), (1, 4)]


def test_a_delay_is_kept(ends: tuple[Cable, socket.socket, socket.socket]) -> None:
    cable, near, far = ends
    cable.conditions = Conditions(delay_s=0.05)
    sent_s = time.monotonic()
    near.send(b"late")
    frames: list[bytes] = []
    while not frames:
        wait_s = cable.carry()
        assert wait_s is None or wait_s <= 0.05
        frames = received(far)
    assert frames == [b"late"]
    assert time.monotonic() - sent_s >= 0.05


def test_loss_and_cut_are_counted(ends: tuple[Cable, socket.socket, socket.socket]) -> None:
    cable, near, far = ends
    cable.conditions = Conditions(loss=0.25)
    arrived = 0
    for _ in range(400):
        near.send(b"x")
        cable.carry()
        arrived += len(received(far))
    assert 60 < cable.traffic[0].dropped < 140
    assert arrived + cable.traffic[0].dropped == 400
    cable.conditions = Conditions(cut=True)
    near.send(b"x")
    far.send(b"x")
    cable.carry()
    assert received(far) == received(near) == []
    assert cable.traffic[1].dropped == 1


def test_the_age_of_contacts_is_the_middle_of_all_reports() -> None:
    link = _Link(None, None, 0)  # type: ignore[arg-type]
    ages_ms = (9.0, 1.0, 4.0, 2.0)
    link._add_contacts(
        "good", "good cable", [Report({CONTACT: Interval(1.0, 9, 1, ms, ms, 9, 1, 0.0, False)}, {}) for ms in ages_ms]
    )
    assert {figure.key: figure.value for figure in link.figures} == {
        "good.lost_percent": 10.0,
        "good.age_ms": 3.0,
        "good.largest_age_ms": 9.0,
    }
