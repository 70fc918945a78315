# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Write two tables of a recording as csv, npz or parquet: its rows, and the contacts of each row."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from contextlib import ExitStack
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_tools.export.arrow import arrow
from acts_tools.export.recording import Recording, Row
from acts_tools.export.tracks import CONTACT_COLUMNS, CONTACTS_COLUMNS

_BATCH_ROWS = 1000


def write_csv(recording: Recording, folder: Path) -> int:
    """Write ``frames.csv`` (taxels row by row at its end) and ``contacts.csv``; return the number of rows."""
    folder.mkdir(parents=True)
    n_rows = 0
    with (
        (folder / "frames.csv").open("w", encoding="utf-8", newline="") as frames,
        (folder / "contacts.csv").open("w", encoding="utf-8", newline="") as one,
    ):
        frame_lines, contact_lines = csv.writer(frames), csv.writer(one)
        contact_lines.writerow(("row", "time_s", *CONTACTS_COLUMNS))
        for row in recording.rows():
            named = _named(row, recording)
            if not n_rows:
                taxels = (f"taxel_{r}_{c}" for r in range(row.image.shape[0]) for c in range(row.image.shape[1]))
                frame_lines.writerow((*named, *taxels))
            frame_lines.writerow(
                (
                    *(f"{value:.9g}" if isinstance(value, float) else value for value in named.values()),
                    *row.image.ravel().tolist(),
                )
            )
            for contact in () if row.contacts is None else row.contacts:
                contact_lines.writerow(
                    (n_rows, f"{row.time_s:.9g}", int(contact[0]), *(f"{x:.9g}" for x in contact[1:]))
                )
            n_rows += 1
    return n_rows


def write_npz(recording: Recording, path: Path) -> int:
    """Write one file with an array per column and ``image``; return the number of rows. All data are held in memory."""
    rows = list(recording.rows())
    columns, contacts = _columns(rows, recording, 0)
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("xb") as file:
        arrays: dict[str, Any] = {"image": np.stack([row.image for row in rows]), **columns}
        arrays |= {f"contacts.{name}": values for name, values in contacts.items()}
        if recording.rate_hz:
            arrays["rate_hz"] = np.array(recording.rate_hz)
        if notes := recording.notes():
            arrays["notes"] = np.array(notes)
        np.savez_compressed(file, **arrays)
    return len(rows)


def write_parquet(recording: Recording, folder: Path) -> int:
    """Write ``frames.parquet`` and ``contacts.parquet``; return the number of rows.

    The column ``image`` contains the taxels row by row; its metadata have the numbers of rows and columns.

    Raises
    ------
    RecordingError
        pyarrow is not installed.
    """
    pa, pq = arrow()
    folder.mkdir(parents=True)
    n_rows = 0
    writers: list[Any] = []
    with ExitStack() as opened:
        for rows in _batches(recording.rows()):
            columns, contacts = _columns(rows, recording, n_rows)
            shape = rows[0].image.shape
            flat = pa.array(np.concatenate([row.image.ravel() for row in rows]))
            image = pa.FixedSizeListArray.from_arrays(flat, shape[0] * shape[1])
            size = {"rows": str(shape[0]), "cols": str(shape[1])}
            frames = pa.table({**columns, "image": image})
            described = [field.with_metadata(size) if field.name == "image" else field for field in frames.schema]
            tables = [frames.cast(pa.schema(described)), pa.table(contacts)]
            if not writers:
                for name, table in zip(("frames", "contacts"), tables, strict=True):
                    # pyarrow itself takes no path with a name in another encoding.
                    file = opened.enter_context((folder / f"{name}.parquet").open("wb"))
                    writers.append(opened.enter_context(pq.ParquetWriter(file, table.schema)))
            for writer, table in zip(writers, tables, strict=True):
                writer.write_table(table)
            n_rows += len(rows)
    return n_rows


def _named(row: Row, recording: Recording) -> dict[str, float | int]:
    named: dict[str, float | int] = {
        "stamp_ns": row.stamp_ns,
        "time_s": row.time_s,
        "image_age_s": row.image_age_s,
    }
    if row.contact is not None:
        named["contact_age_s"] = row.contact_age_s
        named.update(zip((f"contact.{name}" for name in CONTACT_COLUMNS), row.contact.tolist(), strict=True))
    if row.joints is not None:
        named["joints_age_s"] = row.joints_age_s
        named.update(zip(recording.joint_columns, row.joints.tolist(), strict=True))
    return named


def _columns(
    rows: list[Row], recording: Recording, first_row: int
) -> tuple[dict[str, NDArray[Any]], dict[str, NDArray[Any]]]:
    """Columns of the two tables, without the images."""
    named = [_named(row, recording) for row in rows]
    columns = {name: np.array([one[name] for one in named]) for name in named[0]}
    empty = np.zeros((0, len(CONTACTS_COLUMNS)))
    per_row = [empty if row.contacts is None else row.contacts for row in rows]
    values = np.concatenate(per_row)
    counts = [len(one) for one in per_row]
    contacts: dict[str, NDArray[Any]] = {
        "row": np.repeat(np.arange(first_row, first_row + len(rows), dtype=np.int64), counts),
        "time_s": np.repeat(np.array([row.time_s for row in rows]), counts),
        "number": values[:, 0].astype(np.int64),
    }
    contacts.update({name: values[:, place] for place, name in enumerate(CONTACTS_COLUMNS) if place})
    return columns, contacts


def _batches(rows: Iterator[Row]) -> Iterator[list[Row]]:
    while batch := list(islice(rows, _BATCH_ROWS)):
        yield batch
