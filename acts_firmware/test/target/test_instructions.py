# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Instructions that the firmware executes for images and objects, counted on an emulated Teensy processor.

The published times are the virtual board's model. Margins are some tenths of what was counted; an instruction takes
about 0.5 to 2 cycles, which nothing here can tell. Skipped where the cross compiler or QEMU is not installed, unless
ACTS_REQUIRE_FIRMWARE_TOOLS is set.
"""

import json
from typing import Any

import numpy as np
import pytest
from firmware_script import SCRIPT, firmware
from numpy.typing import NDArray

pytestmark = pytest.mark.slow

CLOCK_MHZ = 600
AXIS = [50, 100, 200, 300, 400, 500]
COLUMNS = {"image": AXIS, "object": [30, 60]}
Grid = NDArray[np.float64]


@pytest.fixture(scope="module")
def counted(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    path = tmp_path_factory.mktemp("instructions") / "counts.json"
    result = firmware("--json", str(path), script=SCRIPT.with_name("firmware_instructions.py"))
    assert result.returncode == 0, result.stdout + result.stderr
    return json.loads(path.read_text())


def grid(counted: dict[str, Any], output: str, key: str) -> Grid:
    """One number of each work, a row a size of the model, a column an M; of presses the mean."""
    works = [work for work in counted["works"] if work["output"] == output]
    assert [(work["columns"], work["m"]) for work in works] == [(size, m) for size in COLUMNS[output] for m in AXIS]
    return np.array([np.mean(work[key]) for work in works]).reshape(len(COLUMNS[output]), len(AXIS))


def largest(counted: dict[str, Any], output: str) -> Grid:
    works = [work for work in counted["works"] if work["output"] == output]
    return np.array([max(*work["presses"], work["whole_skin"]) for work in works]).reshape(-1, len(AXIS))


def exponents(values: Grid, output: str) -> tuple[float, float]:
    """With which powers of the model's size and of M they grow, over the whole grid."""
    size, m = np.meshgrid(np.log(COLUMNS[output]), np.log(AXIS), indexing="ij")
    terms = np.stack([size.ravel(), m.ravel(), np.ones(values.size)], axis=1)
    of_size, of_m, _ = np.linalg.lstsq(terms, np.log(values.ravel()), rcond=None)[0]
    return float(of_size), float(of_m)


def ranks(values: Grid) -> Grid:
    return values.ravel().argsort().argsort().astype(float)


def test_a_loop_of_known_length_is_counted_exactly(counted: dict[str, Any]) -> None:
    loops = counted["loops"]
    assert max(loop["turns"] for loop in loops) >= 10_000_000
    (around,) = {loop["instructions"] - 2 * loop["turns"] for loop in loops}
    assert 0 < around < 20


def test_the_same_press_takes_the_same_instructions_again(counted: dict[str, Any]) -> None:
    assert [work["again"] for work in counted["works"]] == [work["presses"][0] for work in counted["works"]]


@pytest.mark.parametrize("output", COLUMNS)
def test_more_measurements_and_columns_take_more_in_the_published_order(counted: dict[str, Any], output: str) -> None:
    mean, published = grid(counted, output, "presses"), grid(counted, output, "published_us")
    for values in (mean, grid(counted, output, "whole_skin")):
        assert np.diff(values, axis=0).min() > 0
        assert np.diff(values, axis=1).min() > 0
    assert np.corrcoef(ranks(mean), ranks(published))[0, 1] > 0.9


def test_images_grow_with_atoms_as_published_and_less_with_measurements(counted: dict[str, Any]) -> None:
    published = exponents(grid(counted, "image", "published_us"), "image")
    press = exponents(grid(counted, "image", "presses"), "image")
    whole = exponents(grid(counted, "image", "whole_skin"), "image")
    assert press[0] == pytest.approx(published[0], abs=0.15)
    assert whole[0] == pytest.approx(published[0], abs=0.15)
    # A press has only so many taxels, and patches without touch are left out; the published board computes them all.
    assert press[1] < published[1] - 0.3
    assert whole[1] == pytest.approx(published[1], abs=0.35)


def test_objects_take_a_seventh_of_the_published_cycles_in_instructions(counted: dict[str, Any]) -> None:
    cycles = CLOCK_MHZ * grid(counted, "object", "published_us")
    assert (cycles / grid(counted, "object", "presses")).max() < 10
    # So that at two cycles an instruction an object takes less than a third of the published time.
    assert (cycles / largest(counted, "object")).min() > 6.5


def test_images_need_no_more_instructions_than_the_published_board_had_cycles(counted: dict[str, Any]) -> None:
    cycles = CLOCK_MHZ * grid(counted, "image", "published_us")
    each = cycles / grid(counted, "image", "presses")
    many = np.array(AXIS) >= 200
    assert each[:, many].min() > 2.5  # faster than published at two cycles an instruction
    assert each[:, ~many].min() > 1.2
    assert each[:, ~many].max() < 3  # which cannot be said of these
    # The largest press of few measurements takes a fifth more instructions than the published board had cycles.
    assert (cycles / largest(counted, "image")).min() > 0.7


def test_packing_a_result_takes_the_same_for_every_model(counted: dict[str, Any]) -> None:
    for output, most in (("image", 100_000), ("object", 10_000)):
        packets = grid(counted, output, "packet")
        assert packets.max() < most
        assert packets.min() > 0.8 * packets.max()
