# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The files of the page, read once, by the path they are asked for. Knows no ROS."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
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


def version_of(files: Mapping[str, PageFile]) -> str:
    """The same for the same page; an open page of another one may not understand what this server sends."""
    digest = hashlib.sha256()
    for path, file in sorted(files.items()):
        digest.update(path.encode() + b"\0" + file.body)
    return digest.hexdigest()[:16]
