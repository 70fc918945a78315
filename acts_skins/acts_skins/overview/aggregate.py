# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The diagnostics of all skins as one tree, like ROS's diagnostic_aggregator. Does not depend on ROS."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

OK, WARN, ERROR, STALE = range(4)
_WORDS = ("OK", "Warning", "Error", "Stale")

EXPECTED = ("driver", "reconstruction")
"""Nodes that every skin has."""

_ROOT = "/Skins"
# Nodes of no skin that are part of the tree from their first status on.
_OTHERS = ("skin_contacts",)

# Limit of other nodes, because anybody in the domain can publish statuses of invented nodes.
_NODES_MAX = 200


@dataclass(frozen=True)
class Status:
    """As diagnostic_msgs/DiagnosticStatus."""

    name: str
    level: int
    message: str
    hardware_id: str = ""
    values: Mapping[str, str] = field(default_factory=dict)


class Aggregate:
    """Keeps the newest status of every node of the skins.

    Parameters
    ----------
    skins : sequence of str
        Their names.
    prefix : str
        Common prefix of the skins' namespaces, such as ``robot/``; or empty.
    stale_after_s : float
        A node whose last status is older than this is stale [s].
    """

    def __init__(
        self,
        skins: Sequence[str],
        prefix: str = "",
        stale_after_s: float = 3.0,
    ) -> None:
        self._skins = tuple(skins)
        self._prefix = prefix
        self._stale_after_s = stale_after_s
        self._heard: dict[str, tuple[float, Status]] = {}

    def take(self, status: Status, now_s: float) -> None:
        """Store a status, whose name is a node's full name without the first slash; ignore nodes of no skin."""
        if not status.name.startswith(self._prefix):
            return
        name = status.name.removeprefix(self._prefix)
        if name in _OTHERS or name.partition("/")[0] in self._skins:
            # Those that every skin has come in whatever came before them.
            is_expected = name in _OTHERS or name.partition("/")[2] in EXPECTED
            if name not in self._heard and len(self._heard) >= _NODES_MAX and not is_expected:
                return
            self._heard[name] = (now_s, status)

    def step(self, now_s: float) -> list[Status]:
        """The status of the root, then of every skin, each followed by its nodes."""
        parts = [self._skin(skin, now_s) for skin in self._skins]
        parts += [[self._node(name, now_s)] for name in _OTHERS if name in self._heard]
        heads = [part[0] for part in parts]
        level = _worst([head.level for head in heads])
        bad = [f"{_last(head.name)}: {head.message}" for head in heads if head.level != OK]
        skins = "skin" if len(self._skins) == 1 else "skins"
        whole = Status(
            _ROOT,
            level,
            "; ".join(bad) or f"{len(self._skins)} {skins}, all well",
            values={_last(head.name): _WORDS[head.level] for head in heads},
        )
        return [whole, *(status for part in parts for status in part)]

    def _skin(self, skin: str, now_s: float) -> list[Status]:
        heard = [name for name in self._heard if name.startswith(f"{skin}/")]
        names = [*(f"{skin}/{node}" for node in EXPECTED), *sorted(heard)]
        nodes = [self._node(name, now_s) for name in dict.fromkeys(names)]
        level = _worst([node.level for node in nodes])
        bad = [f"{_last(node.name)}: {node.message}" for node in nodes if node.level != OK]
        head = Status(
            f"{_ROOT}/{skin}",
            level,
            "; ".join(bad) or "all well",
            values={_last(node.name): _WORDS[node.level] for node in nodes},
        )
        return [head, *nodes]

    def _node(self, name: str, now_s: float) -> Status:
        full_name = f"{_ROOT}/{name}"
        if name not in self._heard:
            return Status(full_name, STALE, "nothing heard of it yet")
        heard_s, status = self._heard[name]
        silent_s = now_s - heard_s
        if silent_s > self._stale_after_s:
            return Status(
                full_name, STALE, f"nothing heard of it for {silent_s:.0f} s", status.hardware_id, status.values
            )
        return Status(full_name, min(max(status.level, OK), STALE), status.message, status.hardware_id, status.values)


def _worst(levels: Sequence[int]) -> int:
    """The worst level; STALE only if all are stale, for a stale part beside others is an error."""
    if all(level == STALE for level in levels):
        return STALE
    return min(max(levels), ERROR)


def _last(name: str) -> str:
    return name.rpartition("/")[2]
