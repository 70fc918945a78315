# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Files of figures: numbers as JSON and CSV, each with the command and the seed that made them."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from acts_core.errors import RecordingError
from acts_core.files import write_whole
from acts_tools.progress import tell

_DIGEST = "digest"


def read_stamped(path: Path, settings: Mapping[str, Any]) -> dict[str, Any] | None:
    """The content of a JSON file that was made with the same settings; None where there is none.

    Nor where it was changed since: that is told.
    """
    try:
        found = json.loads(path.read_text())
    except (OSError, ValueError):
        return None
    if not isinstance(found, dict) or any(found.get(name) != value for name, value in settings.items()):
        return None
    if found.pop(_DIGEST, "") != _digest(json.dumps(found)):
        tell(f"{path}: was changed since it was written, and is made anew", sys.stderr)
        return None
    return found


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def write_stamped(path: Path, content: Mapping[str, Any]) -> None:
    """Write a JSON file as a whole or not at all, so that an interruption leaves no half of it.

    Raises
    ------
    RecordingError
        When it cannot be written.
    """
    try:
        text = json.dumps({**content, _DIGEST: _digest(json.dumps(content))}, allow_nan=False)
    except ValueError as error:
        raise RecordingError(f"{path}: a number is not finite ({error}); please report this") from error
    with write_whole(path, error=RecordingError, makes_folder=True) as file:
        file.write(f"{text}\n".encode())


def write_csv(path: Path, command: str, header: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
    """Write a CSV file whose first line, a comment, is the command; numbers have six digits, those in JSON have all.

    Raises
    ------
    RecordingError
        When it cannot be written.
    """
    text = io.StringIO()
    text.write(f"# {command}\n")
    writer = csv.writer(text)
    writer.writerow(header)
    writer.writerows([_short(value) for value in row] for row in rows)
    with write_whole(path, error=RecordingError) as file:
        file.write(text.getvalue().encode())


def _short(value: Any) -> Any:
    return f"{value:.6g}" if isinstance(value, float) else value


def write_images(path: Path, command: str, images: Mapping[str, Sequence[Sequence[float]]]) -> None:
    """Write images to a compressed npz file, each as an array of its name, and the command as `command`.

    Raises
    ------
    RecordingError
        When it cannot be written.
    """
    arrays: dict[str, Any] = {name: np.array(image, "f4") for name, image in images.items()}
    with write_whole(path, error=RecordingError) as file:
        np.savez_compressed(file, command=np.array(command), **arrays)
