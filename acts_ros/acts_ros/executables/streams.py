# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Streams of a program: those that who started it has closed, as with ``>&- 2>&-``, and those that lack characters."""

from __future__ import annotations

import io
import os
import sys

_STDOUT, _STDERR = 1, 2


def open_streams() -> None:
    """Let output go nowhere where its stream is closed; to be called before anything else is opened.

    Otherwise a port or a bag that is opened later takes the number of the stream, and gets what libraries in C write to
    that. ROS' executor also asks Python for the error stream.

    A character that a stream has no bytes for, as in the name of a file, is written as its number (``\\xfc``): the
    locale may be of another country, or the name in another encoding. It would end the program.
    """
    while (number := os.open(os.devnull, os.O_RDWR)) <= _STDERR:
        pass
    os.close(number)
    # None where it was closed when Python started.
    sys.stdout = sys.stdout or os.fdopen(_STDOUT, "w", closefd=False)
    sys.stderr = sys.stderr or os.fdopen(_STDERR, "w", closefd=False)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper) and stream.errors == "strict":
            stream.reconfigure(errors="backslashreplace")
