# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Touch of a bag as tables: a single joint, and recordings of hours."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from test_export import image, joints, pressed, write_bag

from acts_tools.cli import main


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
