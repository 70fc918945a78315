# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A file with diagrams."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from acts_tools.output_file import save_picture


@contextmanager
def diagrams(path: Path, rows: int, columns: int, *, size_inch: tuple[float, float], dpi: int) -> Iterator[list[Any]]:
    """Axes of matplotlib to draw on, row by row; at the end of the block they are written.

    Raises
    ------
    RecordingError
        When the file cannot be written.
    """
    # Imported here, because it is slow to import.
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(rows, columns, figsize=size_inch, layout="constrained", squeeze=False)
    try:
        yield list(axes.flat)
        save_picture(figure, path, dpi=dpi)
    finally:
        plt.close(figure)
