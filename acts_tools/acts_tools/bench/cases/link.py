# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Traffic of a skin on a cable between two machines, and loss and delay of its contacts on a bad cable.

Driver and reconstruction with a simulated board run on one machine, and `acts listen` on the other. Both are network
namespaces of this machine, so that their clocks agree.
"""

from __future__ import annotations

import os
import statistics
import sys
import time
from functools import partial
from pathlib import Path

from acts_core.errors import LaunchError
from acts_tools.bench.result import Figure, Result
from acts_tools.bench.workbench import Workbench
from acts_tools.two_machines.conditions import Conditions
from acts_tools.two_machines.listener import EVERY_S, Listener, Report, listener
from acts_tools.two_machines.machines import TwoMachines, two_machines

CONTACT = "/plate/contact"
# In the order of the table. The last has the most traffic.
TOPICS = ("samples", "contact", "contacts", "cop", "confidence", "image_raw", "image")
CABLES = {
    "good": Conditions(),
    "delay": Conditions(delay_s=0.02),
    "loss": Conditions(loss=0.02),
    "delay_loss": Conditions(delay_s=0.02, loss=0.02),
}
LABELS = {"good": "good cable", "delay": "20 ms delay", "loss": "2 % loss", "delay_loss": "20 ms delay and 2 % loss"}
# Shorter and longer than 20 s, after which Fast DDS removes a silent participant.
CUTS_S = (3.0, 25.0)
_START_TIMEOUT_S = 120.0
_TIMEOUT_S = 60.0
_LAUNCH = "launch.log"


class _Link:
    """The two machines, with a skin on the near one."""

    def __init__(self, workbench: Workbench, machines: TwoMachines, domain_id: int) -> None:
        self._workbench = workbench
        self._machines = machines
        self._domain_id = domain_id
        self.figures: list[Figure] = []

    def measure_traffic(self) -> None:
        """Measure the traffic of every topic by itself, and that of the middleware without any."""
        with listener(self._machines.far, ["/plate/board"], self._domain_id, self._log("idle")) as idle:
            idle.wait_for(lambda report: report.received("/plate/board") > 0, _START_TIMEOUT_S, "the board")
            idle_kb_s = self._kilobytes_per_second()
        self.figures.append(Figure("idle_kb_s", "no 1 kHz topic, on the cable", idle_kb_s, "kB/s"))
        for topic in TOPICS:
            name = f"/plate/{topic}"
            with listener(self._machines.far, [name], self._domain_id, self._log(topic)) as heard:
                begin = heard.wait_for(partial(_flows, name), _START_TIMEOUT_S, name)
                begin_s = time.monotonic()
                kb_s = self._kilobytes_per_second() - idle_kb_s
                end = heard.collect(1, _TIMEOUT_S)[-1]
                rate_hz = (end.received(name) - begin.received(name)) / (time.monotonic() - begin_s)
            self.figures += [
                Figure(f"{topic}_kb_s", f"{topic}, on the cable", kb_s, "kB/s"),
                Figure(f"{topic}_hz", f"    {topic}, arriving", rate_hz, "messages/s"),
            ]

    def measure_cables(self) -> None:
        """Measure contacts over a good cable and bad cables, and after interruptions."""
        with listener(self._machines.far, [CONTACT], self._domain_id, self._log("cables")) as heard:
            heard.wait_for(partial(_flows, CONTACT), _START_TIMEOUT_S, "contacts")
            for name, conditions in CABLES.items():
                self._machines.set_conditions(conditions)
                self._add_contacts(name, LABELS[name], self._collect(heard))
            for cut_s in CUTS_S:
                self._measure_cut(heard, cut_s)

    def measure_image(self) -> None:
        """Measure the image for viewers over a lossy cable: large and reliable, the worst case."""
        with listener(self._machines.far, [CONTACT, "/plate/image"], self._domain_id, self._log("picture")) as heard:
            heard.wait_for(
                lambda report: min(report.received(CONTACT), report.received("/plate/image")) > 0, _TIMEOUT_S, "images"
            )
            self._machines.set_conditions(CABLES["loss"])
            before, begin_s = self._machines.traffic()[0], time.monotonic()
            reports = self._collect(heard)
            seconds = time.monotonic() - begin_s
            kb_s = (self._machines.traffic()[0].sent_bytes - before.sent_bytes) / seconds / 1e3
            images = sum(report.topics["/plate/image"].received for report in reports)
            self.figures += [
                Figure("lossy_image_hz", "image, 2 % loss, arriving", images / seconds, "messages/s"),
                Figure("lossy_image_kb_s", "    with contact on the cable", kb_s, "kB/s"),
            ]
            self._add_contacts("lossy_image", "with image, 2 % loss", reports)
            self._machines.set_conditions(Conditions())
            begin_s = time.monotonic()
            before_count = reports[-1].received("/plate/image")
            try:
                heard.wait_for(lambda report: report.received("/plate/image") > before_count, _TIMEOUT_S, "images")
                back_s: float | None = time.monotonic() - begin_s
            except LaunchError:
                back_s = None
            self.figures.append(Figure("image_back_s", "    image again after the loss has ended", back_s, "s"))

    def _measure_cut(self, heard: Listener, cut_s: float) -> None:
        self._machines.set_conditions(Conditions(cut=True))
        self._workbench.sleep(cut_s)
        silent = heard.collect(1, _TIMEOUT_S)[-1]
        self._machines.set_conditions(Conditions())
        begin_s = time.monotonic()
        back = heard.wait_for(partial(_flows, CONTACT), _TIMEOUT_S, "contacts after a cut")
        after_s = time.monotonic() - begin_s
        missing = back.lost(CONTACT) - silent.lost(CONTACT)
        key = f"cut_{cut_s:.0f}_s"
        self.figures += [
            Figure(f"{key}.back_s", f"cut of {cut_s:.0f} s, contacts again within", after_s, "s"),
            Figure(f"{key}.missing", "    counted as lost", missing, "contacts"),
        ]

    def _add_contacts(self, key: str, label: str, reports: list[Report]) -> None:
        received = sum(report.topics[CONTACT].received for report in reports)
        lost = sum(report.topics[CONTACT].lost or 0 for report in reports)
        medians_ms = [value for report in reports if (value := report.topics[CONTACT].median_ms) is not None]
        largest_ms = [value for report in reports if (value := report.topics[CONTACT].largest_ms) is not None]
        lost_percent = 100 * lost / max(received + lost, 1)
        median_ms = statistics.median(medians_ms) if medians_ms else None
        self.figures += [
            Figure(f"{key}.lost_percent", f"{label}: contacts lost", lost_percent, "%"),
            Figure(f"{key}.age_ms", "    age at arrival, median", median_ms, "ms"),
            Figure(f"{key}.largest_age_ms", "    largest", max(largest_ms, default=None), "ms"),
        ]

    def _collect(self, heard: Listener) -> list[Report]:
        self._workbench.check_stop()
        return heard.collect(max(2, round(self._workbench.seconds / EVERY_S)), _TIMEOUT_S + self._workbench.seconds)

    def _kilobytes_per_second(self) -> float:
        before, begin_s = self._machines.traffic()[0], time.monotonic()
        self._workbench.sleep(self._workbench.seconds)
        after = self._machines.traffic()[0]
        return (after.sent_bytes - before.sent_bytes) / (time.monotonic() - begin_s) / 1e3

    def _log(self, name: str) -> Path:
        return self._workbench.folder / f"{name}.log"


def _flows(topic: str, report: Report) -> bool:
    return topic in report.topics and report.topics[topic].received > 0


def measure(workbench: Workbench) -> Result:
    """Measure every topic and every cable, for ``workbench.seconds`` each."""
    domain_id = int(os.environ["ROS_DOMAIN_ID"])
    launch = [sys.executable, "-m", "acts_tools", "launch", "--own", "acts_bringup", "tactile.launch.xml"]
    with two_machines() as machines:
        launch += [f"run_dir:={workbench.folder}"]
        with machines.near.running(launch, domain_id, workbench.folder / _LAUNCH):
            link = _Link(workbench, machines, domain_id)
            link.measure_traffic()
            link.measure_cables()
            link.measure_image()
    return Result(link.figures)
