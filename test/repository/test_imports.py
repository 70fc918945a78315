# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Files of tests start no process when they are imported, because each process that runs tests imports all of them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
STARTERS = (
    "subprocess",
    "multiprocessing",
    "pty.spawn",
    "os.system",
    "os.popen",
    "os.fork",
    "os.spawn",
    "os.posix_spawn",
)
"""How what starts a process begins, by its whole name."""

WORDS = {one.partition(".")[2] or one for one in STARTERS}
"""What stands in every module that names one: the others need not be parsed."""


def at_import(node: ast.AST) -> Iterator[ast.Call]:
    """The calls that are made where a piece of code is run: not those within functions, but their decorators."""
    inner: list[ast.AST] = list(ast.iter_child_nodes(node))
    match node:
        case ast.FunctionDef() | ast.AsyncFunctionDef():
            inner = [*node.decorator_list, node.args]
        case ast.Lambda():
            inner = [node.args]
        case ast.If(test=ast.Compare(left=ast.Name(id="__name__"))):
            inner = []
        case ast.Call():
            yield node
    for child in inner:
        yield from at_import(child)


def whole_names(tree: ast.Module) -> dict[str, str]:
    """What each imported name of a module means, such as `subprocess.run` of `run`."""
    found: dict[str, str] = {}
    for node in ast.walk(tree):
        match node:
            case ast.Import(names=names):
                found.update({one.asname or one.name: one.name for one in names})
            case ast.ImportFrom(module=str(module), names=names):
                found.update({one.asname or one.name: f"{module}.{one.name}" for one in names})
    return found


def started(source: str) -> list[str]:
    """The calls of a module at its import that start a process, also by functions of the same module."""
    tree = ast.parse(source)
    names = whole_names(tree)
    functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
    found: list[str] = []
    waiting, seen = list(at_import(tree)), set()
    while waiting:
        call = waiting.pop()
        first, dot, rest = ast.unparse(call.func).partition(".")
        if f"{names.get(first, first)}{dot}{rest}".startswith(STARTERS):
            found.append(f"line {call.lineno}: {ast.unparse(call)}")
        if not dot and first in functions and first not in seen:
            seen.add(first)
            waiting += [one for part in functions[first].body for one in at_import(part)]
    return found


@pytest.mark.parametrize(
    "source",
    [
        "import subprocess\nDONE = subprocess.run(['true'])",
        "from subprocess import run\n@mark(run(['true']))\ndef test(): pass",
        "from subprocess import Popen as Program\nclass Rig:\n    one = Program(['true'])",
        "import subprocess\ndef version():\n    return subprocess.check_output(['true'])\nVERSION = version()",
        "import os\ndef test(code=os.system('true')): pass",
    ],
)
def test_what_starts_a_process_is_found(source: str) -> None:
    assert len(started(source)) == 1


@pytest.mark.parametrize(
    "source",
    [
        "import subprocess\ndef test():\n    subprocess.run(['true'])",
        "import subprocess\nmake = lambda: subprocess.Popen(['true'])",
        "import subprocess\nif __name__ == '__main__':\n    subprocess.run(['true'])",
        "import os\nHERE = os.getpid()",
    ],
)
def test_what_only_may_start_one_is_not(source: str) -> None:
    assert not started(source)


def test_no_file_of_tests_starts_a_process_when_it_is_imported() -> None:
    found = [*ROOT.glob("acts_*/test/**/*.py"), *ROOT.glob("test/**/*.py"), ROOT / "conftest.py"]
    texts = {path: path.read_text(encoding="utf-8") for path in found if "install" not in path.parts}
    at_fault = {
        str(path.relative_to(ROOT)): calls
        for path, text in texts.items()
        if any(word in text for word in WORDS) and (calls := started(text))
    }
    assert not at_fault
