# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The files of the page, read once, by the path they are asked for. Knows no ROS."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

_PAGE = Path(__file__).parents[1] / "page"

_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
}


class PageFile(NamedTuple):
    """A file as it is served."""

    content_type: str
    body: bytes


def read_page() -> dict[str, PageFile]:
    """All files that are served, by path; nothing else on the machine can be asked for."""
    files = {
        f"/{path.relative_to(_PAGE).as_posix()}": PageFile(_TYPES[path.suffix], path.read_bytes())
        for path in sorted(_PAGE.rglob("*"))
        if path.suffix in _TYPES
    }
    return {"/": files["/index.html"], **files}
