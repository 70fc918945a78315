# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Compare what the packages import and whose files they take with what their package.xml declare; part of `make lint`.

An undeclared dependency is noticed only on a machine that happens to lack it.
"""

from __future__ import annotations

import ast
import sys
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# rosdep keys of what is imported by another name; packages of ROS and our own are keys themselves.
KEYS = {
    "hypothesis": "python3-hypothesis",
    "matplotlib": "python3-matplotlib",
    "numba": "python3-numba",
    "numpy": "python3-numpy",
    "PIL": "python3-pil",
    "psutil": "python3-psutil",
    "pytest": "python3-pytest",
    "scipy": "python3-scipy",
    "serial": "python3-serial",
    "tqdm": "python3-tqdm",
    "yaml": "python3-yaml",
}
# Without a key: they are in requirements-ros.txt, or a command that needs one says how to install it.
WITHOUT_KEY = {"dashboard_client", "mujoco", "playwright", "pyarrow", "rosbags", "rtde_control", "rtde_receive"}
WITHOUT_KEY |= {"backports", "compression", "lz4"}  # rosbags brings them
WITHOUT_KEY |= {"websockets"}
# What finds the files that a package installs.
SHARES = ("get_package_share_directory", "get_package_prefix", "packages.share")
# Modules for the tests of all packages: who imports one needs what it imports.
SHARED = {path.stem: path for path in (ROOT / "test").glob("*.py")}
EXECUTION = ("depend", "exec_depend")
TESTS = (*EXECUTION, "test_depend")


def imported(folder: Path) -> set[str]:
    """Names of the modules that are imported and of the packages whose installed files are taken.

    Anywhere in a folder, without those of Python and of the folder itself.
    """
    files: set[Path] = set()
    names: set[str] = set()
    more = set(folder.rglob("*.py"))
    while more:
        files |= more
        names |= {name.split(".")[0] for file in more for name in _names(ast.parse(file.read_bytes()))}
        more = {SHARED[name] for name in names & SHARED.keys()} - files
    return names - sys.stdlib_module_names - {file.stem for file in files} - WITHOUT_KEY


def _names(tree: ast.Module) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield node.module
        elif isinstance(node, ast.Call) and ast.unparse(node.func) in SHARES:
            yield from (str(argument.value) for argument in node.args[:1] if isinstance(argument, ast.Constant))


def complaints(manifest: Path) -> list[str]:
    """What is wrong with one package.xml, in words."""
    folder = manifest.parent
    root = ET.parse(manifest).getroot()
    name = root.findtext("name") or ""
    declared = [(element.tag, element.text or "") for element in root if element.tag.endswith("depend")]
    source = folder / name
    # A package of tests alone has them beside its package.xml.
    tests = folder / "test" if (folder / "test").is_dir() else folder
    for_use = {KEYS.get(module, module) for module in imported(source) - {name}} if source.is_dir() else set()
    for_tests = {KEYS.get(module, module) for module in imported(tests) - {name}} if source != tests else set()
    known = {
        kind: {key for tag, key in declared if tag in tags} for kind, tags in (("use", EXECUTION), ("test", TESTS))
    }
    found = [f"lacks <exec_depend>{key}</exec_depend>" for key in sorted(for_use - known["use"])]
    found += [f"lacks <test_depend>{key}</test_depend>" for key in sorted(for_tests - for_use - known["test"])]
    twice = [key for (_, key), count in Counter(declared).items() if count > 1]
    twice += [key for tag, key in declared if tag == "test_depend" and key in known["use"]]
    found += [f"names {key} twice" for key in sorted(set(twice))]
    unused = known["test"] & set(KEYS.values()) - for_use - for_tests
    if source.is_dir():
        unused |= known["use"] & set(KEYS.values()) - for_use
    return found + [f"names {key}, which nothing imports" for key in sorted(unused)]


def main() -> int:
    """Check all packages; 1 where something is wrong."""
    found = [
        f"{manifest.relative_to(ROOT)}: {complaint}"
        for manifest in sorted(ROOT.glob("*/package.xml"))
        for complaint in complaints(manifest)
    ]
    print("\n".join(found), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
