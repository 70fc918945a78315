# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Status of a driver on /diagnostics, or of another node of a skin."""

from __future__ import annotations

from diagnostic_msgs.msg import DiagnosticArray


def driver_values(message: DiagnosticArray, namespace: str) -> dict[str, str] | None:
    """Values of a skin's driver.

    Parameters
    ----------
    message : DiagnosticArray
        As received on /diagnostics.
    namespace : str
        The skin's namespace, for example ``/plate``.

    Returns
    -------
    dict of str to str or None
        Values as listed in ``docs/driver.md``; None where the message has none, or the driver has not found its port.
    """
    values = node_values(message, namespace, "driver")
    return values if "lost" in values else None


def node_values(message: DiagnosticArray, namespace: str, node: str) -> dict[str, str]:
    """Values of a node of a skin; empty where the message has none of it."""
    name = f"{namespace.strip('/')}/{node}"
    for status in message.status:
        if status.name == name:
            return {value.key: value.value for value in status.values}
    return {}
