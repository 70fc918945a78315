# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The services that switch the torque of a hand on and off.

Their answers may wait for the motors for seconds. The other services of the node, such as stop, are answered meanwhile.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from std_srvs.srv import Trigger

from acts_control.hand.control import PendingAnswer
from acts_ros.clocks import steady_timer
from acts_ros.polled import PolledService, PollingNode

_PERIOD_S = 0.02


class TorqueServices:
    """Services of a node, whose answers come later.

    Parameters
    ----------
    node : PollingNode
    asks : mapping of str to callable
        By the name of each service, what begins with a request.
    """

    def __init__(self, node: PollingNode, asks: Mapping[str, Callable[[], PendingAnswer]]) -> None:
        self._asks = [(node.create_polled_service(Trigger, name), ask) for name, ask in asks.items()]
        self._waiting: list[tuple[PolledService, Any, PendingAnswer]] = []
        steady_timer(node, _PERIOD_S, self.serve)

    def serve(self) -> None:
        """Take the requests that have come, and answer those of which the outcome is known."""
        for service, ask in self._asks:
            while (taken := service.take()) is not None:
                self._waiting.append((service, taken[1], ask()))
        waiting, self._waiting = self._waiting, []
        for service, header, pending in waiting:
            objection = pending.poll()
            if objection is None:
                self._waiting.append((service, header, pending))
            else:
                service.answer(answered(Trigger.Response(), objection), header)


def answered(response: Trigger.Response, objection: str, done: str = "") -> Any:
    """The answer of a service: why not, or where nothing objects what is done."""
    response.success = not objection
    response.message = objection or done
    return response
