# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Text with substitutions, such as ``$(var run_dir)/board``: parsing, description and evaluation."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from acts_core.errors import LaunchError
from acts_ros.processes import packages


@dataclass(frozen=True)
class Text:
    """Literal text, with escapes resolved."""

    text: str


@dataclass(frozen=True)
class Substitution:
    """A call such as ``$(env HOME /root)``: its name and arguments."""

    name: str
    arguments: tuple[Template, ...]


Template: TypeAlias = "tuple[Text | Substitution, ...]"
"""Pieces of text and substitutions whose values are joined."""


@dataclass
class Scope:
    """Values for substitutions.

    Attributes
    ----------
    variables : dict of str to str
        Launch arguments and variables; `ros_namespace` is the present namespace, as in the real launch.
    environment : dict of str to str
        Environment of the processes started from here on.
    file : Path
        The launch file being evaluated.
    """

    variables: dict[str, str]
    environment: dict[str, str]
    file: Path


def parse(text: str) -> Template:
    """Parse text with substitutions.

    Parameters
    ----------
    text : str
        Text of an attribute.

    Returns
    -------
    Template
        The pieces; plain text is one piece.

    Raises
    ------
    LaunchError
        The text is not well formed, or has an unsupported substitution; the message points at it.
    """
    return _Parser(text).template()


def describe(template: Template) -> str:
    """The real launch's description of a default that is unknown before launch, like ``LaunchConfig('x') + '/a'``."""
    return " + ".join(
        f"'{piece.text}'" if isinstance(piece, Text) else _SUBSTITUTIONS[piece.name].describe(piece.arguments)
        for piece in template
    )


def plain(template: Template) -> str | None:
    """The text of a template without substitutions, None when it has any."""
    if all(isinstance(piece, Text) for piece in template):
        return "".join(piece.text for piece in template if isinstance(piece, Text))
    return None


def perform(template: Template, scope: Scope) -> str:
    """Evaluate a template.

    Raises
    ------
    LaunchError
        A variable, environment variable or package does not exist.
    """
    return "".join(
        piece.text if isinstance(piece, Text) else _SUBSTITUTIONS[piece.name].perform(piece.arguments, scope)
        for piece in template
    )


def unescape(text: str) -> str:
    r"""Resolve the escapes of plain text: ``\$`` is ``$``."""
    return re.sub(r"\\(.)", r"\1", text)


@dataclass(frozen=True)
class _Kind:
    """Arguments and function of one kind of substitution."""

    arguments: range
    complaint: str
    perform: Callable[[tuple[Template, ...], Scope], str]
    describe: Callable[[tuple[Template, ...]], str]


def _value(arguments: tuple[Template, ...], scope: Scope, values: dict[str, str], what: str) -> str:
    """The value of the name that is the first argument; where there is none, the second argument."""
    name = perform(arguments[0], scope)
    if name in values:
        return values[name]
    if len(arguments) > 1:
        return perform(arguments[1], scope)
    raise LaunchError(f"{what} '{name}' does not exist")


_SUBSTITUTIONS: dict[str, _Kind] = {
    "var": _Kind(
        range(1, 3),
        "var substitution expects 1 or 2 arguments",
        lambda arguments, scope: _value(arguments, scope, scope.variables, "launch configuration"),
        lambda arguments: f"LaunchConfig({describe(arguments[0])})",
    ),
    "env": _Kind(
        range(1, 3),
        "env substitution expects 1 or 2 arguments",
        lambda arguments, scope: _value(arguments, scope, scope.environment, "environment variable"),
        lambda arguments: f"EnvVar({describe(arguments[0])})",
    ),
    "find-pkg-share": _Kind(
        range(1, 2),
        "find package substitutions expect 1 argument",
        lambda arguments, scope: str(packages.share(perform(arguments[0], scope), scope.environment)),
        lambda arguments: f"FindPackageShare(pkg={describe(arguments[0])})",
    ),
    "exec-in-pkg": _Kind(
        range(2, 3),
        "exec-in-package substitution expects 2 arguments",
        lambda arguments, scope: str(
            packages.executable(perform(arguments[1], scope), perform(arguments[0], scope), scope.environment)
        ),
        lambda arguments: f"ExecInPkg(pkg={describe(arguments[1])}, exec={describe(arguments[0])})",
    ),
    "dirname": _Kind(
        range(1),
        "dirname substitution doesn't expect arguments",
        lambda arguments, scope: str(scope.file.parent),
        lambda arguments: "ThisLaunchFileDir()",
    ),
}


class _Parser:
    """Recursive descent parser of one attribute value.

    The grammar is that of the real launch. Outside of substitutions everything but ``$(`` is text. The arguments of a
    substitution are separated by exactly one space; an argument with spaces must be quoted as a whole.
    """

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0

    def template(self) -> Template:
        pieces = self._pieces(end="")
        return pieces or (Text(""),)

    def _pieces(self, end: str) -> Template:
        """Text and substitutions up to an unescaped `end` ("" for the end of the text), which is not consumed."""
        pieces: list[Text | Substitution] = []
        start = self._at
        while self._at < len(self._text) and (not end or self._text[self._at] != end):
            if self._opens():
                self._flush(pieces, start)
                pieces.append(self._substitution(forbidden=end))
                start = self._at
            else:
                self._at += self._step()
        self._flush(pieces, start)
        return tuple(pieces)

    def _opens(self) -> bool:
        """Whether a substitution starts here; as in the real launch, not even after two backslashes."""
        return self._text.startswith("$(", self._at) and not self._text.endswith("\\", 0, self._at)

    def _step(self) -> int:
        """Length of the next character; a backslash escapes the one after it."""
        return 2 if self._text[self._at] == "\\" and self._at + 1 < len(self._text) else 1

    def _flush(self, pieces: list[Text | Substitution], start: int) -> None:
        if self._at > start:
            pieces.append(Text(unescape(self._text[start : self._at])))

    def _substitution(self, forbidden: str) -> Substitution:
        start = self._at
        self._at += 2
        matched = re.compile(r"[A-Za-z][A-Za-z0-9_-]*").match(self._text, self._at)
        if matched is None:
            raise self._error("expected the name of a substitution")
        name = matched.group()
        self._at = matched.end()
        arguments = []
        while self._peek() == " ":
            self._at += 1
            arguments.append(self._argument(forbidden))
        if self._peek() != ")":
            raise self._error("expected `)`" if self._peek() else "the substitution is not closed, expected `)`")
        self._at += 1
        kind = _SUBSTITUTIONS.get(name)
        if kind is None:
            self._at = start
            raise self._error(f"Unknown substitution: {name} (supported: {', '.join(sorted(_SUBSTITUTIONS))})")
        if len(arguments) not in kind.arguments:
            self._at = start
            raise self._error(kind.complaint)
        return Substitution(name, tuple(arguments))

    def _argument(self, forbidden: str) -> Template:
        """One argument; inside of quotes (`forbidden`), the same quote must be escaped."""
        quote = self._peek()
        if not forbidden and quote in ("'", '"'):
            self._at += 1
            pieces = self._pieces(end=quote)
            if self._peek() != quote:
                raise self._error(f"the quote is not closed, expected `{quote}`")
            self._at += 1
            return pieces
        special = {" ", "(", ")", *([forbidden] if forbidden else ["'", '"'])}
        pieces_list: list[Text | Substitution] = []
        start = self._at
        while self._at < len(self._text) and self._text[self._at] not in special:
            if self._opens():
                self._flush(pieces_list, start)
                pieces_list.append(self._substitution(forbidden))
                start = self._at
            else:
                # A backslash does not escape a space here.
                self._at += 1 if self._text.startswith("\\ ", self._at) else self._step()
        self._flush(pieces_list, start)
        if not pieces_list:
            raise self._error("expected an argument; arguments are separated by one space")
        return tuple(pieces_list)

    def _peek(self) -> str:
        return self._text[self._at : self._at + 1]

    def _error(self, message: str) -> LaunchError:
        return LaunchError(f"{message}\n  {self._text}\n  {' ' * self._at}^")
