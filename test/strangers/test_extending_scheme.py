# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The sampling scheme of docs/extending.md: evaluated, refused and sampled as that page says."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import acts_core

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "acts_firmware/test/example_scheme"
CPP = "acts_firmware/sampling/schemes"

# The example is compiled with the firmware's tests (acts_firmware/CMakeLists.txt).
PROGRAM = """
import sys
from pathlib import Path
import numpy as np
from ament_index_python.packages import get_package_prefix
from acts_core.errors import SettingsError
from acts_core.sampling import SamplingConfig, Sampler, measure_in
from acts_core.wire import BoardSettings
from acts_driver.settings import DriverSettings
from acts_tools.evaluate.images.board_sampler import BoardSampler, scheme_table
from acts_tools.cli import main

library = Path(get_package_prefix("acts_firmware")) / "libexec/acts_firmware/test/libexample_sampler.so"
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
assert (wanted.scheme, wanted.comb_step, len(wanted.to_bytes())) == ("comb", 7, 36)
assert BoardSettings.from_bytes(wanted.to_bytes()) == wanted
sys.exit(main(sys.argv[1:]))
"""


def with_example(folder: Path, text: str) -> dict[str, str]:
    """An environment in which acts_core has the example, and nothing else is another."""
    package = Path(acts_core.__file__).parent
    for part in (Path(), Path("sampling"), Path("sampling/schemes")):
        (folder / "acts_core" / part).mkdir(parents=True)
        for path in (package / part).iterdir():
            if path.name not in ("sampling", "schemes", "__pycache__"):
                (folder / "acts_core" / part / path.name).symlink_to(path)
    (folder / "acts_core/sampling/schemes/comb.py").write_text(text)
    return {**os.environ, "PYTHONPATH": f"{folder}:{os.environ.get('PYTHONPATH', '')}"}


def run(arguments: list[str], environment: dict[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", *arguments], capture_output=True, text=True, timeout=60, check=False, env=environment
    )


def test_the_page_shows_what_is_tested() -> None:
    page = (ROOT / "docs/extending.md").read_text()
    # Without the lines of copyright and licence, which every source file has.
    for path, language in (("comb.py", "python"), (f"{CPP}/comb.hpp", "cpp"), (f"{CPP}/comb.cpp", "cpp")):
        code = (EXAMPLE / path).read_text().split("\n\n", 1)[1]
        assert f"```{language}\n{code}```" in page, path


def test_both_languages_sample_the_same_and_it_is_evaluated(tmp_path: Path) -> None:
    words = ["evaluate", "recovery", "--presses", "1", "--scheme", "comb", "--m", "55", "--method", "zero"]
    result = run([PROGRAM, *words, "--comb-step", "3"], with_example(tmp_path, (EXAMPLE / "comb.py").read_text()))
    assert result.returncode == 0, result.stderr
    assert [line.split()[:3] for line in result.stdout.splitlines() if line.startswith("comb")] == [
        ["comb", "55", "zero"]
    ]


def test_driver_and_board_refuse_what_exists_in_python_only(tmp_path: Path) -> None:
    text = (EXAMPLE / "comb.py").read_text().replace("    number = 8\n", "")
    asked = "from acts_core.settings import from_mapping; from acts_driver.settings import DriverSettings;"
    asked += "from acts_core.wire import BoardSettings; from_mapping({}, {{'scheme': 'comb'}})"
    environment = with_example(tmp_path, text)
    for settings_class in ("BoardSettings", "DriverSettings"):
        result = run([asked.format(settings_class)], environment)
        assert result.returncode == 1
        assert "scheme = 'comb': allowed is one of" in result.stderr


def test_a_scheme_without_a_number_is_sampled_in_python_beside_those_of_the_firmware(tmp_path: Path) -> None:
    text = (EXAMPLE / "comb.py").read_text().replace("    number = 8\n", "")
    asked = "from acts_core.sampling import SamplingConfig\n"
    asked += "from acts_tools.evaluate.images.board_sampler import sampler_of\n"
    asked += "print(*(type(sampler_of(SamplingConfig(name, 32, 32, 55))).__name__ for name in ('tracking', 'comb')))"
    result = run([asked], with_example(tmp_path, text))
    assert result.stdout.split() == ["BoardSampler", "PythonSampler"], result.stderr
