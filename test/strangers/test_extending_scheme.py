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
from acts_tools.evaluate.images.board_sampler import BoardSampler, scheme_table
from acts_tools.cli import main

library = Path(sys.argv[1])
assert "comb_step\\ttaxels from one of a comb frame to the next\\t5\\t1\\t64" in scheme_table(library)
frames = np.random.default_rng(0).integers(0, 1024, (1, 9, 7)).astype(np.uint16)
for step in (1, 3, 5, 64):
    config = SamplingConfig("comb", 9, 7, 20, comb_step=step)
    python, board = Sampler(config), BoardSampler(config, library=library)
    for _ in range(8):
        expected = python.frame(measure_in(frames[0]))
        assert len(set(expected[0].tolist())) == 20
        np.testing.assert_array_equal(board.frame(frames, 0, 0), expected)

wanted = DriverSettings(scheme="comb", comb_step=7, m=20).wanted(BoardSettings())
assert (wanted.scheme, wanted.comb_step) == ("comb", 7)
assert BoardSettings.from_bytes(wanted.to_bytes()) == wanted
sys.exit(main(sys.argv[2:]))
"""


def code_of(language: str, begin: str) -> str:
    """The page's code in a language that begins so, with the next free numbers in place of the page's."""
    (code,) = (code for code in re.findall(rf"```{language}\n(.*?)```", SECTION, re.DOTALL) if code.startswith(begin))
    number = SCHEME_NUMBERS.get("comb", max(SCHEME_NUMBERS.values()) + 1)
    own = next((key for key, its in BOARD_OWN_SETTINGS.items() if its.name == "comb_step"), max(BOARD_OWN_SETTINGS) + 1)
    for pattern, given in (
        (r"(?<=\n    number = )\d+", number),
        (r"(?<=Scheme\{)\d+", number),
        (r"(?<= number=)\d+", own),
        (r"(?<=kStep = \{)\d+", own),
    ):
        code = re.sub(pattern, str(given), code)
    return str(code)


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
            if path.name not in ("sampling", "schemes", "__pycache__", "comb.py"):
                (folder / "acts_core" / part / path.name).symlink_to(path)
    (folder / "acts_core/sampling/schemes/comb.py").write_text(code)
    return {**os.environ, "PYTHONPATH": f"{folder}:{os.environ.get('PYTHONPATH', '')}"}


def compiled(folder: Path) -> Path:
    """The firmware's sampler with the pair of files and the two lines that the page asks for."""
    shutil.copytree(FIRMWARE / "src", folder)
    (folder / SCHEMES / "comb.hpp").write_text(code_of("cpp", "// Comb"))
    (folder / SCHEMES / "comb.cpp").write_text(code_of("cpp", "#include"))
    registry = folder / SCHEMES.with_suffix(".hpp")
    lines = registry.read_text()
    if "Comb," not in lines:
        lines = lines.replace("SchemeList<", "SchemeList<Comb, ").replace(
            "#include", f'#include "{SCHEMES}/comb.hpp"\n#include', 1
        )
        registry.write_text(lines)
    sources = [*folder.glob("acts_firmware/sampling/**/*.cpp"), *folder.glob("acts_firmware/wire/*.cpp")]
    library = folder / "libexample_sampler.so"
    subprocess.run(
        [
            "c++",
            "-std=c++17",
            "-shared",
            "-fPIC",
            *WARNINGS,
            "-I",
            folder,
            FIRMWARE / "host/sampler_library.cpp",
            *sources,
            "-o",
            library,
        ],
        check=True,
        timeout=120,
    )
    return library


def run(arguments: list[str], environment: dict[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", *arguments], capture_output=True, text=True, timeout=60, check=False, env=environment
    )


def test_both_languages_sample_the_same_and_it_is_evaluated(tmp_path: Path) -> None:
    library = compiled(tmp_path / "firmware")
    words = ["evaluate", "recovery", "--presses", "1", "--scheme", "comb", "--m", "55", "--method", "zero"]
    result = run([PROGRAM, str(library), *words, "--comb-step", "3"], with_example(tmp_path, python_code()))
    assert result.returncode == 0, result.stderr
    assert [line.split()[:3] for line in result.stdout.splitlines() if line.startswith("comb")] == [
        ["comb", "55", "zero"]
    ]


def test_driver_and_board_refuse_what_exists_in_python_only(tmp_path: Path) -> None:
    asked = "from acts_core.settings import from_mapping; from acts_driver.settings import DriverSettings;"
    asked += "from acts_core.wire import BoardSettings; from_mapping({}, {{'scheme': 'comb'}})"
    environment = with_example(tmp_path, without_number(python_code()))
    for settings_class in ("BoardSettings", "DriverSettings"):
        result = run([asked.format(settings_class)], environment)
        assert result.returncode == 1
        assert "scheme = 'comb': allowed is one of" in result.stderr


def test_a_scheme_without_a_number_is_sampled_in_python_beside_those_of_the_firmware(tmp_path: Path) -> None:
    asked = "from acts_core.sampling import SamplingConfig\n"
    asked += "from acts_tools.evaluate.images.board_sampler import sampler_of\n"
    asked += "print(type(sampler_of(SamplingConfig('tracking', 32, 32, 55))).__name__)\n"
    asked += "print(type(sampler_of(SamplingConfig('comb', 32, 32, 55))).__name__)"
    result = run([asked], with_example(tmp_path, without_number(python_code())))
    assert result.stdout.split() == ["BoardSampler", "PythonSampler"], result.stderr
