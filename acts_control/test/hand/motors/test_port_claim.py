# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Ports as one program's own: pseudo-terminals, whose numbers are given again."""

from __future__ import annotations

import os
import pty
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from acts_control.hand.motors import HandError
from acts_control.hand.motors.port_claim import PortClaim

_DEADLINE_S = 30.0


@contextmanager
def terminal() -> Iterator[str]:
    """A new pseudo-terminal, by its path."""
    master, slave = pty.openpty()
    try:
        yield os.ttyname(slave)
    finally:
        os.close(slave)
        os.close(master)


@pytest.mark.parametrize("by_link", [False, True])
def test_the_number_of_a_terminal_that_is_gone_is_left_to_the_next(tmp_path: Path, by_link: bool) -> None:
    """As two simulated hands have it, of which one is unplugged."""
    link = tmp_path / "hand"
    end_s = time.monotonic() + _DEADLINE_S
    while True:
        with terminal() as first:
            link.unlink(missing_ok=True)
            link.symlink_to(first)
            waiting = PortClaim(str(link) if by_link else first)
            waiting.take()
            made_ns = later_ns = Path(first).stat().st_ctime_ns
            while later_ns == made_ns:  # a clock that goes in steps of some milliseconds
                with terminal() as later:
                    later_ns = Path(later).stat().st_ctime_ns
        with terminal() as second:
            if second == first:
                newcomer = PortClaim(second)
                newcomer.take()
                newcomer.close()
        waiting.close()
        if second == first:
            return
        # Another program took the number meanwhile.
        assert time.monotonic() < end_s, "no second terminal got the number of the first"


def test_a_terminal_that_is_written_to_and_opened_again_stays_the_same(tmp_path: Path) -> None:
    with terminal() as device:
        (tmp_path / "hand").symlink_to(device)
        claim = PortClaim(str(tmp_path / "hand"))
        claim.take()
        fd = os.open(device, os.O_RDWR | os.O_NOCTTY)
        os.write(fd, b"goal\n")
        os.close(fd)
        for name in (device, str(tmp_path / "hand")):
            with pytest.raises(HandError, match="is held by"):
                PortClaim(name).take()
        claim.take()
        claim.close()
        PortClaim(device).take()


def test_a_port_of_a_long_name_is_claimed_and_is_not_that_of_another_with_the_same_beginning(tmp_path: Path) -> None:
    deep = tmp_path / "a_folder_for_the_runs_of_a_day" / ("x" * 100)
    first, second = (PortClaim(str(deep / name)) for name in ("left", "right"))
    first.take()
    second.take()
    with pytest.raises(HandError, match="is held by"):
        PortClaim(str(deep / "left")).take()
    first.close()
    PortClaim(str(deep / "left")).take()
    second.close()


def test_a_port_that_is_not_there_is_claimed_by_its_name(tmp_path: Path) -> None:
    (tmp_path / "hand").symlink_to("/dev/pts/4000000")
    claim = PortClaim(str(tmp_path / "hand"))
    claim.take()
    with pytest.raises(HandError, match="is held by"):
        PortClaim(str(tmp_path / "hand")).take()
    claim.close()
