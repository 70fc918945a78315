# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The sampling scheme of docs/extending.md: evaluated, refused and sampled as that page says."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import acts_core
from acts_core.sampling import BOARD_OWN_SETTINGS, SCHEME_NUMBERS

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
SECTION = (ROOT / "docs/extending.md").read_text().split("\n## A sampling scheme\n")[1].split("\n## ")[0]
FIRMWARE = ROOT / "acts_firmware"
SCHEMES = Path("acts_firmware/sampling/schemes")
WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror")

PROGRAM = """
import sys
from pathlib import Path
import numpy as np
from acts_core.sampling import SamplingConfig, Sampler, measure_in
from acts_core.wire import BoardSettings
from acts_driver.settings import DriverSettings
from acts_tools.firmware.board_sampler import BoardSampler, scheme_table
from acts_tools.cli import main

library = Path(sys.argv[1])
assert "page_comb_step\\ttaxels from one of a page_comb frame to the next\\t5\\t1\\t64" in scheme_table(library)
frames = np.random.default_rng(0).integers(0, 1024, (1, 9, 7)).astype(np.uint16)
for step in (1, 3, 5, 64):
    config = SamplingConfig("page_comb", 9, 7, 20, page_comb_step=step)
    python, board = Sampler(config), BoardSampler(config, library=library)
    for _ in range(8):
        expected = python.frame(measure_in(frames[0]))
        assert len(set(expected[0].tolist())) == 20
        np.testing.assert_array_equal(board.frame(frames, 0, 0), expected)

wanted = DriverSettings(scheme="page_comb", page_comb_step=7, m=20).wanted(BoardSettings())
assert (wanted.scheme, wanted.page_comb_step) == ("page_comb", 7)
assert BoardSettings.from_bytes(wanted.to_bytes()) == wanted
sys.exit(main(sys.argv[2:]))
"""


def code_of(language: str, begin: str) -> str:
    """The page's code in a language that begins so, under a name and with numbers that no scheme here has."""
    (code,) = (code for code in re.findall(rf"```{language}\n(.*?)```", SECTION, re.DOTALL) if code.startswith(begin))
    own, scheme = max(BOARD_OWN_SETTINGS) + 1, max(SCHEME_NUMBERS.values()) + 1
    code = re.sub(r"(?<=number=)\d+|(?<=kStep = \{)\d+", str(own), code)
    code = re.sub(r"(?<=    number = )\d+|(?<=Scheme\{)\d+", str(scheme), code)
    return code.replace("comb", "page_comb").replace("Comb", "PageComb")


def python_code() -> str:
    return code_of("python", '"""Comb')


def without_number(code: str) -> str:
    return re.sub(r"\n    number = \d+", "", code)


def with_example(folder: Path, code: str) -> dict[str, str]:
    """An environment in which acts_core has the example, and all else is as it is."""
    package = Path(acts_core.__file__).parent
    for part in (Path(), Path("sampling"), Path("sampling/schemes")):
        (folder / "acts_core" / part).mkdir(parents=True)
        for path in (package / part).iterdir():
            if path.name not in ("sampling", "schemes", "__pycache__"):
                (folder / "acts_core" / part / path.name).symlink_to(path)
    (folder / "acts_core/sampling/schemes/page_comb.py").write_text(code)
    return {**os.environ, "PYTHONPATH": f"{folder}:{os.environ.get('PYTHONPATH', '')}"}


def compiled(folder: Path) -> Path:
    """The firmware's sampler with the pair of files and the two lines that the page asks for."""
    shutil.copytree(FIRMWARE / "src", folder)
    (folder / SCHEMES / "page_comb.hpp").write_text(code_of("cpp", "// Comb"))
    (folder / SCHEMES / "page_comb.cpp").write_text(code_of("cpp", "#include"))
    registry = folder / SCHEMES.with_suffix(".hpp")
    registry.write_text(
        registry.read_text()
        .replace("#include", f'#include "{SCHEMES}/page_comb.hpp"\n#include', 1)
        .replace("SchemeList<", "SchemeList<PageComb, ")
    )
    sources = [*folder.glob("acts_firmware/sampling/**/*.cpp"), *folder.glob("acts_firmware/wire/*.cpp")]
    sources.append(FIRMWARE / "host/sampler_library.cpp")
    library = folder / "libexample_sampler.so"
    compiler = ["c++", "-std=c++17", "-shared", "-fPIC", *WARNINGS]
    subprocess.run([*compiler, "-I", folder, *sources, "-o", library], check=True, timeout=120)
    return library


def run(arguments: list[str], environment: dict[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", *arguments], capture_output=True, text=True, timeout=60, check=False, env=environment
    )


def test_both_languages_sample_the_same_and_it_is_evaluated(tmp_path: Path) -> None:
    library = compiled(tmp_path / "firmware")
    words = ["evaluate", "recovery", "--presses", "1", "--scheme", "page_comb", "--m", "55", "--method", "zero"]
    result = run([PROGRAM, str(library), *words, "--page-comb-step", "3"], with_example(tmp_path, python_code()))
    assert result.returncode == 0, result.stderr
    assert [line.split()[:3] for line in result.stdout.splitlines() if line.startswith("page_comb")] == [
        ["page_comb", "55", "zero"]
    ]


def test_driver_and_board_refuse_what_exists_in_python_only(tmp_path: Path) -> None:
    asked = "from acts_core.settings import from_mapping; from acts_driver.settings import DriverSettings;"
    asked += "from acts_core.wire import BoardSettings; from_mapping({}, {{'scheme': 'page_comb'}})"
    environment = with_example(tmp_path, without_number(python_code()))
    for settings_class in ("BoardSettings", "DriverSettings"):
        result = run([asked.format(settings_class)], environment)
        assert result.returncode == 1
        assert "scheme = 'page_comb': allowed is one of" in result.stderr


def test_a_scheme_whose_setting_would_replace_a_parameter_of_the_driver_is_refused(tmp_path: Path) -> None:
    environment = with_example(tmp_path, python_code().replace("page_comb_step", "baud"))
    result = run(["import acts_driver.settings"], environment)
    assert result.returncode == 1
    assert "parameter 'baud' is declared 2 times: begin it with the name of its thing" in result.stderr


@pytest.mark.parametrize(("name", "owner"), [("led", "the board"), ("rate_cap_hz", "the driver")])
def test_a_scheme_whose_setting_is_called_as_one_of_the_board_is_refused(tmp_path: Path, name: str, owner: str) -> None:
    environment = with_example(tmp_path, python_code().replace("page_comb_step", name))
    result = run(["import acts_driver.settings"], environment)
    assert result.returncode == 1
    assert f"own setting {name!r} of scheme 'page_comb': {owner} has one of that name; begin it with" in result.stderr


def test_a_scheme_without_a_number_is_sampled_in_python_beside_those_of_the_firmware(tmp_path: Path) -> None:
    asked = "from acts_core.sampling import SamplingConfig\n"
    asked += "from acts_tools.firmware.board_sampler import sampler_of\n"
    asked += "print(type(sampler_of(SamplingConfig('tracking', 32, 32, 55))).__name__)\n"
    asked += "print(type(sampler_of(SamplingConfig('page_comb', 32, 32, 55))).__name__)"
    result = run([asked], with_example(tmp_path, without_number(python_code())))
    assert result.stdout.split() == ["BoardSampler", "PythonSampler"], result.stderr
