# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Status of a driver on /diagnostics."""

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
    name = f"{namespace.strip('/')}/driver"
    for status in message.status:
        if status.name == name:
            values = {value.key: value.value for value in status.values}
            if "lost" in values:
                return values
    return None
