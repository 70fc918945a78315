# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the topics of a recorded skin are called. Importing this imports neither ROS nor rosbags."""

from __future__ import annotations

from collections.abc import Mapping

IMAGE = "sensor_msgs/msg/Image"
SAMPLES = "acts_msgs/msg/TactileSamples"
BASELINE = "acts_msgs/msg/Baseline"


def baseline_topic(types: Mapping[str, str], samples: str) -> str | None:
    """The topic with the baseline of samples, which is beside theirs; None where a bag has none.

    Parameters
    ----------
    types : mapping
        Message type by topic, see `acts_ros.bags.reading.Bag.topics`.
    samples : str
        Full name of the topic of the samples.
    """
    beside = f"{samples.rsplit('/', 1)[0]}/baseline"
    return beside if types.get(beside) == BASELINE else None
