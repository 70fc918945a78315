# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The structure of the code: imports between packages point one way, a subpackage has one subject, nothing is circular.

A subpackage is imported by its `__init__`: what that exports is public, all else is private. Programs begin in the
subpackages `nodes`, `process`, `processes` and `executables`, and `bags` needs a library that not all have: their
modules are imported one by one, so that a program loads no more than it needs.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MODULES_MAX = 12
ENTRANCES = {"bags", "nodes", "process", "processes", "executables"}

LAYERS = (
    {"acts_core"},
    {"acts_ros"},
    {"acts_driver", "acts_recon", "acts_control", "acts_sim"},
    {"acts_skins", "acts_view"},
    {"acts_tools"},
)
"""Packages may import from those of earlier lines, and from themselves."""

LIBRARIES = set().union(*LAYERS[:3])
"""Packages whose subpackages are closed. Those of acts_tools are not: they are commands and their parts."""


@dataclass(frozen=True)
class Import:
    """One name that a module imports: where from, and the module that it is taken out of."""

    importer: str
    source: str
    name: str


def modules() -> dict[str, Path]:
    """All modules of all packages by their dotted names."""
    found = {}
    for package in set().union(*LAYERS):
        for path in (ROOT / package / package).rglob("*.py"):
            parts = path.relative_to(ROOT / package).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


MODULES = modules()
SUBPACKAGES = {name for name, path in MODULES.items() if path.name == "__init__.py"}


def subpackage_of(module: str) -> str:
    """The folder that a module lies in; of a folder, itself."""
    return module if module in SUBPACKAGES else module.rpartition(".")[0]


def imports(module: str) -> Iterator[Import]:
    """What a module imports from this project, at whatever place in it."""
    for node in ast.walk(ast.parse(MODULES[module].read_text())):
        if isinstance(node, ast.ImportFrom) and node.module in MODULES:
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                yield Import(module, whole if whole in MODULES else node.module, alias.name)
        elif isinstance(node, ast.Import):
            yield from (Import(module, alias.name, "") for alias in node.names if alias.name in MODULES)


@cache
def edges() -> list[Import]:
    """All imports within the project; read once, and not where tests are only listed."""
    return [edge for module in MODULES for edge in imports(module)]


@cache
def exported(subpackage: str) -> set[str]:
    """What a subpackage's `__init__` names in `__all__`."""
    for node in ast.parse(MODULES[subpackage].read_text()).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return set(ast.literal_eval(node.value))
    return set()


def test_there_is_a_house_to_look_at() -> None:
    assert len(MODULES) > 300
    assert len(edges()) > 1500
    assert len(SUBPACKAGES) > 40


def test_imports_between_packages_point_one_way() -> None:
    allowed: dict[str, set[str]] = {}
    before: set[str] = set()
    for layer in LAYERS:
        allowed.update({package: before | {package} for package in layer})
        before = before | layer
    wrong = {
        f"{edge.importer} imports {edge.source}"
        for edge in edges()
        if edge.source.split(".")[0] not in allowed[edge.importer.split(".")[0]]
    }
    assert not wrong


def test_a_subpackage_is_entered_by_what_it_exports() -> None:
    wrong = set()
    for edge in edges():
        subpackage = subpackage_of(edge.source)
        package, _, inner = subpackage.partition(".")
        if package not in LIBRARIES or not inner or subpackage == subpackage_of(edge.importer):
            continue
        if subpackage.rpartition(".")[2] in ENTRANCES:
            continue
        by_init = edge.source == subpackage or f"{subpackage}.{edge.name}" == edge.source
        if not by_init or (edge.name not in exported(subpackage) and edge.source not in SUBPACKAGES):
            wrong.add(f"{edge.importer} imports {edge.name} from {edge.source}")
    assert not wrong


def test_modules_do_not_import_one_another_in_circles() -> None:
    graph: dict[str, set[str]] = {}
    for edge in edges():
        # A name out of the own subpackage's __init__ would be one; what is outside of the subpackage enters by it.
        if edge.source != edge.importer:
            graph.setdefault(edge.importer, set()).add(edge.source)
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


def test_folders_side_by_side_in_acts_tools_do_not_import_one_another_in_circles() -> None:
    """A folder and one within it may: the command of a folder loads what these do, and they share its modules."""
    graphs: dict[str, dict[str, set[str]]] = {}
    for edge in edges():
        importer, source = subpackage_of(edge.importer).split("."), subpackage_of(edge.source).split(".")
        # The first folder of each that is not the other's, too.
        apart = next((n for n, (one, other) in enumerate(zip(importer, source, strict=False)) if one != other), 0)
        if apart and importer[0] == "acts_tools":
            graphs.setdefault(".".join(importer[:apart]), {}).setdefault(importer[apart], set()).add(source[apart])
    assert {"acts_tools", "acts_tools.bench", "acts_tools.evaluate", "acts_tools.figures"} <= set(graphs)
    circles = {}
    for folder, graph in graphs.items():
        try:
            TopologicalSorter(graph).prepare()
        except CycleError as error:
            circles[folder] = " -> ".join(error.args[1])
    assert circles == {}


@pytest.mark.parametrize(
    "subpackage",
    sorted(subpackage for subpackage in SUBPACKAGES if subpackage.split(".")[0] in LIBRARIES and "." in subpackage),
)
def test_a_subpackage_says_what_it_is_for_and_exports_what_exists(subpackage: str) -> None:
    tree = ast.parse(MODULES[subpackage].read_text())
    assert len(ast.get_docstring(tree) or "") > 40
    taken = {
        alias.asname or alias.name for node in tree.body if isinstance(node, ast.ImportFrom) for alias in node.names
    }
    if subpackage.rpartition(".")[2] not in ENTRANCES:
        assert taken == exported(subpackage)


def test_subpackages_are_small_enough_to_look_around_in() -> None:
    counts = {
        subpackage: sum(path.parent == MODULES[subpackage].parent for path in MODULES.values()) - 1
        for subpackage in SUBPACKAGES
    }
    assert {subpackage: n for subpackage, n in counts.items() if n > MODULES_MAX} == {}


def test_folders_of_tests_are_no_larger() -> None:
    found = Counter(path.parent for folder in ("acts_*/test", "test") for path in ROOT.glob(f"{folder}/**/*.py"))
    assert len(found) > 30
    assert {str(folder): n for folder, n in found.items() if n > MODULES_MAX} == {}


def test_folders_of_cpp_are_no_larger() -> None:
    sources = {path.with_suffix("") for suffix in ("cpp", "hpp") for path in ROOT.glob(f"acts_firmware/**/*.{suffix}")}
    found = Counter(path.parent for path in sources)
    assert len(found) > 10
    assert {str(folder): n for folder, n in found.items() if n > MODULES_MAX} == {}


def test_all_folders_of_tests_are_run(pytestconfig: pytest.Config) -> None:
    folders = {str(path.relative_to(ROOT)) for path in [ROOT / "test", *ROOT.glob("acts_*/test")]}
    assert sorted(pytestconfig.getini("testpaths")) == sorted(folders)
