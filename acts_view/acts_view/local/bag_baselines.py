# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the taxels of a recorded skin read untouched, out of its bag."""

from __future__ import annotations

from pathlib import Path

from acts_core.errors import ArrayError, PacketError, RecordingError
from acts_driver.baseline import Baseline, BaselineSource
from acts_msgs.msg import Baseline as BaselineMessage
from acts_ros.bags.reading import open_bag
from acts_ros.bags.skin_topics import baseline_topic
from acts_ros.messages import baseline_of, message_of, ns_of


def read_baselines(path: Path, samples: str, rows: int, cols: int) -> tuple[list[Baseline], str]:
    """The baselines beside the samples of a bag by their time, and why there are no more of them.

    Parameters
    ----------
    path : Path
        Of the bag.
    samples : str
        Full name of the topic of the samples; without a baseline beside it there are none, and nothing is wrong.
    rows, cols : int
        Size of the array.

    Returns
    -------
    baselines : list of Baseline
    problem : str
        For a person; empty where all could be read.
    """
    found: list[Baseline] = []
    topic = None
    try:
        with open_bag(path) as bag:
            topic = baseline_topic(bag.topics(), samples)
            if topic is None:
                return [], ""
            bag.check_definition(topic)
            for _, _, data in bag.messages([topic]):
                found.append(_parsed(data, rows, cols))
    except (RecordingError, ArrayError, PacketError) as error:
        return _in_order(found), f"not all of {topic or path} could be read: {error}"
    return _in_order(found), ""


def _in_order(baselines: list[Baseline]) -> list[Baseline]:
    return sorted(baselines, key=lambda one: one.time_ns)


def _parsed(data: bytes, rows: int, cols: int) -> Baseline:
    message = message_of(data, BaselineMessage)
    fields = baseline_of(message, rows, cols)
    return Baseline(
        counts=fields.counts.reshape(rows, cols),
        noise_counts=fields.noise_counts.reshape(rows, cols),
        valid=fields.valid.reshape(rows, cols),
        source=BaselineSource.FILE,
        time_ns=ns_of(message.header.stamp),
    )
