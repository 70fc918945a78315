# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Files that users name: read with limits, checked, and refused with the reason.

In come paths; out come arrays, text, or sections of YAML with the line of each key. Files are written
as a whole or not at all.
"""

from acts_core.files.board_recording import ExportedRecording, export_recording
from acts_core.files.frames_file import (
    RATES,
    FramesFile,
    is_rate,
    load_frames,
    recordings_of,
    without_contact,
)
from acts_core.files.model_file import ModelFile, settings_field
from acts_core.files.npz_file import UNPACKED_BYTES_MAX, half_of_memory_bytes, npz_names, read_npz, unpacked_bytes
from acts_core.files.private_files import FileClaim, make_private
from acts_core.files.regular_file import TEXT_BYTES_MAX, is_there, path_of, read_text, require_regular
from acts_core.files.whole_file import write_array, write_whole
from acts_core.files.yaml_places import Section, is_number, read_yaml, shown

__all__ = [
    "RATES",
    "TEXT_BYTES_MAX",
    "UNPACKED_BYTES_MAX",
    "ExportedRecording",
    "FileClaim",
    "FramesFile",
    "ModelFile",
    "Section",
    "export_recording",
    "half_of_memory_bytes",
    "is_number",
    "is_rate",
    "is_there",
    "load_frames",
    "make_private",
    "npz_names",
    "path_of",
    "read_npz",
    "read_text",
    "read_yaml",
    "recordings_of",
    "require_regular",
    "settings_field",
    "shown",
    "unpacked_bytes",
    "without_contact",
    "write_array",
    "write_whole",
]
