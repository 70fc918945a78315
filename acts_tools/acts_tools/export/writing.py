# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Write bags in a format, and tell the user of each."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from acts_core.errors import RecordingError
from acts_core.words import counted
from acts_tools.export.lerobot import LeRobotWriter
from acts_tools.export.recording import Recording, open_recording
from acts_tools.export.tables import write_csv, write_npz, write_parquet
from acts_tools.export.topics import Choice

_NOTES_FILE = "notes.txt"
_TABLES = {"csv": write_csv, "npz": write_npz, "parquet": write_parquet}


@contextmanager
def naming(output: Path) -> Iterator[None]:
    """Say of files that cannot be written what they are of."""
    try:
        yield
    except OSError as error:
        raise RecordingError(f"'{output}' cannot be written: {error.strerror or error}") from error


def write_bags(bags: Sequence[Path], kind: str, choice: Choice, task: str, path: Path, output: Path) -> None:
    """Write bags, one of them unless the format takes several, with what is to be noted of them.

    Parameters
    ----------
    bags : sequence of Path
    kind : str
        Format: "lerobot", "csv", "npz" or "parquet".
    choice : Choice
        What of each bag.
    task : str
        Of a LeRobot dataset: what is done in the bags.
    path : Path
        What is made: a file of npz, a folder of the others.
    output : Path
        Where it will be, for messages.

    Raises
    ------
    RecordingError
        A bag cannot be read, has nothing of the choice, or a layout or dead taxels are chosen that nothing is
        recovered with; or it cannot be written.
    OSError
        The user cannot be told, as where the reader of standard output has ended.
    """
    dataset: LeRobotWriter | None = None
    notes: list[str] = []
    uses_layout = False
    for bag in bags:
        with open_recording(bag, choice) as recording:
            uses_layout = uses_layout or recording.uses_layout
            if bag is bags[-1] and not uses_layout and (given := _given_for_recovery(choice)):
                raise RecordingError(
                    f"{given} is of no use: it is for what is recovered from samples, and "
                    f"images and contacts of {recording.skin or '/'} are exported as they were recorded"
                )
            with naming(output):
                if kind == "lerobot":
                    dataset = dataset or LeRobotWriter(path, int(choice.rate_hz), task)
                    n_rows = dataset.add(recording)
                else:
                    n_rows = _TABLES[kind](recording, path)
            _tell(bag, recording, n_rows)
            notes += [f"{bag.resolve().name}: {sentence}\n" for sentence in recording.notes()]
    with naming(output):
        if notes and kind != "npz":
            # A bag's name may be in another encoding.
            (path / _NOTES_FILE).write_text("".join(notes), "utf-8", "surrogateescape")
        if dataset is not None:
            dataset.close()


def _tell(bag: Path, recording: Recording, n_rows: int) -> None:
    joints = f", {counted(len(recording.joint_columns), 'joint column')}" if recording.joint_columns else ""
    print(f"{bag}: {counted(n_rows, 'row')} of {recording.skin or '/'}{joints}")
    for sentence in recording.notes():
        print(f"{bag}: {sentence}", file=sys.stderr)


def _given_for_recovery(choice: Choice) -> str:
    """An option that only recovery from samples uses, as it was given; empty without any."""
    if choice.layout != Choice.layout:
        return f"--layout {choice.layout}"
    return f"--dead-taxels '{choice.dead_taxels}'" if choice.dead_taxels else ""
