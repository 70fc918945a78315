# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Each ROS domain belongs to one file of tests: files run side by side, and nodes of two would meet."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
NAMED = re.compile(r"ROS_DOMAIN_IDs?:?((?:\s|,|and|to|\d+)+)")
"""How the docstring of a test module names its domains: `ROS_DOMAIN_ID 3`, `ROS_DOMAIN_IDs 3, 5 to 8 and 10`."""

CALLS = {"Bench", "Launch", "LaunchFile", "Peers", "Probe", "Rig", "bench", "launched", "spinning_node", "world"}
"""What takes a domain as its first number."""

WORTH_READING = re.compile(r"domain|__init__\(|\b(" + "|".join(sorted(CALLS)) + r")\(", re.IGNORECASE)
"""What stands in every module that names or uses a domain: the others need not be parsed."""

HIGHEST = 232
"""Of the domains whose ports exist (RTPS 2.5, 9.6.2.3)."""


@cache
def sources() -> dict[Path, ast.Module]:
    """The modules of all tests that may name or use a domain."""
    found = [*ROOT.glob("acts_*/test/**/*.py"), *ROOT.glob("test/**/*.py")]
    paths = sorted(path for path in found if "install" not in path.parts)
    texts = {path: path.read_text(encoding="utf-8") for path in paths}
    return {path: ast.parse(text) for path, text in texts.items() if WORTH_READING.search(text)}


def named(docstring: str) -> set[int]:
    """The domains that a docstring names."""
    found: set[int] = set()
    for listed in NAMED.findall(docstring):
        for first, last in re.findall(r"(\d+)(?:\s+to\s+(\d+))?", listed):
            found.update(range(int(first), int(last or first) + 1))
    return found


def used(tree: ast.Module) -> Iterator[int]:
    """The domains that code asks for by a number."""
    for node in ast.walk(tree):
        match node:
            case ast.keyword(arg="domain_id" | "domain", value=ast.Constant(value=int(domain))):
                yield domain
            case ast.Call(func=ast.Name(id=name), args=arguments) if name in CALLS:
                yield from [one.value for one in arguments if isinstance(one, ast.Constant) and type(one.value) is int][
                    :1
                ]
            case ast.Call(func=ast.Attribute(attr="__init__"), args=[ast.Constant(value=int(domain))]):
                yield domain
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Constant(value=int(domain))) if name.endswith(
                "DOMAIN_ID"
            ):
                yield domain
            case ast.Dict(keys=[None, *_] as keys, values=values):  # with ** of an environment
                for key, value in zip(keys, values, strict=True):
                    if (
                        isinstance(key, ast.Constant)
                        and key.value == "ROS_DOMAIN_ID"
                        and isinstance(value, ast.Constant)
                    ):
                        assert isinstance(value.value, str | int)
                        yield int(value.value)


def test_a_docstring_names_domains_one_by_one_and_by_ranges() -> None:
    assert named("Bags. ROS_DOMAIN_ID 7.") == {7}
    assert named("ROS_DOMAIN_IDs 3, 5 to 8 and 10; robots at 127.0.0.2") == {3, 5, 6, 7, 8, 10}


def test_files_name_the_domains_that_they_use() -> None:
    silent = {}
    for path, tree in sources().items():
        domains = named(ast.get_docstring(tree) or "")
        assert max(domains, default=0) <= HIGHEST, path
        unnamed = set(used(tree)) - domains
        if unnamed:
            silent[str(path.relative_to(ROOT))] = unnamed
    assert not silent


def numbers(tree: ast.Module) -> set[int]:
    """What stands in the code as a number, or as a text of digits."""
    values = [node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)]
    return {int(value) for value in values if type(value) is int or (isinstance(value, str) and value.isdecimal())}


def test_files_use_the_domains_that_they_name() -> None:
    """A helper of tests may take a domain in a way that is not looked for above; another one there shows here."""
    unused = {}
    for path, tree in sources().items():
        left = named(ast.get_docstring(tree) or "") - numbers(tree)
        if left:
            unused[str(path.relative_to(ROOT))] = left
    assert not unused


def test_no_domain_is_named_by_two_files() -> None:
    owners = defaultdict(list)
    for path, tree in sources().items():
        for domain in named(ast.get_docstring(tree) or ""):
            owners[domain].append(str(path.relative_to(ROOT)))
    assert not {domain: files for domain, files in owners.items() if len(files) > 1}
