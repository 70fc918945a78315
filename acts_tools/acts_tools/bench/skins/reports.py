# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Counters that driver and reconstruction of each skin publish on /diagnostics."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from diagnostic_msgs.msg import DiagnosticArray

from acts_tools.bench.rigs.graph import Graph

COUNTERS = {
    "driver": (
        "lost",
        "overruns",
        "crc_errors",
        "malformed",
        "repeated",
        "restarts",
        "reconnects",
        "consumer_errors",
    ),
    "reconstruction": ("not_published",),
}
"""Counters that should stay 0, by node; see docs/driver.md and docs/reconstruction.md."""

Counts = Mapping[str, Mapping[str, int]]
"""Counters by node and name."""

_TIMEOUT_S = 30.0


def next_counts(graph: Graph, names: Sequence[str], check: Callable[[], None]) -> dict[str, Counts]:
    """The counters of every skin, by its name, from its next report.

    It subscribes only for this, because reading the long reports takes as long as several frames.

    Parameters
    ----------
    graph : Graph
        Spins while waiting.
    names : sequence of str
        The skins' namespaces.
    check : callable
        Raises an error when waiting is useless.

    Raises
    ------
    LaunchError
        When a node does not report.
    """
    wanted = {f"{name}/{node}": (name, node) for name in names for node in COUNTERS}
    found: dict[str, dict[str, Mapping[str, int]]] = {name: {} for name in names}

    def keep(message: DiagnosticArray) -> None:
        for status in message.status:
            if status.name not in wanted:
                continue
            name, node = wanted[status.name]
            values = {value.key: value.value for value in status.values}
            # A driver that has lost its port reports fewer values.
            if all(counter in values for counter in COUNTERS[node]):
                found[name][node] = {counter: int(values[counter]) for counter in COUNTERS[node]}

    subscription = graph.node.create_subscription(DiagnosticArray, "/diagnostics", keep, 10)
    try:
        graph.spin_until(
            lambda: all(len(counts) == len(COUNTERS) for counts in found.values()),
            _TIMEOUT_S,
            "a report of every driver and reconstruction",
            check,
        )
    finally:
        graph.node.destroy_subscription(subscription)
    return dict(found)


def added(before: Counts, after: Counts) -> dict[str, dict[str, int]]:
    """Differences of the counters of two reports of a skin."""
    return {
        node: {name: count - before[node][name] for name, count in counts.items()} for node, counts in after.items()
    }
