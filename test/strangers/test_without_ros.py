# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The numerical packages as pip installs them: with what their setup.py declares, and nothing else. No ROS."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from importlib import metadata, util
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("acts_core", "acts_recon", "acts_driver")
IMPORT_ALL = """
import importlib, pkgutil, sys
for package in sys.argv[1:]:
    for module in pkgutil.walk_packages(importlib.import_module(package).__path__, package + "."):
        try:
            importlib.import_module(module.name)
            print(module.name)
        except ModuleNotFoundError as error:
            print(module.name, "lacks", error.name.split(".")[0])
"""
ROS = re.compile(r"rclpy|std_srvs|builtin_interfaces|acts_ros|\w+_msgs")


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the installed packages and links to what they say they need."""
    if util.find_spec("pip") is None:
        pytest.skip("pip is not installed")
    folder = tmp_path_factory.mktemp("without_ros")
    for name in PACKAGES:
        # Elsewhere, because pip leaves build folders in the sources.
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("test", "__pycache__", "*.egg-info"))
    site = folder / "site"
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", "--no-build-isolation"]
    command += ["--use-pep517"]  # an older pip without `wheel` would leave out the commands
    sources = [str(folder / name) for name in PACKAGES]
    done = subprocess.run([*command, "--no-compile", "--target", str(site), *sources], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    for name in requirements(site):
        with suppress(metadata.PackageNotFoundError):
            for path in installed(metadata.distribution(name)):
                (site / path.name).symlink_to(path)
    return site


def installed(distribution: metadata.Distribution) -> Iterator[Path]:
    """Folders and files of a distribution, as they are beside one another."""
    names = {path.parts[0] for path in distribution.files or ()} - {"..", "__pycache__"}
    if not names:  # of a Debian package
        modules = (distribution.read_text("top_level.txt") or "").split()
        names = {name for module in modules for name in (module, f"{module}.py")}
    for path in (Path(str(distribution.locate_file(name))) for name in names):
        if path.exists():
            yield path


def requirements(site: Path) -> Iterator[str]:
    """Names of the distributions that ours need, directly or not."""
    waiting = [word for found in metadata.distributions(path=[str(site)]) for word in found.requires or ()]
    known = set(map(normal, PACKAGES))
    while waiting:
        word = waiting.pop()
        name = normal(re.match(r"[\w.-]+", word)[0])  # type: ignore[index]
        if "extra ==" in word or name in known:
            continue
        known.add(name)
        yield name
        try:
            waiting += metadata.requires(name) or ()
        except metadata.PackageNotFoundError:
            assert ";" in word, f"{name} is needed and not installed here"  # of another system, or another Python


def normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def run(site: Path, *words: str, ends_with: int = 0) -> str:
    """Run Python with nothing but its own library and `site`; what it printed, or the error where it is to end so."""
    environment = {"PATH": os.environ["PATH"], "PYTHONPATH": str(site), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-S", "-s", *words]
    done = subprocess.run(command, env=environment, cwd=site.parent, capture_output=True, text=True, timeout=120)
    assert done.returncode == ends_with, done.stderr
    return done.stderr if ends_with else done.stdout


def test_what_knows_no_ros_needs_only_what_setup_py_declares(site: Path) -> None:
    lines = [line.split() for line in run(site, "-c", IMPORT_ALL, *PACKAGES).splitlines()]
    lacking = {words[0]: words[2] for words in lines if len(words) == 3}
    assert not {module: name for module, name in lacking.items() if not ROS.fullmatch(name)}
    imported = {words[0] for words in lines if len(words) == 1}
    for example in (ROOT / "examples").glob("*.py"):
        assert set(re.findall(r"^from (acts_[\w.]+) import", example.read_text(), re.MULTILINE)) <= imported
    assert not any(module.startswith("acts_core") for module in lacking)
    assert "acts_recon.nodes.reconstruction_node" in lacking, "ROS can be imported: the test is of no use"


@pytest.mark.parametrize("command", ["driver", "reconstruction", "gait"])
def test_the_command_of_a_node_says_that_ros_is_missing(site: Path, command: str) -> None:
    said = run(site, str(site / "bin" / command), ends_with=1)
    assert re.fullmatch(r"error: acts_\w+\.nodes\.\w+_node is a node, and ROS 2 .* is not installed here; .*\n", said)


def test_a_bag_is_refused_in_words(site: Path, tmp_path: Path) -> None:
    (tmp_path / "touch.mcap").touch()
    example = str(ROOT / "examples" / "fuse_recording.py")
    said = run(site, example, str(tmp_path / "touch.mcap"), ends_with=1)
    assert said.startswith(f"error: '{tmp_path}/touch.mcap' is a bag, which needs ROS's packages to be read (")


def test_the_shipped_dictionary_is_installed_with_its_package(site: Path) -> None:
    code = "from acts_recon.sparse.shipped import shipped_dictionary_path as p; print(p())"
    path = Path(run(site, "-c", code).strip())
    assert path.is_relative_to(site)
    assert path.read_bytes() == (ROOT / "acts_recon/acts_recon/sparse/dictionaries" / path.name).read_bytes()


def test_the_shipped_layouts_are_installed_with_their_package(site: Path) -> None:
    code = (
        "from acts_core.skin.layouts import LAYOUTS, layout, layout_path as p\nfor n in LAYOUTS: layout(n); print(p(n))"
    )
    paths = [Path(line) for line in run(site, "-c", code).splitlines()]
    assert sorted(path.name for path in paths) == sorted(
        path.name for path in (ROOT / "acts_core/acts_core/skin/skin_layouts").iterdir()
    )
    assert all(path.is_relative_to(site) for path in paths)
