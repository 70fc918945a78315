# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Write recordings as episodes of a LeRobot dataset, format v3.0, for lerobot 0.4 to 0.6.

Parquet tables of rows (``data/``) and of episodes (``meta/episodes/``), the tasks (``meta/tasks.parquet``), a
description of the columns (``meta/info.json``) and their statistics (``meta/stats.json``).
lerobot itself is not needed.
"""

from __future__ import annotations

import io
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image as PngImage

from acts_core.array import COUNT_MAX
from acts_core.errors import RecordingError
from acts_recon.contacts import MAX_BLOBS
from acts_tools.export.arrow import arrow
from acts_tools.export.lerobot_statistics import Statistics, pooled, statistics_of
from acts_tools.export.recording import Recording, Row
from acts_tools.export.tracks import CONTACT_COLUMNS, CONTACTS_COLUMNS

_VERSION = "v3.0"
_FILES_IN_CHUNK = 1000
_FILE_MB_MAX = 100
_FILE = "chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
_TASKS_FOR_PANDAS = {
    "index_columns": ["task"],
    "column_indexes": [],
    "columns": [
        {
            "name": "task_index",
            "field_name": "task_index",
            "pandas_type": "int64",
            "numpy_type": "int64",
            "metadata": None,
        },
        {"name": "task", "field_name": "task", "pandas_type": "unicode", "numpy_type": "object", "metadata": None},
    ],
    "pandas_version": "2.0.0",
}
"""lerobot reads the tasks with pandas, and needs their names as its index."""

Features = dict[str, dict[str, Any]]


class LeRobotWriter:
    """Writes a dataset, episode by episode.

    Parameters
    ----------
    folder : Path
        Folder to make.
    rate_hz : int
        Rows per second of all episodes.
    task : str
        Description of the task in all episodes.

    Raises
    ------
    RecordingError
        pyarrow is not installed.
    """

    def __init__(self, folder: Path, rate_hz: int, task: str) -> None:
        self._pa, self._pq = arrow()
        self._folder = folder
        self._rate_hz = rate_hz
        self._task = task
        self._features: Features = {}
        self._episodes: list[dict[str, Any]] = []
        self._statistics: list[Statistics] = []
        self._n_rows = 0
        self._file = 0
        folder.mkdir(parents=True)

    def add(self, recording: Recording) -> int:
        """Write one recording as an episode, and return its number of rows.

        Raises
        ------
        RecordingError
            It has other columns than the recordings before, or nothing to export.
        """
        rows = list(recording.rows())
        features, columns = _features_of(rows, recording)
        if self._features and features != self._features:
            raise RecordingError(
                f"'{recording.name}' has other columns than the recordings before ({_described(features)}; those have "
                f"{_described(self._features)}): make a dataset of each"
            )
        self._features = features
        number, n_rows = len(self._episodes), len(rows)
        columns |= {
            "timestamp": (np.arange(n_rows) / self._rate_hz).astype(np.float32),
            "frame_index": np.arange(n_rows, dtype=np.int64),
            "episode_index": np.full(n_rows, number, dtype=np.int64),
            "index": np.arange(self._n_rows, self._n_rows + n_rows, dtype=np.int64),
            "task_index": np.zeros(n_rows, dtype=np.int64),
        }
        statistics = {
            name: statistics_of(values, features[name]["dtype"] == "image") for name, values in columns.items()
        }
        chunk, file = divmod(self._file, _FILES_IN_CHUNK)
        place = {"chunk_index": chunk, "file_index": file}
        self._write(
            "data/" + _FILE.format(**place),
            {name: self._arrow_column(columns[name], features[name]) for name in features},
        )
        self._episodes.append(self._episode(n_rows, place, statistics))
        self._statistics.append(statistics)
        self._n_rows += n_rows
        self._file += 1
        return n_rows

    def _episode(self, n_rows: int, place: dict[str, int], statistics: Statistics) -> dict[str, Any]:
        """What the metadata say of the next episode, of which the data are in the file at `place`."""
        return {
            "episode_index": len(self._episodes),
            "tasks": [self._task],
            "length": n_rows,
            **{f"data/{name}": value for name, value in place.items()},
            "dataset_from_index": self._n_rows,
            "dataset_to_index": self._n_rows + n_rows,
            **{
                f"stats/{name}/{kind}": value.tolist()
                for name, kinds in statistics.items()
                for kind, value in kinds.items()
            },
            "meta/episodes/chunk_index": 0,
            "meta/episodes/file_index": 0,
        }

    def close(self) -> None:
        """Write the metadata of all episodes, without which the dataset is invalid."""
        pa = self._pa
        episodes = {name: [one[name] for one in self._episodes] for name in self._episodes[0]}
        self._write("meta/episodes/" + _FILE.format(chunk_index=0, file_index=0), episodes)
        tasks = pa.table({"task_index": pa.array([0], pa.int64()), "task": [self._task]})
        tasks = tasks.replace_schema_metadata({"pandas": json.dumps(_TASKS_FOR_PANDAS)})
        self._write_table("meta/tasks.parquet", tasks)
        all_statistics = pooled(self._statistics)
        self._write_json(
            "meta/stats.json",
            {name: {kind: v.tolist() for kind, v in kinds.items()} for name, kinds in all_statistics.items()},
        )
        self._write_json(
            "meta/info.json",
            {
                "codebase_version": _VERSION,
                "fps": self._rate_hz,
                "features": self._features,
                "total_episodes": len(self._episodes),
                "total_frames": self._n_rows,
                "total_tasks": 1,
                "chunks_size": _FILES_IN_CHUNK,
                "data_files_size_in_mb": _FILE_MB_MAX,
                "video_files_size_in_mb": 200,
                "data_path": "data/" + _FILE,
                "video_path": None,
                "robot_type": None,
                "splits": {"train": f"0:{len(self._episodes)}"},
            },
        )

    def _arrow_column(self, values: NDArray[Any], feature: dict[str, Any]) -> Any:
        pa = self._pa
        if feature["dtype"] == "image":
            kind = pa.struct([("bytes", pa.binary()), ("path", pa.string())])
            return pa.array([{"bytes": _png(one), "path": None} for one in values], kind)
        column = pa.array(values.ravel())
        # lerobot reads a column of the shape [1], such as that of a single joint, as plain numbers.
        if feature["shape"] == [1]:
            return column
        return pa.FixedSizeListArray.from_arrays(column, values.shape[1])

    def _write(self, name: str, columns: dict[str, Any]) -> None:
        self._write_table(name, self._pa.table(columns))

    def _write_table(self, name: str, table: Any) -> None:
        path = self._folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        # pyarrow itself takes no path with a name in another encoding.
        with path.open("wb") as file:
            self._pq.write_table(table, file)

    def _write_json(self, name: str, content: dict[str, Any]) -> None:
        (self._folder / name).write_text(json.dumps(content, indent=4) + "\n")


def _features_of(rows: Sequence[Row], recording: Recording) -> tuple[Features, dict[str, NDArray[Any]]]:
    """Features and values of the columns; names of touch columns contain the skin's name."""
    skin = recording.skin.strip("/").replace("/", "_") or "skin"
    image = np.stack([row.image for row in rows])
    height, width = image.shape[1:]
    greys = np.rint(np.arange(COUNT_MAX + 1) * (255.0 / COUNT_MAX)).astype(np.uint8)
    grey = greys.take(image, mode="clip")
    columns: dict[str, NDArray[Any]] = {
        # The three channels are one in memory.
        f"observation.images.{skin}": np.broadcast_to(grey[..., np.newaxis], (*grey.shape, 3)),
        # In one dimension, as all that is no picture: lerobot reads matrices, but its tools cannot write them.
        f"observation.tactile.{skin}": image.reshape(len(rows), -1).astype(np.float32),
    }
    names: dict[str, Any] = {
        f"observation.images.{skin}": ["height", "width", "channels"],
        f"observation.tactile.{skin}": [f"taxel_{r}_{c}" for r in range(height) for c in range(width)],
    }
    contact = [row.contact for row in rows if row.contact is not None]
    if contact:
        columns[f"observation.contact.{skin}"] = np.stack(contact).astype(np.float32)
        names[f"observation.contact.{skin}"] = list(CONTACT_COLUMNS)
    if rows[0].contacts is not None:
        columns[f"observation.contacts.{skin}"] = np.stack([_padded(row.contacts) for row in rows])
        names[f"observation.contacts.{skin}"] = [
            f"{rank}.{name}" for rank in range(MAX_BLOBS) for name in CONTACTS_COLUMNS
        ]
    joints = [row.joints for row in rows if row.joints is not None]
    if joints:
        columns["observation.state"] = np.stack(joints).astype(np.float32)
        names["observation.state"] = list(recording.joint_columns)
    features: Features = {
        name: {
            "dtype": "image" if name.startswith("observation.images") else str(values.dtype),
            "shape": list(values.shape[1:]),
            "names": names[name],
        }
        for name, values in columns.items()
    }
    for name in ("timestamp", "frame_index", "episode_index", "index", "task_index"):
        features[name] = {"dtype": "float32" if name == "timestamp" else "int64", "shape": [1], "names": None}
    return features, columns


def _padded(contacts: NDArray[np.float64] | None) -> NDArray[np.float32]:
    """The contacts of a row, one after another; zeros after the last."""
    padded = np.zeros((MAX_BLOBS, len(CONTACTS_COLUMNS)), dtype=np.float32)
    if contacts is not None:
        kept = contacts[:MAX_BLOBS]
        padded[: len(kept)] = kept
    return padded.ravel()


def _png(pixels: NDArray[np.uint8]) -> bytes:
    file = io.BytesIO()
    PngImage.fromarray(pixels).save(file, format="PNG")
    return file.getvalue()


def _described(features: Features) -> str:
    return ", ".join(f"{name} {feature['shape']}" for name, feature in features.items() if name.startswith("obs"))
