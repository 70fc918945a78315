# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Touch across a cable: the skin on one machine, who listens on another, and a cable that is slow, lossy or cut.

Two network namespaces stand for the machines; skipped where they are not allowed. ROS_DOMAIN_ID 150.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass

import pytest
from launch_support import shipped_parameters_and
from waiting import wait_for

from acts_core.errors import LaunchError
from acts_tools.two_machines.conditions import Conditions
from acts_tools.two_machines.listener import Listener, Report, listener
from acts_tools.two_machines.machines import TwoMachines, two_machines

pytestmark = pytest.mark.slow

DOMAIN_ID = 150
CONTACT, SAMPLES = "/plate/contact", "/plate/samples"
BOARD, BASELINE = "/plate/board", "/plate/baseline"
TOPICS = (CONTACT, SAMPLES, BOARD, BASELINE, "/diagnostics")
FAR_NODE, NEAR_NODE = "far/reconstruction", "plate/reconstruction"
# Numba compiles in the first process that needs a kernel; on a busy machine that takes its time.
START_S = 120.0
DEADLINE_S = 30.0
DELAY_MS = 20.0
# A quarter of the full rate: what is asked here does not depend on it, and much runs here at once.
RATE_HZ = 250


@dataclass
class Touch:
    """Board, driver and reconstruction on the near machine; another reconstruction and a listener on the far one."""

    machines: TwoMachines
    far: Listener

    def on_near_machine(self, *words: str) -> int:
        """Run an acts command there; its exit code."""
        return subprocess.run(
            self.machines.near.command([sys.executable, "-m", "acts_tools", *words]),
            env=self.machines.near.environment(DOMAIN_ID),
            capture_output=True,
            timeout=DEADLINE_S,
        ).returncode


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Touch]:
    folder = tmp_path_factory.mktemp("two_machines")
    acts = [sys.executable, "-m", "acts_tools"]
    # From the start on.
    capped = shipped_parameters_and(folder, "tactile", "/plate/driver", f"{{rate_cap_hz: {RATE_HZ}}}")
    launch = [*acts, "launch", "--own", "acts_bringup", "tactile.launch.xml", f"run_dir:={folder}"]
    launch.append(f"params_file:={capped}")
    node = [
        sys.executable,
        "-m",
        "acts_ros.executables.program",
        "acts_recon.nodes.reconstruction_node",
        "--ros-args",
        "-r",
    ]
    node += ["__ns:=/far", "-r", "samples:=/plate/samples", "-r", "baseline:=/plate/baseline"]
    with ExitStack() as stack:
        try:
            machines = stack.enter_context(two_machines())
        except LaunchError as error:
            pytest.skip(str(error))
        stack.enter_context(machines.near.running(launch, DOMAIN_ID, folder / "launch.txt"))
        stack.enter_context(machines.far.running(node, DOMAIN_ID, folder / "reconstruction.txt"))
        first = stack.enter_context(listener(machines.far, [CONTACT, "/far/contact"], DOMAIN_ID, folder / "first.txt"))
        touch = Touch(machines, first)
        try:
            first.wait_for(
                lambda report: min(report.received(CONTACT), report.received("/far/contact")) > 0, START_S, "contacts"
            )
            # Refused until enough of the skin has been seen.
            wait_for(lambda: touch.on_near_machine("driver", "tare") == 0, "a tare", DEADLINE_S)
            # From here on everything that is kept has been published: this one is late for it.
            touch.far = stack.enter_context(listener(machines.far, TOPICS, DOMAIN_ID, folder / "far.txt"))
            touch.far.wait_for(lambda report: report.received(CONTACT) > 0, DEADLINE_S, "contacts")
            yield touch
        finally:
            print((folder / "launch.txt").read_text(errors="replace"))


@pytest.fixture
def touch(running: Touch) -> Iterator[Touch]:
    """With a good cable, before and after."""
    running.machines.set_conditions(Conditions())
    running.far.wait_for(flows, DEADLINE_S, "a stream without loss")
    yield running
    running.machines.set_conditions(Conditions())


def flows(report: Report) -> bool:
    """Whether contacts arrive, in time and all of them."""
    interval = report.topics[CONTACT]
    return interval.received > 0 and interval.lost == 0 and (interval.median_ms or 0.0) < DELAY_MS / 2


def test_the_stream_crosses_the_cable(touch: Touch) -> None:
    before, _ = touch.machines.traffic()
    first, *_, last = touch.far.collect(6, DEADLINE_S)
    after, _ = touch.machines.traffic()
    contacts = last.received(CONTACT) - first.received(CONTACT)
    assert contacts > 0
    assert after.dropped == before.dropped
    # Not by shared memory, which two namespaces of one host could have in common: every message was a frame.
    assert after.frames - before.frames >= contacts


def test_what_is_kept_reaches_who_comes_late(touch: Touch) -> None:
    touch.far.wait_for(
        lambda report: report.received(BOARD) > 0 and report.received(BASELINE) > 0, DEADLINE_S, "board and baseline"
    )


def test_a_delay_is_seen_in_the_age_and_stays_what_it_is(touch: Touch) -> None:
    touch.machines.set_conditions(Conditions(delay_s=DELAY_MS / 1e3))
    # The stamp is the board's time mapped onto the host's: true to a fraction of a millisecond.
    earliest = touch.far.wait_for(
        lambda report: (report.topics[CONTACT].median_ms or 0.0) > DELAY_MS - 1, DEADLINE_S, "late contacts"
    )
    ages_ms: list[float] = []

    def is_enough(report: Report) -> bool:
        # Where a machine stands still, nothing comes for an interval, which has no age.
        age_ms = report.topics[CONTACT].median_ms
        ages_ms.extend([] if age_ms is None else [age_ms])
        return len(ages_ms) > 5

    touch.far.wait_for(is_enough, DEADLINE_S, "the ages of five intervals")
    # The first of them may have begun before.
    assert min(ages_ms[1:]) > DELAY_MS - 1
    # All are on the way for as long: none of them is missing for it.
    touch.far.wait_for(
        lambda report: report.topics[CONTACT].lost == 0 and report.received(CONTACT) > earliest.received(CONTACT),
        DEADLINE_S,
        "late contacts without loss",
    )


def leaves_out(report: Report) -> bool:
    """Whether the near machine says that it was too late for some frames."""
    told = report.complaints
    return "came late" in told.get(NEAR_NODE, "") or "overrun" in told.get("plate/driver", "")


def test_loss_is_counted_and_makes_nothing_late(touch: Touch) -> None:
    touch.machines.set_conditions(Conditions(loss=0.02))
    deadline_s = time.monotonic() + DEADLINE_S
    while True:
        reports = touch.far.collect(15, DEADLINE_S)
        received = sum(report.topics[CONTACT].received for report in reports)
        lost = sum(report.topics[CONTACT].lost or 0 for report in reports)
        # 2 %; a busy board leaves frames out as well.
        if 0.005 < lost / (received + lost) < 0.2:
            break
        # So does a reconstruction that is late. Where either leaves out many, which it says: then once more.
        assert any(map(leaves_out, reports)), reports[-1]
        assert time.monotonic() < deadline_s, f"no loss of some 2 %: {reports[-1]}"
    # What follows a loss does not wait for it.
    assert any((report.topics[CONTACT].median_ms or DELAY_MS) < DELAY_MS for report in reports)
    touch.far.wait_for(lambda report: "lost" in report.complaints.get(FAR_NODE, ""), DEADLINE_S, "a word about it")


def test_after_a_cut_all_comes_back_by_itself(touch: Touch) -> None:
    before = touch.far.collect(1, DEADLINE_S)[-1]
    touch.machines.set_conditions(Conditions(cut=True))
    assert touch.on_near_machine("driver", "set", "m=56" if before.received(BOARD) % 2 else "m=57") == 0
    # The far node says so itself, in a report a second; of the near ones nothing is heard.
    touch.far.wait_for(
        lambda report: (
            (report.topics[CONTACT].silent_s or 0.0) > 2.5 and report.complaints.get(FAR_NODE) == "no samples"
        ),
        DEADLINE_S,
        "silence on the far machine, and a word about it",
    )
    touch.machines.set_conditions(Conditions())
    back = touch.far.wait_for(flows, DEADLINE_S, "contacts after the cut")
    # The gap is counted, not hidden: it lasted for more than two seconds.
    missing = back.lost(CONTACT) - before.lost(CONTACT)
    assert missing >= RATE_HZ
    # What changed meanwhile and is kept arrives after all.
    touch.far.wait_for(
        lambda report: report.received(BOARD) > before.received(BOARD), DEADLINE_S, "the board's new settings"
    )
    touch.far.wait_for(lambda report: FAR_NODE not in report.complaints, DEADLINE_S, "an end of the complaint")
