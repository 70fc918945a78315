# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""XML elements with their lines, which record the attributes that have been read."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from acts_core.errors import LaunchError
from acts_tools.launch.place import Place, PlacedError


@dataclass
class Element:
    """One XML element.

    Attributes
    ----------
    tag : str
        Name of the tag.
    place : Place
        Place of its start.
    """

    tag: str
    place: Place
    attributes: dict[str, str]
    children: list[Element] = field(default_factory=list)
    _read: set[str] = field(default_factory=set)

    def get(self, name: str) -> str | None:
        """Value of an attribute; None if it is not given."""
        self._read.add(name)
        return self.attributes.get(name)

    def require(self, name: str) -> str:
        """Value of a required attribute."""
        value = self.get(name)
        if value is None:
            raise self.error(f"Attribute '{name}' of type '<class 'str'>' not found in Entity '{self.tag}'")
        return value

    def take(self, *tags: str) -> list[Element]:
        """The children; refuse those with other tags."""
        unexpected = sorted({child.tag for child in self.children} - set(tags))
        if unexpected:
            raise self.error(f"Unexpected nested tag(s) found in `{self.tag}`: {_braces(unexpected)}")
        return self.children

    def finish(self) -> None:
        """Refuse attributes that have not been read."""
        unexpected = sorted(set(self.attributes) - self._read)
        if unexpected:
            raise self.error(
                f"Unexpected attribute(s) found in `{self.tag}`: {_braces(unexpected)} "
                f"(known here: {', '.join(sorted(self._read))})"
            )

    def error(self, message: str) -> PlacedError:
        """An error with the place of this element."""
        return PlacedError(f"{self.place}: {message}")


def _braces(names: list[str]) -> str:
    return "{" + ", ".join(repr(name) for name in names) + "}"


def read_xml(path: Path) -> Element:
    """Read an XML file.

    Raises
    ------
    LaunchError
        The file cannot be read or is not well-formed XML.
    """
    try:
        text = path.read_bytes()
    except OSError as error:
        raise LaunchError(f"cannot read the launch file {path}: {error.strerror}") from error
    parser = expat.ParserCreate()
    open_elements: list[Element] = []
    roots: list[Element] = []

    def start(tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag, Place(path, parser.CurrentLineNumber), attributes)
        (open_elements[-1].children if open_elements else roots).append(element)
        open_elements.append(element)

    def end(_tag: str) -> None:
        open_elements.pop()

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        raise PlacedError(f"{path}:{error.lineno}: not well-formed XML: {expat.errors.messages[error.code]}") from error
    except (LookupError, ValueError) as error:
        # Of an encoding that XML has and we have not.
        raise PlacedError(f"{path}:{parser.CurrentLineNumber}: cannot be read: {error}") from error
    return roots[0]
