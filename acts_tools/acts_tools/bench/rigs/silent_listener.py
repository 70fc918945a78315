# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A subscriber in a process of its own that receives samples and contacts like a controller, and drops them.

python3 -m acts_tools.bench.rigs.silent_listener NAMESPACE
"""

from __future__ import annotations

import sys
import time

from acts_msgs.msg import Contact, TactileSamples
from acts_ros import middleware
from acts_ros.polled import PollingNode
from acts_ros.qos import STREAM

_PERIOD_S = 0.008


def main(namespace: str) -> None:
    """Receive messages until the process is stopped."""
    middleware.init(args=[])
    node = PollingNode("silent_listener", namespace=namespace)
    subscriptions = [
        node.create_polled_subscription(kind, topic, STREAM)
        for kind, topic in ((TactileSamples, "samples"), (Contact, "contact"))
    ]
    while True:
        for subscription in subscriptions:
            subscription.take_all()
        time.sleep(_PERIOD_S)


if __name__ == "__main__":
    main(sys.argv[1])
