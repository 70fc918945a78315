# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Touch of a bag as tables: what is left out is told, and what nobody can mean is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from test_export import pressed, rows_of, samples, write_bag

from acts_core.errors import RecordingError
from acts_tools.export.recording import Choice, open_recording


def test_frames_that_do_not_fit_are_left_out_and_told(tmp_path: Path) -> None:
    """The node reconstruction leaves them out, too."""
    beyond, small = samples(20, pressed(2)), samples(30, np.zeros((8, 8), np.uint16))
    beyond.indices[5] = 2000
    path = write_bag(
        tmp_path / "b",
        *(("/plate/samples", one) for one in (samples(10, pressed(1)), beyond, small, samples(40, pressed(4)))),
    )
    with open_recording(path, Choice()) as recording:
        assert [round(row.time_s * 1e3) for row in recording.rows()] == [0, 30]
        (note,) = recording.notes()
    assert note.startswith("2 frames left out, of which the first is message 1 of /plate/samples in ")
    assert "2000" in note


def test_a_bag_in_which_no_frame_fits_is_refused(tmp_path: Path) -> None:
    beyond = samples(20, pressed(2))
    beyond.indices[5] = 2000
    path = write_bag(tmp_path / "b", ("/plate/samples", beyond))
    with pytest.raises(RecordingError, match=r"message 0 of /plate/samples in .*2000"):
        rows_of(path)
