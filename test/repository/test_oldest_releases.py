# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Nothing is used that Humble does not have: rclpy 3.3, and Python 3.10, numpy 1.21 and matplotlib 3.5 of Ubuntu 22.04.

The suite runs on newer ones. Ruff checks the syntax, mypy knows none of these releases. What is here was missing in
one of them, or is easily taken to be there.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

NEWER_RCLPY = {
    "clock_type",
    "event_handler",
    "experimental",
    "logging_service",
    "parameter_client",
    "parameter_event_handler",
    "service_introspection",
    "subscription_content_filter_options",
    "type_description_service",
    "type_hash",
}
"""Modules of Kilted's rclpy that Humble's does not have. An import of one stands in `try`, with one that Humble has."""

NEWER_NUMPY = {"concat", "exceptions", "permute_dims", "trapezoid", "unstack", "vecdot"}
NUMPY_CLASSES = {"dtype", "floating", "integer", "ndarray", "number"}
"""Have no `[...]` before 1.22, outside of annotations, which are not evaluated; `numpy.typing.NDArray` has."""

NEWER_MATPLOTLIB = re.compile(r"loc=\"outside|legend\(.*\bncols=|get_layout_engine|colormaps\.get_cmap")
"""Legends outside of the axes (3.7), `ncols` of a legend (3.6; `ncol` before), layout engines (3.6)."""


def sources() -> list[Path]:
    """All modules of the repository, without what is built."""
    folders = [*ROOT.glob("acts_*"), ROOT / "test", ROOT / "examples", ROOT / "scripts"]
    found = [path for folder in folders for path in folder.rglob("*.py")]
    return sorted(path for path in found if not {"build", "install"} & set(path.relative_to(ROOT).parts))


def findings(text: str) -> Iterator[str]:
    """What a module uses that is too new, each with its line."""
    for found in NEWER_MATPLOTLIB.finditer(text):
        yield f"{text.count(chr(10), 0, found.start()) + 1}: {found[0]}: newer than matplotlib 3.5"
    tree = ast.parse(text)
    nodes = list(ast.walk(tree))
    annotations = [
        node.returns if isinstance(node, ast.FunctionDef) else node.annotation
        for node in nodes
        if isinstance(node, ast.FunctionDef | ast.AnnAssign | ast.arg)
    ]
    in_try = {id(inner) for node in nodes if isinstance(node, ast.Try) for one in node.body for inner in ast.walk(one)}
    annotated = {id(inner) for one in annotations if one is not None for inner in ast.walk(one)}
    for node in nodes:
        match node:
            case ast.ImportFrom(module=str(module)) if id(node) not in in_try:
                package, _, name = module.partition(".")
                if package == "rclpy" and name.partition(".")[0] in NEWER_RCLPY:
                    yield f"{node.lineno}: {module}: newer than Humble's rclpy"
            case ast.Attribute(value=ast.Name(id="np"), attr=name) if name in NEWER_NUMPY:
                yield f"{node.lineno}: np.{name}: newer than numpy 1.21"
            case ast.Subscript(value=ast.Attribute(value=ast.Name(id="np"), attr=name)) if name in NUMPY_CLASSES:
                if id(node) not in annotated:
                    yield f"{node.lineno}: np.{name}[...]: newer than numpy 1.21"
            case ast.BoolOp(op=ast.And(), values=[ast.Call() as first, ast.Call() as second, *_]):
                if (ast.unparse(first.func), ast.unparse(second.func)) == ("isinstance", "issubclass"):
                    # `list[int]` passes for a type there, and issubclass raises TypeError.
                    yield f"{node.lineno}: {ast.unparse(first)}: no class is certain on Python 3.10"


def test_what_is_too_new_is_found() -> None:
    text = """
from rclpy.clock_type import ClockType
try:
    from rclpy.event_handler import SubscriptionEventCallbacks
except ImportError:
    from rclpy.qos_event import SubscriptionEventCallbacks
Grid = np.ndarray[Any, np.dtype[np.float64]]
def area(values: np.ndarray[Any, np.dtype[np.float64]]) -> float:
    return np.trapezoid(values)
figure.legend(handles=handles, loc="outside lower center")
shapes = [one for one in vars(module).values() if isinstance(one, type) and issubclass(one, Shape)]
"""
    lines = {int(finding.partition(":")[0]) for finding in findings(text)}
    assert lines == {2, 7, 9, 10, 11}


@pytest.mark.parametrize("folder", sorted({path.relative_to(ROOT).parts[0] for path in sources()}))
def test_nothing_newer_than_the_oldest_releases_is_used(folder: str) -> None:
    found = [
        f"{path.relative_to(ROOT)}:{finding}"
        for path in sources()
        if path.relative_to(ROOT).parts[0] == folder and path != Path(__file__).resolve()
        for finding in findings(path.read_text(encoding="utf-8"))
    ]
    assert not found, "\n".join(found)
