# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Every fault of the virtual board against the driver: what is published, what is counted, when frames flow again.

With `-s` it prints the figures of `docs/faults.md`; ACTS_LONG_FAULTS=1 adds the stalls of seconds.
"""

from __future__ import annotations

import itertools
import os
import random
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import pytest
from faulty_board import FaultyBoard, PlainDriver
from pty_board import wait_for

pytestmark = pytest.mark.slow

_HARMLESS = {"frames", "bytes_discarded", "partial"}


@dataclass(frozen=True)
class Case:
    """A fault and its consequences.

    Attributes
    ----------
    fault : str
        As the virtual board takes it.
    counted : str
        Counters that must grow.
    may_count : str
        Counters that may.
    lost : int or None
        Most frames that may be lost besides what the board says it dropped; None where the board measured on.
    ends : str
        What ends a lasting fault, after half a second.
    """

    fault: str
    counted: str = ""
    may_count: str = ""
    lost: int | None = 0
    ends: str = ""


DAMAGE = "crc_errors malformed"
CASES = [
    Case("unplug:0.3", "reconnects lost", lost=None),
    Case("reset:0", "restarts clock_resets", may_count=DAMAGE),
    Case("reset:0.3", "restarts reconnects clock_resets"),
    Case("stall:0.01"),
    Case("stall:0.1"),
    Case("stall:1", "overruns lost"),
    Case("freeze:0.01"),
    Case("freeze:0.1"),
    Case("jump:10", "clock_resets"),
    Case("jump:-2", "clock_resets"),
    Case("garbage:100", may_count=f"{DAMAGE} lost", lost=1),
    Case("garbage:20000", "malformed", may_count=f"{DAMAGE} lost", lost=1),
    Case("flip:1", "lost", may_count=DAMAGE, lost=2),
    Case("flip:20", "lost", may_count=DAMAGE, lost=2),
    Case("flip-rate:0.0001", "lost", may_count=DAMAGE, lost=1000, ends="flip-rate:0"),
    Case("drop:5", "lost", lost=5),
    Case("double:5", "repeated"),
    Case("truncate:5", "lost", may_count=DAMAGE, lost=5),
    Case("lose:1000", "lost", may_count=DAMAGE, lost=5),
    Case("version:2", "malformed lost", lost=None, ends="version:1"),
]
LONG = [
    Case("unplug:2", "reconnects lost", lost=None),
    Case("reset:2", "restarts reconnects clock_resets"),
    Case("freeze:1"),
    Case("stall:5", "overruns lost"),
    Case("freeze:5"),
]
if os.environ.get("ACTS_LONG_FAULTS"):
    CASES += LONG


@pytest.fixture(scope="module")
def table() -> Iterator[list[str]]:
    rows: list[str] = []
    yield rows
    print("\n| fault | published | counted | longest gap | first frame after the end |\n|---|---|---|---|---|")
    print("\n".join(rows))


@pytest.fixture
def board(tmp_path: Path) -> Iterator[FaultyBoard]:
    with FaultyBoard(tmp_path, "--scheme", "random") as board:
        yield board


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.fault)
def test_a_fault(board: FaultyBoard, table: list[str], case: Case) -> None:
    with PlainDriver(board) as driver:
        if case.fault.startswith("unplug"):
            # Of a board that has only just been started, a machine that stands still makes one that was restarted.
            driver.wait_for_fresh_frames(after_ns=board.field_epoch_ns + 1_000_000_000)
        before, published_before = driver.totals(), len(driver.published)
        begin_ns = time.monotonic_ns()
        board.inject(case.fault)
        board.event(case.fault, over=False)
        if case.ends:
            until_ns = time.monotonic_ns() + 500_000_000
            wait_for(lambda: time.monotonic_ns() > until_ns, "half a second")
            board.inject(case.ends)
        over = board.event(case.ends or case.fault, over=True)
        driver.wait_for_fresh_frames(after_ns=over.monotonic_ns)
        added = asdict(driver.totals().since(before))
        published = driver.published[:]
    board.check(published)

    for name in case.counted.split():
        assert added[name] > 0, f"{name} in {added}"
    allowed = {*_HARMLESS, *case.counted.split(), *case.may_count.split()}
    # A loaded machine lets the board drop frames, as it says itself; the driver must lose none besides.
    allowed |= {"overruns", "lost"}
    assert {name for name, count in added.items() if count} <= allowed
    if case.lost is not None:
        assert added["lost"] <= case.lost + added["overruns"]

    arrivals = [board.to_monotonic_ns(one.arrival_ns) for one in published[max(published_before - 1, 0) :]]
    gaps = [after - earlier for earlier, after in itertools.pairwise(arrivals) if after > begin_ns]
    first = next(arrival for arrival in arrivals if arrival > over.monotonic_ns)
    counted = ", ".join(f"{name} {count}" for name, count in added.items() if count and name not in _HARMLESS)
    table.append(
        f"| `{case.fault}` | {len(published) - published_before} | {counted or 'nothing'} "
        f"| {max(gaps) / 1e6:.1f} ms | {(first - over.monotonic_ns) / 1e6:.1f} ms |"
    )


def test_a_consumer_that_stands_still(board: FaultyBoard, table: list[str]) -> None:
    with PlainDriver(board) as driver:
        published_before = len(driver.published)
        driver.may_take.clear()
        until_ns = time.monotonic_ns() + 1_000_000_000
        wait_for(lambda: time.monotonic_ns() > until_ns, "a second")
        end_ns = time.monotonic_ns()
        driver.may_take.set()
        driver.wait_for_fresh_frames()
        totals = driver.totals()
    board.check(driver.published)
    # The first frames had been read already when the consumer stood still.
    arrivals = [board.to_monotonic_ns(one.arrival_ns) for one in driver.published]
    first_ns = next(arrival for arrival in arrivals if arrival > end_ns)
    gap_ns = max(after - earlier for earlier, after in itertools.pairwise(arrivals))
    counted = f"lost {totals.lost}, overruns {totals.overruns}"
    table.append(
        f"| consumer still for 1 s | {len(arrivals) - published_before} | {counted} "
        f"| {gap_ns / 1e6:.1f} ms | {(first_ns - end_ns) / 1e6:.1f} ms |"
    )
    assert totals.overruns > 0
    assert totals.lost == totals.overruns
    assert totals.crc_errors == totals.malformed == totals.reconnects == 0


def any_fault(chaos: random.Random) -> str:
    """A fault of random kind and size, none longer than 50 ms."""
    kind = chaos.choice(
        ["unplug", "reset", "stall", "freeze", "jump", "garbage", "flip", "drop", "double", "truncate", "lose"]
    )
    if kind in ("unplug", "stall", "freeze"):
        return f"{kind}:{chaos.uniform(0, 0.05):.4f}"
    if kind == "reset":
        return f"reset:{chaos.choice([0, 0, 0.02])}"
    if kind == "jump":
        return f"jump:{chaos.choice([-1, 1]) * chaos.uniform(0.1, 3):.3f}"
    most = {"garbage": 3000, "flip": 100, "lose": 3000}.get(kind, 10)
    return f"{kind}:{chaos.randint(1, most)}"


@pytest.mark.parametrize("seed", [1, 2])
def test_no_wrong_value_is_published_whatever_happens(tmp_path: Path, seed: int) -> None:
    chaos = random.Random(seed)
    seconds = float(os.environ.get("ACTS_CHAOS_SECONDS", "1.5"))
    with (
        FaultyBoard(tmp_path, "--scheme", "adaptive", "--seed", str(seed), "--fault", "flip-rate:0.00003") as board,
        PlainDriver(board, reconnect_s=0.02) as driver,
    ):
        asked = 0
        end_ns = time.monotonic_ns() + int(seconds * 1e9)
        while time.monotonic_ns() < end_ns or asked <= 10:
            faults = [any_fault(chaos) for _ in range(chaos.randint(1, 4))]
            board.inject(*faults)
            asked += len(faults)
            number = len(driver.published) + chaos.randint(0, 40)
            wait_for(lambda: len(driver.published) > number, "frames between faults")  # noqa: B023
        board.inject("flip-rate:0")
        board.event("flip-rate:0", over=True)
        driver.wait_for_fresh_frames()
        assert driver.reader.connected
    assert asked > 10
    assert len(driver.published) > 10 * asked / 4
    board.check(driver.published, early_ns=None)
    totals = driver.totals()
    assert totals.consumer_errors == totals.wrong_size == 0
    print(f"\nseed {seed}: {asked} faults, {len(driver.published)} frames published, all right; {totals}")
