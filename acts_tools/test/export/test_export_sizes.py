# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Touch of a bag as tables: a single joint, and recordings of hours."""

from __future__ import annotations

import json
import tracemalloc
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from test_export import SIDE, header, image, joints, pressed, write_bag

from acts_tools.cli import main
from acts_tools.export.lerobot_statistics import statistics_of
from acts_tools.export.tracks import Joints, joint_track


class OneTopic:
    """In place of a bag: the same messages of one topic."""

    def __init__(self, data: Iterable[bytes]) -> None:
        self._data = data

    def messages(self, topics: list[str]) -> Iterator[tuple[str, int, bytes]]:
        for data in self._data:
            yield topics[0], 0, data


def peak_bytes(work: Callable[[], Any]) -> int:
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_joint_states_of_a_long_recording_fit_into_the_memory() -> None:
    count, n_joints = 20_000, 6
    names = [f"a_joint_of_the_arm_{n}" for n in range(n_joints)]
    numbers = [0.5] * n_joints
    states = (
        serialize_message(
            JointState(header=header(n + 1), name=names, position=numbers, velocity=numbers, effort=numbers)
        )
        for n in range(count)
    )
    found: list[Joints] = []
    peak = peak_bytes(lambda: found.append(joint_track(OneTopic(states), Path("b"), "/j", numbers_only=True)))
    assert len(found[0].track.values) == count
    assert len(found[0].columns) == 3 * n_joints
    assert peak < 1000 * count


def test_statistics_of_a_long_recording_fit_into_the_memory() -> None:
    frames = np.random.default_rng(0).integers(0, 256, (4000, SIDE, SIDE), dtype=np.uint8)
    pictures = np.broadcast_to(frames[..., np.newaxis], (*frames.shape, 3))
    assert peak_bytes(lambda: statistics_of(pictures, is_picture=True)) < frames.nbytes / 10
    counts = frames.reshape(len(frames), -1).astype(np.float32)
    assert peak_bytes(lambda: statistics_of(counts, is_picture=False)) < counts.nbytes


@pytest.mark.parametrize("n_values", [2, 200, 256])
def test_statistics_of_pictures_are_those_of_their_pixels(n_values: int) -> None:
    pictures = np.random.default_rng(n_values).integers(0, n_values, (7, 5, 9, 3), dtype=np.uint8)
    pixels = pictures.reshape(-1, 3) / 255.0
    found = statistics_of(pictures, is_picture=True)
    expected = {"min": pixels.min(axis=0), "max": pixels.max(axis=0), "mean": pixels.mean(axis=0)}
    expected |= {"std": pixels.std(axis=0), "q01": np.quantile(pixels, 0.01, axis=0)}
    expected |= {name: np.quantile(pixels, int(name[1:]) / 100, axis=0) for name in ("q10", "q50", "q90", "q99")}
    assert set(found) == {*expected, "count"}
    for name, values in expected.items():
        assert found[name].shape == (3, 1, 1)
        assert found[name].ravel() == pytest.approx(values, abs=1e-12)
    assert found["count"].tolist() == [7]


def test_a_single_joint_is_a_column_of_numbers_in_a_lerobot_dataset(tmp_path: Path) -> None:
    """lerobot makes of the shape [1] a `datasets.Value`, and fails on a list."""
    parquet = pytest.importorskip("pyarrow.parquet", reason="./acts run python3 -m pip install pyarrow")
    path = write_bag(
        tmp_path / "b",
        ("/joint_states", joints(0, knee=0.5)),
        *(("/plate/image_raw", image(t, pressed(0))) for t in (10, 20, 30)),
    )
    out = tmp_path / "out"
    assert main(["export", str(path), "--to", "lerobot", "--rate", "100", "-o", str(out)]) == 0
    feature = json.loads((out / "meta/info.json").read_text())["features"]["observation.state"]
    assert feature == {"dtype": "float32", "shape": [1], "names": ["knee.position"]}
    table = parquet.read_table(out / "data/chunk-000/file-000.parquet")
    assert str(table.schema.field("observation.state").type) == "float"
    assert table["observation.state"].to_pylist() == [0.5, 0.5, 0.5]
