# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Kernels that may compute sums in any order are inlined into those that call them: results are always the same.

Every compiled kernel holds a copy of each kernel that it calls, optimised together with it. Which of several copies
runs depends on what else the process has compiled or loaded; where sums may be taken in any order the copies differ in
the last digits.
"""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FASTMATH, INLINE = "fastmath", "inline"


def options(function: ast.FunctionDef) -> set[str] | None:
    """Names of the options of `acts_core.kernels.kernel` that a function is decorated with; None for no kernel."""
    for decorator in function.decorator_list:
        match decorator:
            case ast.Name(id="kernel"):
                return set()
            case ast.Call(func=ast.Name(id="kernel"), keywords=keywords):
                return {keyword.arg or "" for keyword in keywords}
    return None


def called(function: ast.FunctionDef) -> set[str]:
    """Names of what a function calls."""
    names = set()
    for node in ast.walk(function):
        match node:
            case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name)):
                names.add(name)
    return names


def differing(sources: list[str]) -> list[str]:
    """Names of the kernels of which results could differ from process to process."""
    functions = [node for text in sources for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)]
    kernels = [(one, given) for one in functions if (given := options(one)) is not None]
    of_kernels = set().union(*(called(one) for one, _ in kernels))
    return [one.name for one, given in kernels if FASTMATH in given and INLINE not in given and one.name in of_kernels]


@pytest.mark.parametrize(
    ("inner", "found"),
    [
        ("@kernel(fastmath=FASTMATH)", ["total"]),
        ('@kernel(fastmath=FASTMATH, inline="always")', []),
        ("@kernel", []),
    ],
)
def test_a_fast_kernel_that_another_calls_is_found(inner: str, found: list[str]) -> None:
    assert (
        differing([f"{inner}\ndef total(x): ...\n", "@kernel\ndef mean(x):\n    return total(x) / x.size\n"]) == found
    )


def test_each_fast_kernel_that_others_call_is_inlined() -> None:
    sources = [path.read_text() for path in ROOT.glob("acts_*/acts_*/**/*.py")]
    assert differing(sources) == []
